#include "bench/metrics/checks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "bench/metrics/vector_clones.h"
#include "scenes/error.h"

namespace pb {
namespace {

bool isFinite(const glm::vec3& value) {
  return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z);
}

// Without a branch per value, because every metric asks this of every image.
PB_VECTOR_CLONES bool allFinite(const float* values, std::size_t count) {
  constexpr std::uint32_t kExponentMask = 0x7f800000;  // all ones for NaN and infinities
  std::uint32_t anyBad = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(values[i]);
    anyBad |= (bits & kExponentMask) == kExponentMask ? 1u : 0u;
  }
  return anyBad == 0;
}

}  // namespace

void requireFinite(const Image& image, const char* name) {
  if (image.empty()) throwInputError("images need at least one pixel, the {} image has none", name);
  if (allFinite(&image[0].x, 3 * image.size())) return;
  const auto bad = std::find_if_not(image.begin(), image.end(), isFinite);
  const auto index = bad - image.begin();
  throwInputError("pixel values must be finite, got ({}, {}, {}) at x = {}, y = {} of the {} image", bad->x, bad->y,
                  bad->z, index % image.width(), index / image.width(), name);
}

void requireComparable(const Image& reference, const Image& test) {
  if (reference.width() != test.width() || reference.height() != test.height()) {
    throwInputError("images must have equal sizes, the reference has {}x{} and the test image {}x{} pixels",
                    reference.width(), reference.height(), test.width(), test.height());
  }
  requireFinite(reference, "reference");
  requireFinite(test, "test");
}

void requireMaskSize(const Mask& mask, int width, int height) {
  if (mask.width() == width && mask.height() == height) return;
  throwInputError("a mask must have the size of the images, {}x{}, got {}x{} pixels", width, height, mask.width(),
                  mask.height());
}

void throwEmptyMask(const Mask& mask) {
  throwInputError("a mask must hold at least one pixel, all {}x{} of this one are outside", mask.width(),
                  mask.height());
}

}  // namespace pb
