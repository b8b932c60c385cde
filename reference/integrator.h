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

// An unbiased estimate of the radiance that arrives at the ray's origin from its direction: local radiance at each hit,
// perfect mirrors, smooth glass. After `depth` specular hits the path takes the environment, unoccluded. conePerMetre
// is the width of the sample's cone per metre of path (shading/texture.glsl).
//
// Without a depth, Russian roulette ends paths from hit 17 on; they go on with probability p, the largest channel of
// their throughput but at most 0.95, weighted by 1 / p. Variance of a chain that ends after n > 16 hits with radiance L
// weighted T: T^2 L^2 (0.95^-(n-16) - 1) for T near 1, which is 1.3 L^2 for n = 32, and less than T L^2 for a small T.
// Between mirrors that reflect more than sqrt(0.95) for ever the mean stays right but the variance has no bound.
//
// Directions follow the smooth normal, so that near a silhouette one may point under the triangle. Such a ray goes on
// behind it: out of a closed single-sided mesh it comes through the back faces, which are not there, much as if it had
// grazed the smooth surface; a double-sided mesh it meets from inside.
//
// Radiance is not scaled by the square of the refractive index inside of glass: the factors of entering and leaving
// cancel for what a viewer outside sees.
PathResult tracePath(const TracedScene& scene, const Ray& primary, float conePerMetre, std::optional<int> depth,
                     Sampler& sampler);

}  // namespace pb
