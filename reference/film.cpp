#include "reference/film.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

#include "scenes/error.h"

namespace pb {
namespace {

constexpr int kTileEdgePx = 16;

// Of every `stride`-th image from `first` on.
Image meanOf(const std::vector<Image>& images, std::size_t first, std::size_t stride) {
  assert(first < images.size());
  Image mean(images.front().width(), images.front().height());
  for (std::size_t pixel = 0; pixel < mean.size(); ++pixel) {
    glm::dvec3 sum(0.0);
    int count = 0;
    for (std::size_t i = first; i < images.size(); i += stride, ++count) sum += glm::dvec3(images[i][pixel]);
    mean[pixel] = glm::vec3(sum / static_cast<double>(count));
  }
  return mean;
}

}  // namespace

Image ReferenceImage::mean() const { return meanOf(batches, 0, 1); }

Image ReferenceImage::half(int which) const {
  assert(which == 0 || which == 1);
  return meanOf(batches, static_cast<std::size_t>(which), 2);
}

void forEachTile(int width, int height, const std::atomic<bool>* cancelled,
                 const std::function<void(const Tile&)>& render) {
  const int columns = (width + kTileEdgePx - 1) / kTileEdgePx;
  const int rows = (height + kTileEdgePx - 1) / kTileEdgePx;
  const auto isCancelled = [&] { return cancelled && cancelled->load(std::memory_order_relaxed); };
  tbb::parallel_for(tbb::blocked_range<int>(0, columns * rows, 1), [&](const tbb::blocked_range<int>& range) {
    for (int i = range.begin(); i < range.end() && !isCancelled(); ++i) {
      const int x = i % columns * kTileEdgePx;
      const int y = i / columns * kTileEdgePx;
      render({x, y, std::min(x + kTileEdgePx, width), std::min(y + kTileEdgePx, height)});
    }
  });
  if (isCancelled()) throw Error(Failure::interrupted, "rendering of the reference was interrupted");
}

void PixelBatches::addPoint(const glm::vec3& radiance) {
  for (int b = 0; b < batchCount_; ++b) sums_[static_cast<std::size_t>(b)] += glm::dvec3(radiance);
  ++points_;
}

glm::vec3 PixelBatches::batch(int index) const {
  return glm::vec3(sums_[static_cast<std::size_t>(index)] / static_cast<double>(points_));
}

}  // namespace pb
