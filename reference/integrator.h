// Radiance along one ray: a chain of mirror reflections and refractions with local light at every hit.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "reference/sampler.h"
#include "reference/surface_hit.h"

namespace pb {

struct PathResult {
  glm::vec3 radiance;
  std::int64_t rays;  // traced
};

// An unbiased estimate of the radiance that arrives at the ray's origin from its direction, in the transport model of
// DESIGN's rulings: local radiance at each hit, perfect mirrors, smooth glass; after `depth` specular hits the
// environment, unoccluded. conePerMetre is the width of the sample's cone per metre of path (shading/texture.glsl).
//
// Without a depth, Russian roulette ends paths from hit 17 on: a path that goes on is weighted by 1 / p, p at most
// 0.95. A chain that ends after n > 16 hits with radiance L weighted T then has variance T^2 L^2 (0.95^-(n-16) - 1), at
// most, if its throughput is not below 0.95: 1.3 T^2 L^2 for n = 32. Between mirrors that reflect more than sqrt(0.95)
// for ever the mean stays right but the variance has no bound.
//
// Radiance is not scaled by the square of the refractive index inside of glass: the factors of entering and leaving
// cancel for what a viewer outside sees.
PathResult tracePath(const TracedScene& scene, const Ray& primary, float conePerMetre, std::optional<int> depth,
                     Sampler& sampler);

}  // namespace pb
