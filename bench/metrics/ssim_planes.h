// The planes that SSIM and MS-SSIM compare: the channels and luma of a picture, and the channels at coarser scales.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/metrics/metrics.h"
#include "scenes/image.h"

namespace pb::ssim {

inline constexpr int kRadius = 5;  // of the window
inline constexpr int kTileWidth = 128, kTileRows = 64;
// Columns are worked on in blocks, multiples of every vector's length. A tile of the map needs one block more of the
// plane than it has itself, for the margins of the window.
inline constexpr int kBlock = 16;
inline constexpr int kInputWidth = kTileWidth + kBlock;
static_assert(2 * kRadius <= kBlock);

// Planes of the first scale, luma the last; further scales have three.
inline constexpr std::size_t kLumaPlane = 3, kFirstPlanes = 4;

constexpr std::size_t planeIndex(std::size_t scale, std::size_t channel) {
  return scale == 0 ? channel : kFirstPlanes + 3 * (scale - 1) + channel;
}

// Values of a picture with zeros to its right, so that whole tiles can be read everywhere.
struct PaddedPlane {
  PaddedPlane(int planeWidth, int height);
  int height() const { return values.height(); }

  int width;
  Plane values;
};

// Scale 0: red, green, blue, luma; then red, green, blue of each further scale, halved by means of 2x2 pixels, in
// single precision. Sides must be even as often as they are halved.
using Planes = std::vector<PaddedPlane>;

// Planes of zeros for pictures of one size, to be filled.
Planes makePlanes(int width, int height, int scales);
void fillPlanes(const Image& image, Planes& planes);

// 1 where the mask is set and 0 elsewhere, in the coordinates of the map of similarity, whose pixel (0,0) is (5,5).
PaddedPlane makeMapWeights(const Mask& mask);

}  // namespace pb::ssim
