// Light that reaches a surface straight from its source: shadow rays, and the weights that keep what is found by chance
// and what is looked for from being counted twice.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "reference/bsdf.h"
#include "reference/light_sampler.h"
#include "reference/sampler.h"
#include "reference/surface_hit.h"

namespace pb {

// Where a path has met a surface.
struct Vertex {
  const TracedScene& scene;
  const Hit& hit;
  const shading::Surface& surface;
  glm::vec3 toViewer;
  float coneWidth;  // metres
  // Of the media on the viewer's side of the triangle and behind it, 1/m.
  glm::vec3 absorptionBefore{0.0f};
  glm::vec3 absorptionBehind{0.0f};
};

// Light towards the viewer, apart by the lobe that sends it on.
struct DirectLight {
  glm::vec3 diffuse{0.0f};
  glm::vec3 specular{0.0f};
};

// Power heuristic with exponent 2 for one sample each of two densities: Veach, "Robust Monte Carlo Methods for Light
// Transport Simulation" (1997), section 9.2.4. 1 if the other can't find the direction.
float misWeight(float pdf, float otherPdf);

// Share of light that comes through from `direction` (unit) within `distance`: 0 behind opaque surfaces and glass, the
// product of (1 - opacity) behind others. Adds the rays that it traces.
float visibility(const Vertex& vertex, const glm::vec3& direction, float distance, std::int64_t& rays);

// Like localRadiance() of the snapshot, but lights are shadowed: punctual lights by a ray each, area lights by one
// point of one of them, chosen by its unoccluded irradiance. Emission included, ambient light unoccluded. Without area
// lights there may be no sampler.
glm::vec3 shadowedLocalRadiance(const Vertex& vertex, Sampler* sampler, std::int64_t& rays);

// Of all punctual lights, with a shadow ray each if there are `shadows`.
DirectLight punctualLight(const Vertex& vertex, const Bsdf& bsdf, bool shadows, std::int64_t& rays);

// One light sample, weighted for combination with a direction found by Bsdf::sample(). `lastSpecular`: what the
// specular lobe sees is the environment, unoccluded, and nothing else.
DirectLight sampledLight(const Vertex& vertex, const Bsdf& bsdf, bool lastSpecular, Sampler& sampler,
                         std::int64_t& rays);

}  // namespace pb
