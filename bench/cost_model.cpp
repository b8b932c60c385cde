#include "bench/cost_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "raster/captured_faces.h"
#include "raster/probe_layout.h"
#include "raster/probe_owners.h"
#include "raster/refresh.h"

namespace pb {

int blockFrames(const Technique& technique, int probes, int measuredFrames) {
  const int faces = probes * capturedFaceCount(technique);
  const int cycle = std::max(1, refreshPolicy(technique.refresh).cycle(technique.refresh, faces));
  const int cycles = std::max(1, (measuredFrames + cycle - 1) / cycle);
  return static_cast<int>(std::min<long long>(static_cast<long long>(cycle) * cycles, kMaxBlockFrames));
}

RenderCount modelRenders(const Technique& technique, const std::vector<std::shared_ptr<const Snapshot>>& snapshots) {
  RefreshHistory history;
  history.technique = technique;
  double faces = 0;
  // The first frame captures everything; the second pass over the block is the one that repeats for ever.
  ProbeLayout layout(technique);
  ProbeFollower probes;
  const Snapshot& first = layout.apply(*snapshots[0]);
  probes.follow(first);
  advance(history, dueFaces(technique.refresh, history, first), first);
  for (int pass = 0; pass < 2; ++pass) {
    faces = 0;
    for (std::size_t i = 1; i < snapshots.size(); ++i) {
      const Snapshot& snapshot = layout.apply(*snapshots[i]);
      if (const auto before = probes.follow(snapshot)) reorder(history, *before);
      const std::vector<ProbeFace> due = dueFaces(technique.refresh, history, snapshot);
      faces += static_cast<double>(due.size());
      advance(history, due, snapshot);
    }
  }
  RenderCount count;
  count.perFrame = 1 + technique.bounces * faces / static_cast<double>(snapshots.size() - 1);
  const bool everyFrame = technique.refresh.name == "every-frame";
  count.formula = fmt::format(
      "{} = {:.4g}", everyFrame ? fmt::format("{}*N*B+1", capturedFaceCount(technique)) : "1+B*faces", count.perFrame);
  return count;
}

}  // namespace pb
