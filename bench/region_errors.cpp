#include "bench/region_errors.h"

#include <cassert>

namespace pb {
namespace {

double sumOf(const glm::dvec3& v) { return v.x + v.y + v.z; }

}  // namespace

void RegionSums::add(const glm::vec3& reference, const glm::vec3& test, float flipHdr) {
  const glm::dvec3 r(reference);
  const glm::dvec3 d = glm::dvec3(test) - r;
  const glm::dvec3 squared = d * d;
  ++pixels_;
  squares_ += sumOf(squared);
  relativeSquares_ += sumOf(squared / (r * r + 0.01));
  differences_ += sumOf(d);
  flip_ += static_cast<double>(flipHdr);
}

RegionErrors RegionSums::errors(double imageSquares) const {
  assert(pixels_ > 0);
  const double count = static_cast<double>(pixels_);
  return {.pixels = pixels_,
          .mse = squares_ / (3.0 * count),
          .relmse = relativeSquares_ / (3.0 * count),
          .bias = differences_ / (3.0 * count),
          .flipHdr = flip_ / count,
          .share = imageSquares > 0 ? squares_ / imageSquares : 0.0};
}

}  // namespace pb
