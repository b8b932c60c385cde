// Random numbers of paths. Each is a function of its keys and of nothing else, so any thread may ask for it at any
// time.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "reference/sobol.h"

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

// How the dimensions of one Sobol sequence are scrambled: the same for all its points, so that it is computed once for
// those of a pixel. Not for several threads at once.
class SobolScrambles {
 public:
  // Different (seed, pixel, sequence) are scrambled independently.
  SobolScrambles(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sequence);

  // Of the order of the points in a group of dimensions, and of one dimension.
  std::uint32_t ofOrder(std::uint32_t group);
  std::uint32_t ofDimension(std::uint32_t dimension);

 private:
  // Most paths draw fewer numbers.
  static constexpr std::uint32_t kKept = 32;

  std::uint32_t orderScramble(std::uint32_t group) const { return pcg4d({key_.x, key_.y, key_.z, group}).x; }
  std::uint32_t dimensionScramble(std::uint32_t dimension) const {
    return pcg4d({key_.x, key_.y, key_.w, dimension}).y;
  }

  glm::uvec4 key_;
  std::uint32_t kept_ = 0, keptOrders_ = 0;  // that were computed
  std::array<std::uint32_t, kKept> dimensions_;
  std::array<std::uint32_t, kKept / kSobolDimensions> orders_;
};

// The dimensions of one sample, one after the other. All numbers are uniform in [0, 1), multiples of 2^-24.
class Sampler {
 public:
  // Independent of all other (seed, point, sample).
  Sampler(std::uint64_t seed, std::uint32_t point, std::uint64_t sample);

  // Point `index` of an Owen-scrambled Sobol sequence: of those with the same scrambles every 2^k consecutive points
  // from a multiple of 2^k on are stratified (see docs/noise.md). The scrambles must outlive the sampler.
  Sampler(SobolScrambles& scrambles, std::uint32_t index) : scrambles_(&scrambles), point_(reverseBits(index)) {}

  float next() { return scrambles_ != nullptr ? nextSobol() : nextIndependent(); }

  // Two numbers that belong together, as the coordinates of one direction do: stratified jointly.
  glm::vec2 next2();

  // Whether a number was drawn: a path that never did is the same for every sample.
  bool used() const { return dimension_ != 0; }

 private:
  float nextIndependent();
  float nextSobol();

  SobolScrambles* scrambles_ = nullptr;  // null: independent numbers
  glm::uvec4 key_{};                     // of those
  std::uint32_t point_;                  // of Sobol sequences: the index, bits reversed
  std::uint32_t index_ = 0;              // in the order of the points in this group of dimensions
  std::uint32_t dimension_ = 0;
};

}  // namespace pb
