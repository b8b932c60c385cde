// From where a technique captures a snapshot's probes, for maps that are made by other means
// (RasterSequence::setProbe). Pure functions.
#pragma once

#include <memory>
#include <vector>

#include "raster/technique.h"
#include "scenes/snapshot.h"

namespace pb {

struct ProbeView {
  glm::vec3 position;       // world; face f is seen through cubeFaceView(position, f, zNear)
  float zNear;              // metres: nothing nearer than that along the axis of a face is captured
  std::vector<int> hidden;  // instances of ProbeViews::snapshot that a capture leaves out: owners
  int resolutionPx;         // texels along the edge of a face
};

struct ProbeViews {
  std::shared_ptr<const Snapshot> snapshot;  // laid out: its probes and their owners are the technique's, and instances
                                             // may be cut into parts (raster/probe_layout.h)
  std::vector<ProbeView> probes;             // of the same indices as the snapshot's
};

// For pictures of that many pixels in height.
ProbeViews probeViews(const Technique& technique, const std::shared_ptr<const Snapshot>& snapshot, int heightPx);

}  // namespace pb
