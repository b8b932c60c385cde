#include "raster/scheduled_faces.h"

#include <utility>

#include "raster/probe_resolution.h"

namespace pb {

ScheduledFaces::ScheduledFaces(const Technique& technique, int heightPx) : technique_(technique), heightPx_(heightPx) {
  history_.technique = technique;
}

// Probes whose resolution changes are due with all of their faces, and so are those with other owners than any in the
// frame before.
std::vector<ProbeFace> ScheduledFaces::advance(const Snapshot& snapshot) {
  before_ = probes_.follow(snapshot);
  if (before_) {
    reorder(history_, *before_);
    resolutions_ = reordered(std::move(resolutions_), *before_, 0);
  }
  std::vector<int> wanted = probeResolutions(technique_, snapshot, heightPx_);
  for (std::size_t probe = 0; probe < history_.lastCapturedFrame.size(); ++probe)
    if (wanted[probe] != resolutions_[probe]) history_.lastCapturedFrame[probe].fill(-1);
  resolutions_ = std::move(wanted);
  std::vector<ProbeFace> due = dueFaces(technique_.refresh, history_, snapshot);
  pb::advance(history_, due, snapshot);
  return due;
}

}  // namespace pb
