// Errors over some of an image's pixels: those of a material or of an object.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace pb {

struct RegionErrors {
  std::int64_t pixels = 0;
  double mse = 0;      // mean over the pixels and channels
  double relmse = 0;   // likewise, of (test - reference)^2 / (reference^2 + 0.01)
  double bias = 0;     // mean of test - reference
  double flipHdr = 0;  // mean of the whole image's map
  double share = 0;    // of the image's sum of squared errors, 0 to 1

  friend bool operator==(const RegionErrors&, const RegionErrors&) = default;
};

// Sums over pixels that come in a fixed order.
class RegionSums {
 public:
  void add(const glm::vec3& reference, const glm::vec3& test, float flipHdr);

  std::int64_t pixels() const { return pixels_; }
  double squares() const { return squares_; }  // of all channels

  // At least one pixel was added; `imageSquares` is squares() of the whole image.
  RegionErrors errors(double imageSquares) const;

 private:
  std::int64_t pixels_ = 0;
  double squares_ = 0, relativeSquares_ = 0, differences_ = 0, flip_ = 0;
};

}  // namespace pb
