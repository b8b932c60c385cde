// Structural similarity (Wang et al. 2004) over one tile of its map, small enough for its sums to stay in the caches
// next to a core. Sums are in double precision: small variances of bright areas are differences of large squares.
#pragma once

#include <array>

#include "bench/metrics/ssim_planes.h"

namespace pb::ssim {

// A part of the map of similarity: at most kTileWidth x kTileRows of its pixels.
struct Tile {
  int x, y, width, rows;
};

template <class T>
using TileRows = std::array<std::array<T, kTileWidth>, kTileRows>;

// Mean and variance of the reference under the window of each pixel.
struct ReferenceTile {
  TileRows<double> mean, variance;
};
void computeReferenceTile(const PaddedPlane& reference, const Tile& tile, ReferenceTile& out);

// Sums over the pixels of a tile.
struct TileSums {
  double ssim = 0;
  double contrastStructure = 0;  // SSIM without the factor of the means
  double weightedSsim = 0;       // SSIM times the weight; 0 without weights
};
TileSums compareTile(const PaddedPlane& reference, const ReferenceTile& referenceTile, const PaddedPlane& test,
                     const PaddedPlane* weights, const Tile& tile);

}  // namespace pb::ssim
