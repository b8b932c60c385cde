#include "reference/direct_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "scenes/luminance.h"

namespace pb {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Shadow rays end this share of their length before the light, so that rounding doesn't make it hide itself.
constexpr float kShadowEnd = 1.0f - 1e-4f;

// Product of (1 - opacity) along a ray that meets no opaque surface.
float transparency(const Vertex& vertex, Ray ray, float distance, std::int64_t& rays) {
  float result = 1.0f;
  for (float travelled = 0.0f; result > 0.0f;) {
    const std::optional<Hit> hit = vertex.scene.intersect(ray);
    ++rays;
    if (!hit || travelled + hit->t >= distance) break;
    travelled += hit->t;
    const shading::Surface s = surfaceAt(vertex.scene, *hit, ray.direction, vertex.coneWidth);
    result *= 1.0f - s.opacity;
    ray.origin = offsetOrigin(vertex.scene, *hit, s.position, ray.direction);
  }
  return result;
}

float distanceTo(const shading::Light& light, const glm::vec3& p) {
  if (light.positionKind.w == shading::kLightDirectional) return kInfinity;
  return glm::distance(glm::vec3(light.positionKind), p);
}

// What the medium on the light's side leaves of it. Nothing absorbs what comes from infinitely far away: a ray that
// leaves the scene while it is inside of a mesh has found a hole in it.
glm::vec3 unabsorbed(const Vertex& vertex, const glm::vec3& direction, float distance) {
  const bool behind = glm::dot(direction, vertex.hit.geometricNormal) < 0.0f;
  const glm::vec3& absorption = behind ? vertex.absorptionBehind : vertex.absorptionBefore;
  if (absorption == glm::vec3(0.0f) || distance == kInfinity) return glm::vec3(1.0f);
  return shading::transmittance(absorption, distance);
}

glm::vec3 shadowedIrradiance(const Vertex& vertex, const shading::Light& light, std::int64_t& rays) {
  const shading::Surface& s = vertex.surface;
  const glm::vec3 fromLight = shading::lightIrradianceOn(light, s.position, s.normal);
  if (fromLight == glm::vec3(0.0f)) return fromLight;
  const glm::vec3 toLight = shading::lightDirection(light, s.position);
  return visibility(vertex, toLight, distanceTo(light, s.position), rays) * fromLight;
}

// One of the area lights with probability in proportion to its unoccluded irradiance here.
struct ChosenAreaLight {
  const shading::AreaLight* light;
  float probability;
};
std::optional<ChosenAreaLight> chooseAreaLight(const Vertex& vertex, float u) {
  const auto irradianceOf = [&](const shading::AreaLight& light) {
    return luminance(shading::areaLightIrradiance(light, vertex.surface.position, vertex.surface.normal));
  };
  float sum = 0.0f;
  for (const shading::AreaLight& light : vertex.scene.snapshot.areaLights) sum += irradianceOf(light);
  if (!(sum > 0.0f)) return std::nullopt;
  ChosenAreaLight chosen{nullptr, 0.0f};
  float before = 0.0f;
  for (const shading::AreaLight& light : vertex.scene.snapshot.areaLights) {
    const float irradiance = irradianceOf(light);
    if (irradiance > 0.0f) chosen = {&light, irradiance / sum};  // rounding may carry u past the last one
    before += irradiance;
    if (u * sum < before) break;
  }
  return chosen;
}

// Irradiance from one uniformly chosen point of the triangle, cosines, area and probability of the light included.
glm::vec3 sampledIrradiance(const Vertex& vertex, const ChosenAreaLight& chosen, const glm::vec2& u,
                            std::int64_t& rays) {
  const glm::vec3 a(chosen.light->a), b(chosen.light->b), c(chosen.light->c);
  const float root = std::sqrt(u.x);
  const glm::vec3 point = (1.0f - root) * a + root * (1.0f - u.y) * b + root * u.y * c;
  const glm::vec3 areaNormal = 0.5f * glm::cross(b - a, c - a);  // its length is the area
  const glm::vec3 toPoint = point - vertex.surface.position;
  const float distance = glm::length(toPoint);
  if (distance == 0.0f) return glm::vec3(0.0f);
  const glm::vec3 direction = toPoint / distance;
  const float NoL = glm::dot(vertex.surface.normal, direction);
  float projectedArea = -glm::dot(areaNormal, direction);
  if (chosen.light->a.w > 0.5f) projectedArea = std::abs(projectedArea);
  if (NoL <= 0.0f || projectedArea <= 0.0f) return glm::vec3(0.0f);
  const float visible = visibility(vertex, direction, distance, rays);
  return glm::vec3(chosen.light->radiance) *
         (visible * NoL * projectedArea / (distance * distance * chosen.probability));
}

}  // namespace

