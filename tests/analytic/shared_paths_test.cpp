// What makes the reference quicker must not change a bit: parts of paths that are shared, questions that Embree is no
// longer asked, surfaces that are not looked at.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "reference/integrator.h"
#include "reference/light_sampler.h"
#include "reference/paths_of_ray.h"
#include "reference/renderer.h"
#include "tests/analytic/reference_scenes.h"

namespace pb {
namespace {

using namespace test;

// Every way in which a path may branch, closed single-sided meshes to look at and out of, and a veil.
std::shared_ptr<const Snapshot> makeStill(bool withLamp, bool withGlass = true) {
  Scene scene = makeSceneUnder(makeProceduralSky());
  add(scene, makeSquareMesh({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 3.0f), makeDiffuseMaterial("floor", glm::vec3(0.6f)));
  const auto ball = [&](const Material& material, const glm::vec3& centre) {
    Node node;
    node.translation = centre;
    add(scene, makeSphereMesh(0.4f, 32, 16), material, node);
  };
  ball(makeMirrorMaterial("mirror", glm::vec3(0.9f)), {-0.9f, 0.5f, 0});
  if (withGlass) ball(makeGlass(1.5f), {0, 0.5f, 0});
  ball(makeDiffuseMaterial("matte", glm::vec3(0.5f)), {0.9f, 0.5f, 0});
  ball(makeMetalMaterial("metal", glm::vec3(0.2f), glm::vec3(3.0f), 0.4f), {0, 0.5f, 1.2f});
  if (withLamp) {
    Material veil = makeDiffuseMaterial("veil", glm::vec3(0.4f));
    veil.constants.alpha.x = shading::kAlphaBlend;
    veil.constants.baseColor.w = 0.5f;
    add(scene, makeSquareMesh({0, 0.6f, 0.8f}, {1, 0, 0}, {0, 1, 0}, 0.5f), veil);
    add(scene, makeSquareMesh({0, 2.5f, 0}, {1, 0, 0}, {0, 0, 1}, 0.4f), makeEmitter(glm::vec3(4.0f)));
  }
  return finish(std::move(scene));
}

// From above, from inside of the matte ball and from under the floor.
std::vector<Ray> makeRays() {
  std::vector<Ray> rays;
  for (const glm::vec3& origin : {glm::vec3(0, 1.5f, 3.0f), glm::vec3(0.9f, 0.5f, 0.05f), glm::vec3(0.2f, -1.0f, 0.3f)})
    for (int i = 0; i < 225; ++i) {
      const glm::vec3 target(0.15f * static_cast<float>(i % 15) - 1.05f, 0.08f * static_cast<float>(i / 15), 0.1f);
      rays.push_back({origin, target - origin});
    }
  return rays;
}

std::vector<ReferenceSettings> manySettings() {
  std::vector<ReferenceSettings> many(4);
  many[1].depth = 2;
  many[2].diffuse = many[3].diffuse = DiffuseTransport::traced;
  many[3].diffuseDepth = 0;
  return many;
}

// alone(ray, settings, sampler) is one sample of a ray that shares nothing with others.
template <class Alone>
void expectShared(const TracedScene& scene, const Alone& alone) {
  for (const ReferenceSettings& settings : manySettings()) {
    std::int64_t sharedRays = 0, aloneRays = 0;
    for (const Ray& ray : makeRays()) {
      PathsOfRay paths(scene, ray, 1e-3f, settings);
      for (std::uint64_t sample = 0; sample < 4; ++sample) {
        Sampler one(7, 0, sample), other(7, 0, sample);
        const PathResult a = paths.trace(one), b = alone(ray, settings, other);
        ASSERT_EQ(a.radiance, b.radiance);
        EXPECT_EQ(one.used(), other.used());
        sharedRays += a.rays;
        aloneRays += b.rays;
      }
    }
    EXPECT_LT(sharedRays, aloneRays);
  }
}

TEST(PathsOfRay, AreTheSame_WhateverWasTracedBefore) {
  const auto snapshot = makeStill(true);
  const EmbreeScene embree(*snapshot);
  const LightSampler lights(*snapshot);
  const TracedScene scene{*snapshot, embree, {}, {}, &lights};
  expectShared(scene, [&](const Ray& ray, const ReferenceSettings& settings, Sampler& sampler) {
    return PathsOfRay(scene, ray, 1e-3f, settings).trace(sampler);
  });
}

TEST(PathsOfRay, WhereNoWaysPart_AreThePathsTracedAlone) {
  const auto snapshot = makeStill(false, false);
  const EmbreeScene embree(*snapshot);
  const LightSampler lights(*snapshot);
  const TracedScene scene{*snapshot, embree, {}, {}, &lights};
  expectShared(scene, [&](const Ray& ray, const ReferenceSettings& settings, Sampler& sampler) {
    return tracePath(scene, ray, 1e-3f, settings, sampler);
  });
}

// Flags that hide nothing make Embree ask about each candidate.
TEST(Intersection, JudgedAfterTheTraversal_IsTheOneJudgedWithin) {
  const auto snapshot = makeStill(false);
  const EmbreeScene embree(*snapshot);
  const HiddenInstances none(snapshot->instances.size(), 0);
  int hits = 0;
  for (const Ray& ray : makeRays()) {
    const std::optional<Hit> after = embree.intersect(ray, {}), within = embree.intersect(ray, none);
    ASSERT_EQ(after.has_value(), within.has_value());
    if (!after) continue;
    ++hits;
    EXPECT_EQ(after->instance, within->instance);
    EXPECT_EQ(after->triangle, within->triangle);
    EXPECT_EQ(after->t, within->t);
    EXPECT_EQ(after->barycentrics, within->barycentrics);
    EXPECT_EQ(after->geometricNormal, within->geometricNormal);
  }
  EXPECT_GT(hits, 200);
}

TEST(DarkInstances, AreOpaqueAndDontEmit) {
  const auto snapshot = makeStill(true);
  EXPECT_EQ(findDarkInstances(*snapshot), (std::vector<unsigned char>{1, 1, 1, 1, 1, 0, 0}));
}

// With and without lamps: surfaces that aren't looked at, and rays that only ask whether anything is in their way.
TEST(DarkInstances, ChangeNoPicture) {
  ReferenceSettings settings;
  settings.diffuse = DiffuseTransport::traced;
  settings.diffuseDepth = 0;
  for (const bool withLamp : {false, true}) {
    const auto snapshot = makeStill(withLamp);
    const EmbreeScene embree(*snapshot);
    const LightSampler lights(*snapshot);
    const std::vector<unsigned char> dark = findDarkInstances(*snapshot);
    const TracedScene plain{*snapshot, embree, {}, {}, &lights};
    TracedScene known = plain;
    known.dark = dark;
    known.isAllDark = !withLamp;
    for (const Ray& ray : makeRays())
      for (std::uint64_t sample = 0; sample < 4; ++sample) {
        Sampler one(7, 0, sample), other(7, 0, sample);
        ASSERT_EQ(tracePath(plain, ray, 1e-3f, settings, one).radiance,
                  tracePath(known, ray, 1e-3f, settings, other).radiance);
      }
  }
}

}  // namespace
}  // namespace pb
