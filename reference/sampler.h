// Counter-based random numbers: each is a function of (seed, point, sample, dimension) and of nothing else, so any
// thread may ask for it at any time.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace pb {

// Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020: pcg4d.
inline glm::uvec4 pcg4d(glm::uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

// The dimensions of one sample of one primary point, one after the other.
class Sampler {
 public:
  Sampler(std::uint64_t seed, std::uint32_t point, std::uint64_t sample)
      : key_(pcg4d({static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                    static_cast<std::uint32_t>(sample), static_cast<std::uint32_t>(sample >> 32)})),
        point_(point) {}

  // Uniform in [0, 1), a multiple of 2^-24.
  float next() {
    const glm::uvec4 hash = pcg4d({key_.x, key_.y, point_, key_.z ^ dimension_++});
    return static_cast<float>(hash.x >> 8) * 0x1p-24f;
  }

  // Two of them at once: they belong together, as the two coordinates of one direction do.
  glm::vec2 next2() {
    const float x = next();
    return {x, next()};
  }

  // Whether next() was called: a path that never did is the same for every sample.
  bool used() const { return dimension_ != 0; }

 private:
  glm::uvec4 key_;
  std::uint32_t point_;
  std::uint32_t dimension_ = 0;
};

}  // namespace pb
