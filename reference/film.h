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

// The samples of one pixel. Sample s of a primary point belongs to batch s % batchCount.
class PixelBatches {
 public:
  explicit PixelBatches(int batchCount) : batchCount_(batchCount) {}

  // The next primary point, of which every sample is `radiance`.
  void addPoint(const glm::vec3& radiance);
  // The next primary point, sampleOf(s) being its sample s.
  void addPoint(int samples, const std::function<glm::vec3(int)>& sampleOf);

  // Mean over the points.
  glm::vec3 batch(int index) const;

 private:
  int batchCount_;
  int points_ = 0;
  std::array<glm::dvec3, kMaxBatches> sums_{};
};

}  // namespace pb
