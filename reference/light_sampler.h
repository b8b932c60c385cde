// Directions towards light: the environment and emitting triangles, chosen by power. Punctual lights are not in here.
//
// Densities are per steradian at the point that is lit and include the probability of having chosen the light, so that
// they enter multiple importance sampling as they are. They are those of the tables as they were built: rounding in a
// table changes which directions are tried, not the mean of radiance / density.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "scenes/snapshot.h"

namespace pb {

class LightSampler {
 public:
  // Keeps a reference to the snapshot.
  explicit LightSampler(const Snapshot& snapshot);
  ~LightSampler();
  LightSampler(const LightSampler&) = delete;
  LightSampler& operator=(const LightSampler&) = delete;

  struct Sample {
    glm::vec3 direction;  // unit, from the point to the light
    float distance;       // metres; infinite for the environment
    glm::vec3 radiance;   // unoccluded, towards the point, times the opacity of what emits it
    float pdf;            // 1/sr, positive
    int instance;         // of the emitting triangle, -1 for the environment; a hidden one must count as dark
  };

  // One direction from `position` for uniform numbers in [0, 1). nullopt: this sample is dark (a light seen from its
  // back or from its edge); it counts as a sample of radiance 0.
  std::optional<Sample> sample(const glm::vec3& position, const glm::vec2& uDirection, float uChoice) const;

  // Density with which sample() finds a direction through the environment; 0 where that is no brighter than its mean,
  // so that estimates need other directions as well (multiple importance sampling).
  float pdfEnvironment(const glm::vec3& direction) const;

  // Density with which sample() at `position` finds this point of a triangle; 0 for triangles that don't emit, and on
  // their dark side.
  float pdfTriangle(int instance, std::uint32_t triangle, const glm::vec3& position, const glm::vec3& hitPoint) const;

  // Nothing to be sampled: no environment's light, no emitting triangle.
  bool empty() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pb
