#include "bench/metrics/ssim_planes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

#include "bench/metrics/vector_clones.h"

namespace pb::ssim {
namespace {

constexpr int kTaskRows = 32;

int paddedWidth(int width) {
  const int tiles = (width + kTileWidth - 1) / kTileWidth;
  return (tiles - 1) * kTileWidth + kInputWidth;
}

// Luma is that of luminance.h, written per channel so that the loop vectorises.
PB_VECTOR_CLONES void splitRow(const float* rgb, int width, float* red, float* green, float* blue, float* luma) {
#pragma GCC ivdep
  for (int x = 0; x < width; ++x) {
    const float r = rgb[3 * x], g = rgb[3 * x + 1], b = rgb[3 * x + 2];
    red[x] = r;
    green[x] = g;
    blue[x] = b;
    luma[x] = static_cast<float>(double{r} * 0.2126 + double{g} * 0.7152 + double{b} * 0.0722);
  }
}

PB_VECTOR_CLONES void halveRow(const float* top, const float* bottom, int halfWidth, float* half) {
#pragma GCC ivdep
  for (int x = 0; x < halfWidth; ++x) {
    half[x] = 0.25f * ((top[2 * x] + top[2 * x + 1]) + (bottom[2 * x] + bottom[2 * x + 1]));
  }
}

template <class Body>
void forEachRow(int height, Body body) {
  tbb::parallel_for(0, (height + kTaskRows - 1) / kTaskRows, [&](int task) {
    for (int y = task * kTaskRows; y < std::min((task + 1) * kTaskRows, height); ++y) body(y);
  });
}

void halve(const PaddedPlane& plane, PaddedPlane& half) {
  forEachRow(half.height(), [&](int y) {
    halveRow(&plane.values(0, 2 * y), &plane.values(0, 2 * y + 1), half.width, &half.values(0, y));
  });
}

}  // namespace

PaddedPlane::PaddedPlane(int planeWidth, int height) : width(planeWidth), values(paddedWidth(planeWidth), height) {}

Planes makePlanes(int width, int height, int scales) {
  Planes planes;
  planes.reserve(planeIndex(static_cast<std::size_t>(scales), 0));
  for (std::size_t plane = 0; plane < kFirstPlanes; ++plane) planes.emplace_back(width, height);
  for (int scale = 1; scale < scales; ++scale) {
    for (int channel = 0; channel < 3; ++channel) planes.emplace_back(width >> scale, height >> scale);
  }
  return planes;
}

void fillPlanes(const Image& image, Planes& planes) {
  forEachRow(image.height(), [&](int y) {
    splitRow(&image(0, y).x, image.width(), &planes[0].values(0, y), &planes[1].values(0, y), &planes[2].values(0, y),
             &planes[kLumaPlane].values(0, y));
  });
  for (std::size_t scale = 1; planeIndex(scale, 0) < planes.size(); ++scale) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      halve(planes[planeIndex(scale - 1, channel)], planes[planeIndex(scale, channel)]);
    }
  }
}

PaddedPlane makeMapWeights(const Mask& mask) {
  PaddedPlane weights(mask.width() - 2 * kRadius, mask.height() - 2 * kRadius);
  for (int y = 0; y < weights.height(); ++y) {
    for (int x = 0; x < weights.width; ++x) weights.values(x, y) = mask(x + kRadius, y + kRadius) != 0 ? 1.0f : 0.0f;
  }
  return weights;
}

}  // namespace pb::ssim
