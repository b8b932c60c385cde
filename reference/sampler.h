// Random numbers of paths. Each is a function of its keys and of nothing else, so any thread may ask for it at any
// time.
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

// The dimensions of one sample, one after the other. All numbers are uniform in [0, 1), multiples of 2^-24.
class Sampler {
 public:
  // Independent of all other (seed, point, sample).
  Sampler(std::uint64_t seed, std::uint32_t point, std::uint64_t sample)
      : key_(pcg4d({static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                    static_cast<std::uint32_t>(sample), static_cast<std::uint32_t>(sample >> 32)})),
        point_(point) {}

  // Point `index` of an Owen-scrambled Sobol sequence. Different (seed, pixel, sequence) are scrambled independently;
  // within one of them every 2^k consecutive points from a multiple of 2^k on are stratified (see docs/noise.md).
  static Sampler sobol(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sequence, std::uint32_t index);

  float next() { return sobol_ ? nextSobol() : nextIndependent(); }

  // Two numbers that belong together, as the coordinates of one direction do: stratified jointly.
  glm::vec2 next2();

  // Whether a number was drawn: a path that never did is the same for every sample.
  bool used() const { return dimension_ != 0; }

 private:
  static float toFloat(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

  float nextIndependent() {
    const glm::uvec4 hash = pcg4d({key_.x, key_.y, point_, key_.z ^ dimension_++});
    return toFloat(hash.x);
  }
  float nextSobol();

  glm::uvec4 key_;
  std::uint32_t point_;  // of Sobol sequences: the index
  std::uint32_t dimension_ = 0;
  bool sobol_ = false;
};

}  // namespace pb
