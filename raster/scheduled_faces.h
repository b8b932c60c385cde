// Which faces a sequence captures, followed frame by frame without rendering: what RasterSequence does is planned
// alike.
#pragma once

#include <optional>
#include <vector>

#include "raster/probe_owners.h"
#include "raster/refresh.h"
#include "raster/technique.h"
#include "scenes/snapshot.h"

namespace pb {

class ScheduledFaces {
 public:
  // heightPx: of the image, which decides when probes of Technique::resolutionScale change their resolution.
  ScheduledFaces(const Technique& technique, int heightPx);

  // Goes on to the next frame of the sequence and returns the faces that are due in it, ordered by probe. The probes of
  // `snapshot` are the technique's (raster/probe_layout.h).
  std::vector<ProbeFace> advance(const Snapshot& snapshot);

  // By probe of that frame: the one of the frame before; nothing if they are the same, and in the first frame.
  const std::optional<std::vector<int>>& probesBefore() const { return before_; }

 private:
  Technique technique_;
  int heightPx_;
  ProbeFollower probes_;
  std::optional<std::vector<int>> before_;
  RefreshHistory history_;
  std::vector<int> resolutions_;  // by probe
};

}  // namespace pb
