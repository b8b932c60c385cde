// Small scenes and short cuts for the tests of the reference renderer.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "reference/renderer.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/snapshot.h"

namespace pb::test {

inline Scene makeSceneUnder(Environment environment) {
  Scene scene;
  scene.environment = std::move(environment);
  return scene;
}

inline std::shared_ptr<const Snapshot> finish(Scene scene, double aspect = 1.0) {
  finishScene(scene);
  return makeSnapshot(std::make_shared<const Scene>(std::move(scene)), 0, "", aspect);
}

// Emits, reflects nothing.
inline Material makeEmitter(glm::vec3 radiance) {
  Material material = makeDiffuseMaterial("emitter", glm::vec3(0.0f));
  material.constants.emission = glm::vec4(radiance, material.constants.emission.w);
  return material;
}

// Clear, colourless and smooth.
inline Material makeGlass(float ior) { return makeGlassMaterial("glass", ior); }

inline int add(Scene& scene, Mesh mesh, Material material, Node node = {}) {
  addInstance(scene, mesh.name, finishMesh(std::move(mesh)), addMaterial(scene, std::move(material)), std::move(node));
  return static_cast<int>(scene.instances.size()) - 1;
}

// Square of side 2 `halfEdge` around `centre`, seen from the side to which cross(u, v) points.
inline Mesh makeSquareMesh(glm::vec3 centre, glm::vec3 u, glm::vec3 v, float halfEdge) {
  return makeQuadMesh(centre - halfEdge * (u + v), 2.0f * halfEdge * u, 2.0f * halfEdge * v);
}

inline glm::vec3 radianceAlong(const std::shared_ptr<const Snapshot>& snapshot, glm::vec3 origin, glm::vec3 direction,
                               const ReferenceSettings& settings = {}) {
  return ReferenceScene(snapshot).radiance(origin, direction, settings, 0);
}

// Mean, variance of one sample, and standard error of the mean.
struct Statistics {
  double mean, variance, standardError;
};
inline Statistics statisticsOf(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double v : values) sum += v;
  for (const double v : values) squares += (v - sum / n) * (v - sum / n);
  return {sum / n, squares / (n - 1.0), std::sqrt(squares / (n - 1.0) / n)};
}

// Red channel of samples 0..count-1 of one ray.
inline std::vector<double> samplesAlong(const ReferenceScene& scene, glm::vec3 origin, glm::vec3 direction,
                                        const ReferenceSettings& settings, int count) {
  std::vector<double> values;
  for (int s = 0; s < count; ++s)
    values.push_back(static_cast<double>(scene.radiance(origin, direction, settings, static_cast<std::uint64_t>(s)).x));
  return values;
}

// The commonest outcome where one branch of glass has a probability well above one half.
inline double medianOf(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

// Verdicts are two-sided at 4.5 standard errors: 7 in a million for a normal variable.
inline constexpr double kSigmas = 4.5;

}  // namespace pb::test
