// How many texels a probe's map has (Technique::resolutionScale): pure functions.
#pragma once

#include <vector>

#include "raster/technique.h"
#include "scenes/snapshot.h"

namespace pb {

// Diameter of the sphere around a box in the picture, as a share of the picture's height; infinite seen from inside of
// the sphere. Whether it is in the picture doesn't matter.
float projectedSize(const Snapshot& snapshot, const Bounds& box);

// Texels along the edge of a face, by probe, for pictures of that many pixels in height. With ResolutionScale::distance
// the smallest power of two that is no less than the diameter of the owners in pixels, from 8 to the technique's
// resolution, and so half as many with each doubling of the distance.
//
// Derivation: on a mirror ball D pixels across the normal turns by 2 / D from pixel to pixel at the centre, the
// reflected direction by 4 / D; a texel in the middle of a face of n texels is 2 / n wide. n = D / 2 are one texel a
// pixel, n = D two of them, as many as it takes to filter without blur. Towards the ball's edge fewer do; flatter
// mirrors magnify and want more, in proportion to their radius of curvature.
std::vector<int> probeResolutions(const Technique& technique, const Snapshot& snapshot, int heightPx);

}  // namespace pb
