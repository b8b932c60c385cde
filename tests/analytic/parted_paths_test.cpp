// Paths that follow all ways of smooth surfaces must have the mean of paths that choose one, and less noise.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "reference/integrator.h"
#include "reference/paths_of_ray.h"
#include "tests/analytic/reference_scenes.h"

namespace pb {
namespace {

using namespace test;

constexpr int kSamples = 2000;

// Balls of clear and of dispersing, absorbing glass, a pane, a veiled mirror and perhaps a rough metal over a matte
// floor.
std::shared_ptr<const Snapshot> makeStill(bool withMetal) {
  Scene scene = makeSceneUnder(makeProceduralSky());
  add(scene, makeSquareMesh({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 3.0f), makeDiffuseMaterial("floor", glm::vec3(0.6f)));
  const auto ball = [&](const Material& material, const glm::vec3& centre) {
    Node node;
    node.translation = centre;
    add(scene, makeSphereMesh(0.4f, 32, 16), material, node);
  };
  Material dispersing = makeGlass(1.7f);
  dispersing.constants.kind.w = 1.0f;
  setAttenuation(dispersing, glm::vec3(0.9f, 0.6f, 0.3f), 0.5f);
  ball(dispersing, {-0.5f, 0.5f, 0});
  ball(makeGlass(1.5f), {0.5f, 0.5f, 0});
  if (withMetal) ball(makeMetalMaterial("metal", glm::vec3(0.2f), glm::vec3(3.0f), 0.4f), {0, 0.5f, -1.0f});
  Material veil = makeMirrorMaterial("veil", glm::vec3(0.7f));
  veil.constants.alpha.x = shading::kAlphaBlend;
  veil.constants.baseColor.w = 0.5f;
  veil.doubleSided = true;
  add(scene, makeSquareMesh({-0.5f, 0.6f, 0.6f}, {1, 0, 0}, {0, 1, 0}, 0.3f), veil);
  Material pane = makeGlass(1.5f);
  pane.constants.kind.z = 0.0f;
  pane.doubleSided = true;
  add(scene, makeSquareMesh({0.5f, 0.6f, 0.6f}, {1, 0, 0}, {0, 1, 0}, 0.3f), pane);
  return finish(std::move(scene));
}

std::vector<Ray> makeRays() {
  std::vector<Ray> rays;
  const glm::vec3 origin(0, 0.8f, 3.0f);
  for (int i = 0; i < 48; ++i)
    rays.push_back(
        {origin,
         glm::vec3(0.2f * static_cast<float>(i % 8) - 0.7f, 0.1f + 0.15f * static_cast<float>(i / 8), 0.0f) - origin});
  return rays;
}

// Of the sum of a ray's channels, each with a weight of its own.
struct Estimates {
  Statistics parted, lone;
};
double weighted(const glm::vec3& radiance) {
  return static_cast<double>(radiance.x + 2.0f * radiance.y + 4.0f * radiance.z);
}

Estimates estimate(const TracedScene& scene, const Ray& ray, const ReferenceSettings& settings) {
  PathsOfRay paths(scene, ray, 0.0f, settings);
  std::vector<double> parted, lone;
  for (std::uint64_t sample = 0; sample < kSamples; ++sample) {
    Sampler one(1, 0, sample), other(2, 0, sample);
    parted.push_back(weighted(paths.trace(one).radiance));
    lone.push_back(weighted(tracePath(scene, ray, 0.0f, settings, other).radiance));
  }
  return {statisticsOf(parted), statisticsOf(lone)};
}

std::vector<ReferenceSettings> manySettings() {
  std::vector<ReferenceSettings> many(3);
  many[1].depth = 3;
  many[2].diffuse = DiffuseTransport::traced;
  return many;
}

// Rounding is some 1e-6 of radiances near 7.
TEST(PartedPaths, HaveTheMeanOfPathsThatChoose) {
  const auto snapshot = makeStill(true);
  const EmbreeScene embree(*snapshot);
  const TracedScene scene{*snapshot, embree, {}, {}};
  for (const ReferenceSettings& settings : manySettings())
    for (const Ray& ray : makeRays()) {
      const auto [parted, lone] = estimate(scene, ray, settings);
      EXPECT_NEAR(parted.mean, lone.mean, kSigmas * std::hypot(parted.standardError, lone.standardError) + 1e-5)
          << ray.direction.x << " " << ray.direction.y;
    }
}

// Where only the choice of a way makes noise: 0.14 of it is left, of ways that carry too little to be followed.
TEST(PartedPaths, AreLessNoisy) {
  const auto snapshot = makeStill(false);
  const EmbreeScene embree(*snapshot);
  const TracedScene scene{*snapshot, embree, {}, {}};
  double parted = 0.0, lone = 0.0;
  for (const Ray& ray : makeRays()) {
    const Estimates estimates = estimate(scene, ray, {});
    parted += estimates.parted.variance;
    lone += estimates.lone.variance;
  }
  EXPECT_LT(parted, 0.2 * lone);
}

glm::vec3 certainRadianceOf(const Material& ball, DiffuseTransport diffuse) {
  Scene content = makeSceneUnder(makeProceduralSky());
  add(content, makeSphereMesh(0.4f, 32, 16), ball);
  const auto snapshot = finish(std::move(content));
  const EmbreeScene embree(*snapshot);
  const TracedScene scene{*snapshot, embree, {}, {}};
  const ReferenceSettings settings{.diffuse = diffuse};
  PathsOfRay paths(scene, {{0.1f, 0.2f, 1.0f}, {0, 0, -1.0f}}, 0.0f, settings);
  EXPECT_TRUE(paths.areCertain());
  Sampler sampler(1, 0, 0);
  return paths.trace(sampler).radiance;
}

// What is refracted comes to the ball's far side with nothing left: exp(-13.8 / 1e-4) is 0 in floats.
TEST(PartedPaths, OfBlackGlass_AreWhatItReflects) {
  Material absorbing = makeGlass(1.7f);
  absorbing.constants.kind.w = 1.0f;
  Material reflecting = absorbing;  // what it lets through is multiplied by its colour
  reflecting.constants.baseColor = glm::vec4(0, 0, 0, 1);
  setAttenuation(absorbing, glm::vec3(0.0f), 1e-4f);
  for (const auto diffuse : {DiffuseTransport::local, DiffuseTransport::traced}) {
    const glm::vec3 radiance = certainRadianceOf(absorbing, diffuse);
    EXPECT_GT(radiance.x, 0.0f);
    EXPECT_EQ(radiance, certainRadianceOf(reflecting, diffuse));
  }
}

TEST(PartedPaths, OfAPane_AreCertain) {
  Scene content = makeSceneUnder(makeProceduralSky());
  Material pane = makeGlass(1.5f);
  pane.constants.kind.z = 0.0f;
  add(content, makeSquareMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f), pane);
  const auto snapshot = finish(std::move(content));
  const EmbreeScene embree(*snapshot);
  const TracedScene scene{*snapshot, embree, {}, {}};
  const ReferenceSettings settings;
  PathsOfRay paths(scene, {{0.1f, 0.2f, 1.0f}, {0.1f, 0.3f, -1.0f}}, 0.0f, settings);
  EXPECT_TRUE(paths.areCertain());
  Sampler sampler(1, 0, 0);
  EXPECT_EQ(paths.trace(sampler).rays, 3);  // to the pane, back and through
  EXPECT_FALSE(sampler.used());
  EXPECT_EQ(paths.trace(sampler).rays, 0);
}

}  // namespace
}  // namespace pb
