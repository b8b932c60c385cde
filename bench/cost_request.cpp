#include "bench/cost_request.h"

#include <algorithm>

#include "bench/cost_model.h"
#include "raster/probe_layout.h"

namespace pb {
namespace {

int probeCount(const Technique& technique, const Snapshot& snapshot) {
  ProbeLayout layout(technique);
  return static_cast<int>(layout.apply(snapshot).probes.size());
}

}  // namespace

CostRequest makeCostRequest(const Suite& suite, const std::vector<std::shared_ptr<const Scene>>& scenes,
                            const PlannedSequence& sequence) {
  const SuiteScene& scene = suite.scenes[sequence.scene];
  // Frames before 0 show frame 0.
  const auto snapshot = [&](int frame) {
    return makeSnapshot(scenes[sequence.scene], std::max(frame, 0), scene.camera, suite.image.aspect());
  };
  CostRequest request{makeCell(suite, sequence, 0).sequenceKey(), sequence.technique, {}};
  request.snapshots.push_back(snapshot(scene.startFrame()));
  const int frames = blockFrames(sequence.technique, probeCount(sequence.technique, *request.snapshots[0]),
                                 static_cast<int>(scene.frames.size()));
  for (int i = 1; i <= frames; ++i) request.snapshots.push_back(snapshot(scene.startFrame() + i));
  return request;
}

}  // namespace pb
