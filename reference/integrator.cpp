#include "reference/integrator.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "scenes/environment.h"

namespace pb {
namespace {

// Hits that a path may make before Russian roulette: enough for all chains that are visible in ordinary scenes, which
// therefore stay free of noise.
constexpr int kRouletteFreeHits = 16;
// Below 1, or paths between two perfect mirrors would never end.
constexpr float kMaxSurvival = 0.95f;

// Where a path goes on, and the factor of what arrives from there, divided by the probability of the choice.
struct Branch {
  glm::vec3 direction;
  glm::vec3 weight;
};

// Rec.709.
float luminance(const glm::vec3& c) { return glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f)); }

// A random number is drawn only where there are two ways to go, so that other paths are the same for every sample.
std::optional<Branch> chooseBranch(const shading::Surface& surface, const glm::vec3& d, bool entering,
                                   Sampler& sampler) {
  const float relativeIor = entering ? surface.ior : 1.0f / surface.ior;
  const float cosine = std::max(-glm::dot(surface.normal, d), 0.0f);
  const shading::SpecularWeights weights =
      shading::specularWeights(surface, cosine, relativeIor, glm::vec4(shading::kFresnelExact, 0, 0, 0));
  const glm::vec3 refracted = shading::refractedDirection(d, surface.normal, relativeIor);
  const float reflection = luminance(weights.reflection);
  const float refraction = refracted == glm::vec3(0.0f) ? 0.0f : luminance(weights.refraction);
  if (!(reflection + refraction > 0.0f)) return std::nullopt;

  const float probability = reflection / (reflection + refraction);  // of reflection
  const bool certain = reflection == 0.0f || refraction == 0.0f;
  if (certain ? refraction == 0.0f : sampler.next() < probability)
    return Branch{shading::reflectedDirection(d, surface.normal), weights.reflection / probability};
  return Branch{refracted, weights.refraction / (1.0f - probability)};
}

// Russian roulette: false ends the path, else `throughput` makes up for the paths that ended. Surviving with the last
// hit's own weight keeps the throughput of survivors what it was when roulette began: a small part of the pixel, so
// that the few survivors don't stand out.
bool survives(int specularHits, const glm::vec3& lastWeight, glm::vec3& throughput, Sampler& sampler) {
  if (specularHits <= kRouletteFreeHits) return true;
  const float probability = std::min(std::max({lastWeight.x, lastWeight.y, lastWeight.z}), kMaxSurvival);
  if (sampler.next() >= probability) return false;
  throughput /= probability;
  return true;
}

}  // namespace

PathResult tracePath(const TracedScene& scene, const Ray& primary, float conePerMetre, std::optional<int> depth,
                     Sampler& sampler) {
  const Scene& content = *scene.snapshot.scene;
  PathResult path{glm::vec3(0.0f), 0};
  glm::vec3 throughput(1.0f);
  Ray ray = primary;
  glm::vec3 d = shading::safeNormalize(ray.direction);
  float lengthMetres = 0.0f;
  for (int specularHits = 0;;) {
    const bool unoccluded = specularHits == depth;
    const std::optional<Hit> hit = unoccluded ? std::nullopt : scene.intersect(ray);
    if (!unoccluded) ++path.rays;
    if (!hit) {
      path.radiance += throughput * environmentRadiance(content.environment, d);
      return path;
    }
    lengthMetres += hit->t * glm::length(ray.direction);
    const shading::Surface surface =
        readSurface(scene.snapshot, scene.materialOf(*hit), interpolate(scene, *hit, d, conePerMetre * lengthMetres));
    path.radiance += throughput * localRadiance(scene.snapshot, surface, -d);

    const std::optional<Branch> branch = chooseBranch(surface, d, hit->entering, sampler);
    if (!branch) return path;
    ++specularHits;
    throughput *= branch->weight;
    if (!depth && !survives(specularHits, branch->weight, throughput, sampler)) return path;
    d = shading::safeNormalize(branch->direction);
    ray = {offsetOrigin(scene, *hit, surface.position, d), d};
  }
}

}  // namespace pb
