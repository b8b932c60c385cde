// SSIM and MS-SSIM of many test images against one reference. Both share the first scale; whole image and mask share
// the map.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "bench/metrics/metrics.h"
#include "bench/metrics/ssim_tile.h"

namespace pb::ssim {

struct Scores {
  std::optional<Ssim> whole, masked;  // as computeSsim()
  std::optional<double> msSsim;       // as computeMsSsim()
};

// Whether means and variances of the reference are kept for further test images (up to 85 bytes per pixel, 512 MiB);
// the results are the same bits.
enum class Reuse { never, ifSmall };

// At the first scale only, or at all five where MS-SSIM is defined for the image's size.
enum class Scales { first, all };

class SsimReference {
 public:
  SsimReference(const Image& reference, Scales scales, Reuse reuse);

  // The images are comparable and the mask has their size.
  Scores compare(const Image& test, const Mask* mask) const;

 private:
  struct PlaneTile {
    std::size_t plane;
    Tile tile;
  };

  void addTiles(std::size_t plane);
  std::vector<TileSums> comparePlanes(const Planes& test, const PaddedPlane* weights) const;
  Planes takePlanes() const;
  void giveBack(Planes planes) const;

  int width_, height_, scales_;
  Planes planes_;
  std::vector<PlaneTile> tiles_;     // plane by plane, row by row
  std::vector<ReferenceTile> kept_;  // of tiles_; empty if not kept

  // Planes of test images are used again: with fresh memory each time a fifth of the time went into page faults.
  mutable std::mutex mutex_;
  mutable std::vector<Planes> unused_;
};

}  // namespace pb::ssim
