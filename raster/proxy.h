// What stands for a probe's surroundings: pure functions.
#pragma once

#include "raster/gpu_structs.h"
#include "scenes/snapshot.h"

namespace pb {

// The probe's own box (of its node, or of the scene's room); without one the bounds of all instances but its owners,
// and if there are none, a box that is as good as infinitely large.
Bounds proxyBoxOf(const Snapshot& snapshot, const Probe& probe);

// The mean distance of the box's six sides from a point inside, which is the same for all points.
float proxyRadiusOf(const Bounds& box);

// The one view of a probe whose technique captures no more: 90 degrees along the mean normal of its owners' surfaces,
// turned as their texture coordinates are on the mean, so that a screen shows it as its own picture. Of owners without
// a mean normal, as closed bodies are, towards the camera; of owners without tangents upright, its right that of a
// viewer who looks at them.
shading::View singleView(const Snapshot& snapshot, const Probe& probe);

gpu::ProbeConstants probeConstants(const Snapshot& snapshot, const Probe& probe);

}  // namespace pb
