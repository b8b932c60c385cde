#include "bench/flicker.h"

#include <cassert>
#include <glm/common.hpp>

namespace pb {
namespace {

bool isInside(const Mask& mask, std::size_t i) { return !mask.empty() && mask[i] != 0; }

double sumOf(const glm::dvec3& v) { return v.x + v.y + v.z; }

}  // namespace

Flicker computeFlicker(const FramePair& frame, const FramePair& before, int frames) {
  const std::size_t pixels = frame.image.size();
  assert(frames > 0 && pixels > 0 && frame.reference.size() == pixels && before.image.size() == pixels &&
         before.reference.size() == pixels);
  double whole = 0, inside = 0;
  std::int64_t count = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const glm::dvec3 error = glm::dvec3(frame.image[i]) - glm::dvec3(frame.reference[i]);
    const glm::dvec3 errorBefore = glm::dvec3(before.image[i]) - glm::dvec3(before.reference[i]);
    const double change = sumOf(glm::abs(error - errorBefore));
    whole += change;
    if (!isInside(frame.mask, i) && !isInside(before.mask, i)) continue;
    inside += change;
    ++count;
  }
  const double values = 3.0 * frames;  // of a pixel
  Flicker flicker{whole / (values * static_cast<double>(pixels))};
  if (count > 0) flicker.mask = inside / (values * static_cast<double>(count));
  return flicker;
}

}  // namespace pb
