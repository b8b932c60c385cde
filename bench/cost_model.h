// How many frames a measurement of cost covers, and how many renders of the scene they take: pure.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "raster/technique.h"
#include "scenes/snapshot.h"

namespace pb {

// Frames of a block: whole refresh cycles that cover at least `measuredFrames` (those of the suite, so that a moving
// scene is measured while it moves), limited so that slow policies stay measurable.
inline constexpr int kMaxBlockFrames = 120;
int blockFrames(const Technique& technique, int probes, int measuredFrames);

// The cost model: renders of the scene per frame, 1 + B * scheduled faces, mean over `frames` after the first of
// `snapshots` was captured completely.
struct RenderCount {
  double perFrame = 0;
  std::string formula;  // "6*N*B+1 = 31" or "1+B*faces = 4"
};
RenderCount modelRenders(const Technique& technique, const std::vector<std::shared_ptr<const Snapshot>>& snapshots);

}  // namespace pb