float misWeight(float pdf, float otherPdf) {
  if (!(otherPdf > 0.0f)) return 1.0f;
  const float ratio = otherPdf / pdf;  // the squares of the densities themselves might overflow
  return 1.0f / (1.0f + ratio * ratio);
}

float visibility(const Vertex& vertex, const glm::vec3& direction, float distance, std::int64_t& rays) {
  const Ray ray{offsetOrigin(vertex.scene, vertex.hit, vertex.surface.position, direction), direction};
  const float end = kShadowEnd * distance;
  ++rays;
  switch (vertex.scene.occlusion(ray, end)) {
    case Occlusion::none:
      return 1.0f;
    case Occlusion::full:
      return 0.0f;
    case Occlusion::transparent:
      break;
  }
  return transparency(vertex, ray, end, rays);
}

glm::vec3 shadowedLocalRadiance(const Vertex& vertex, Sampler* sampler, std::int64_t& rays) {
  const Snapshot& snapshot = vertex.scene.snapshot;
  const shading::Surface& s = vertex.surface;
  glm::vec3 irradiance(0.0f);
  if (s.kind != shading::kSurfaceUnlit) {
    for (const shading::Light& light : snapshot.lights) irradiance += shadowedIrradiance(vertex, light, rays);
    if (!snapshot.areaLights.empty() && shading::diffuseAlbedo(s) != glm::vec3(0.0f))
      if (const auto chosen = chooseAreaLight(vertex, sampler->next()))
        irradiance += sampledIrradiance(vertex, *chosen, sampler->next2(), rays);
  }
  return shading::localRadiance(s, irradiance, shading::ambientRadiance(snapshot.environment().ambient, s.normal),
                                coatAlbedo(s, vertex.toViewer));
}

DirectLight punctualLight(const Vertex& vertex, const Bsdf& bsdf, bool shadows, std::int64_t& rays) {
  DirectLight sum;
  const glm::vec3& position = vertex.surface.position;
  for (const shading::Light& light : vertex.scene.snapshot.lights) {
    const glm::vec3 irradiance = shading::lightIrradiance(light, position);
    if (irradiance == glm::vec3(0.0f)) continue;
    const glm::vec3 toLight = shading::lightDirection(light, position);
    const LobeValues values = bsdf.evaluate(toLight);
    if (values.diffuse + values.specular == glm::vec3(0.0f)) continue;
    const float distance = distanceTo(light, position);
    const float visible = shadows ? visibility(vertex, toLight, distance, rays) : 1.0f;
    const glm::vec3 arriving = visible * irradiance * unabsorbed(vertex, toLight, distance);
    sum.diffuse += values.diffuse * arriving;
    sum.specular += values.specular * arriving;
  }
  return sum;
}

DirectLight sampledLight(const Vertex& vertex, const Bsdf& bsdf, bool lastSpecular, Sampler& sampler,
                         std::int64_t& rays) {
  const float uChoice = sampler.next();
  const auto light = vertex.scene.lights->sample(vertex.surface.position, sampler.next2(), uChoice);
  if (!light) return {};
  const LobeValues values = bsdf.evaluate(light->direction);
  const glm::vec3 specular = values.specular * misWeight(light->pdf, values.specularPdf) / light->pdf;
  const glm::vec3 diffuse = values.diffuse * misWeight(light->pdf, values.diffusePdf) / light->pdf;
  if (specular + diffuse == glm::vec3(0.0f) || vertex.scene.isHidden(light->instance)) return {};
  const bool isEnvironment = light->instance < 0;
  // Only diffuse lobes look round the limit of specular hits.
  const bool needsRay = !lastSpecular || diffuse != glm::vec3(0.0f);
  const glm::vec3 arriving = needsRay ? light->radiance * unabsorbed(vertex, light->direction, light->distance) *
                                            visibility(vertex, light->direction, light->distance, rays)
                                      : glm::vec3(0.0f);
  if (!lastSpecular) return {diffuse * arriving, specular * arriving};
  return {diffuse * arriving, isEnvironment ? specular * light->radiance : glm::vec3(0.0f)};
}

}  // namespace pb
