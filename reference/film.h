// From samples to pictures: tiles in parallel, samples into batches in fixed order.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <glm/vec3.hpp>

#include "reference/renderer.h"

namespace pb {

// Pixels x0 <= x < x1, y0 <= y < y1.
struct Tile {
  int x0, y0, x1, y1;
};

// Calls `render` once for each tile of the image, from several threads.
// Throws Error(Failure::interrupted) if `cancelled` became true; it is read before each tile.
void forEachTile(int width, int height, const std::atomic<bool>* cancelled,
                 const std::function<void(const Tile&)>& render);

// The samples of one pixel, in two halves of equally many batches: batch 2 k + h belongs to half h. A half's samples of
// a point are points of one low-discrepancy sequence; they go to the half's batches in turn, so that 2^k consecutive
// ones are spread evenly, and each point begins with another batch, so that no batch always has the same place in the
// order.
class PixelBatches {
 public:
  explicit PixelBatches(int batchCount) : batchCount_(batchCount) {}

  // The next primary point, of which every sample is `radiance`.
  void addPoint(const glm::vec3& radiance);
  // The next primary point: sampleOf(half, i) is sample i of that half, i < samples / 2.
  template <class SampleOf>
  void addPoint(int samples, const SampleOf& sampleOf);

  // Mean over the points.
  glm::vec3 batch(int index) const;

 private:
  int batchCount_;
  int points_ = 0;
  std::array<glm::dvec3, kMaxBatches> sums_{};
  // Of the point that is being added; 0 between points.
  std::array<glm::dvec3, kMaxBatches> pointSums_{};
  std::array<int, kMaxBatches> pointCounts_{};
};

// Sample i goes to batch (i + i / n + points) mod n of the half's n.
template <class SampleOf>
void PixelBatches::addPoint(int samples, const SampleOf& sampleOf) {
  const int batchesOfHalf = batchCount_ / 2;
  for (int half = 0; half < 2; ++half)
    for (int i = 0, turn = points_ % batchesOfHalf, left = batchesOfHalf; i < samples / 2; ++i) {
      const auto batch = static_cast<std::size_t>(2 * turn + half);
      pointSums_[batch] += glm::dvec3(sampleOf(half, i));
      ++pointCounts_[batch];
      turn = turn + 1 == batchesOfHalf ? 0 : turn + 1;
      if (--left > 0) continue;
      left = batchesOfHalf;
      turn = turn + 1 == batchesOfHalf ? 0 : turn + 1;
    }
  for (std::size_t b = 0; b < static_cast<std::size_t>(batchCount_); ++b) {
    sums_[b] += pointSums_[b] / static_cast<double>(pointCounts_[b]);
    pointSums_[b] = glm::dvec3(0.0);
    pointCounts_[b] = 0;
  }
  ++points_;
}

}  // namespace pb
