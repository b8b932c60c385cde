// Light of the reference renderer's diffuse and rough surfaces: global illumination, shadows, coverage, light samples.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "reference/bsdf.h"
#include "reference/embree_scene.h"
#include "reference/integrator.h"
#include "reference/light_sampler.h"
#include "reference/renderer.h"
#include "scenes/builtin/shapes.h"
#include "scenes/luminance.h"
#include "tests/analytic/reference_scenes.h"

namespace pb {
namespace {

using namespace test;

const ReferenceSettings kTraced{.diffuse = DiffuseTransport::traced};

ReferenceSettings tracedTo(int diffuseDepth) {
  ReferenceSettings settings = kTraced;
  settings.diffuseDepth = diffuseDepth;
  return settings;
}

Material makeGlossy(float roughness, float metallic, glm::vec3 color) {
  Material m = makeDiffuseMaterial("glossy", color);
  m.constants.kind.x = shading::kSurfaceGlossy;
  m.constants.factors = {metallic, roughness, 1.0f, 0.0f};
  m.constants.specular.w = 1.0f;
  return m;
}

Material veiled(Material material, float opacity) {
  material.constants.baseColor.w = opacity;
  material.constants.alpha.x = shading::kAlphaBlend;
  return material;
}

void addPointLight(Scene& scene, const glm::vec3& position, const glm::vec3& intensity) {
  Node node;
  node.translation = position;
  scene.nodes.push_back(node);
  scene.lights.push_back(
      {.node = static_cast<int>(scene.nodes.size()) - 1, .kind = shading::kLightPoint, .intensity = intensity});
}

// A floor at y = 0 seen from above.
Mesh makeFloor(float halfEdge) { return makeSquareMesh({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, halfEdge); }

// Inside of a sphere whose walls emit E and reflect a, radiance is the same everywhere: L = E + a L.
std::shared_ptr<const Snapshot> makeGlowingSphere(double emission, double albedo) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  Material wall = makeDiffuseMaterial("wall", glm::vec3(static_cast<float>(albedo)));
  wall.constants.emission = glm::vec4(glm::vec3(static_cast<float>(emission)), 1.0f);
  wall.doubleSided = true;
  add(scene, makeSphereMesh(1.0f, 32, 16), wall);
  return finish(std::move(scene));
}

TEST(GlowingSphere, Converged_HasTheSumOfAllBounces) {
  constexpr double kEmission = 0.5, kAlbedo = 0.8;
  const ReferenceScene scene(makeGlowingSphere(kEmission, kAlbedo));
  const Statistics s = statisticsOf(samplesAlong(scene, {0.1f, 0.2f, 0.3f}, {0, 0, -1}, kTraced, 20000));
  EXPECT_NEAR(s.mean, kEmission / (1.0 - kAlbedo), kSigmas * s.standardError);
  EXPECT_LT(s.standardError, 0.03);
}

// Direct light after N bounces: the emission that is seen, and N + 1 reflections of it.
TEST(GlowingSphere, AfterNDiffuseBounces_HasNPlusTwoTerms) {
  constexpr double kEmission = 0.5, kAlbedo = 0.8;
  const ReferenceScene scene(makeGlowingSphere(kEmission, kAlbedo));
  for (int n = 0; n < 8; ++n) {
    const Statistics s = statisticsOf(samplesAlong(scene, {0.1f, 0.2f, 0.3f}, {0, 0, -1}, tracedTo(n), 4000));
    const double expected = kEmission * (1.0 - std::pow(kAlbedo, n + 2)) / (1.0 - kAlbedo);
    EXPECT_NEAR(s.mean, expected, kSigmas * s.standardError + 1e-5) << n;
    EXPECT_LT(s.standardError, 0.03) << n;
  }
}

// A plane sees half of a constant sky over an infinite black wall beside it: half of the irradiance, at any diffuse
// depth.
TEST(DiffuseFloor, BesideABlackWall_GetsHalfOfTheSky) {
  constexpr double kAlbedo = 0.6;
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(1.0f)));
  add(scene, makeFloor(100.0f), makeDiffuseMaterial("floor", glm::vec3(static_cast<float>(kAlbedo))));
  Material black = makeDiffuseMaterial("wall", glm::vec3(0.0f));
  black.doubleSided = true;
  // The wall's top is seen 2e-3 below the zenith from a point 1 mm beside it.
  add(scene, makeSquareMesh({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 50.0f), black);
  const ReferenceScene reference(finish(std::move(scene)));
  for (const std::optional<int> depth : {std::optional<int>(0), std::optional<int>()}) {
    ReferenceSettings settings = kTraced;
    settings.diffuseDepth = depth;
    const glm::vec3 origin(0.001f, 1.0f, 0.0f);
    const Statistics s = statisticsOf(samplesAlong(reference, origin, {0, -1, 0}, settings, 20000));
    EXPECT_NEAR(s.mean, 0.5 * kAlbedo, kSigmas * s.standardError + 1e-3);
  }
}

TEST(Traced, IgnoresWhatStandsInForLight) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  scene.environment.ambient = constantAmbient(glm::vec3(5.0f));
  add(scene, makeFloor(10.0f), makeDiffuseMaterial("floor", glm::vec3(0.5f)));
  EXPECT_EQ(radianceAlong(finish(std::move(scene)), {0, 1, 0}, {0, -1, 0}, kTraced), glm::vec3(0.0f));
}

// Irradiance I cos / d^2 of a point light, reflected by a Lambertian floor, where the light is seen.
struct PointLightCase {
  const char* name;
  bool shadows;
  DiffuseTransport diffuse;
  float blocker;  // its opacity
  double visible;
};
void PrintTo(const PointLightCase& c, std::ostream* out) { *out << c.name; }
class PointLight : public testing::TestWithParam<PointLightCase> {};

TEST_P(PointLight, LightsAFloorByTheClosedForm) {
  const PointLightCase& c = GetParam();
  constexpr double kAlbedo = 0.5, kIntensity = 20.0, kHeight = 3.0;
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  scene.castsShadows = c.shadows;
  add(scene, makeFloor(10.0f), makeDiffuseMaterial("floor", glm::vec3(static_cast<float>(kAlbedo))));
  // Black, seen from below: between the light and all of the points looked at.
  add(scene, makeSquareMesh({0, 2, 0}, {1, 0, 0}, {0, 0, 1}, 3.0f),
      veiled(makeDiffuseMaterial("blocker", glm::vec3(0.0f)), c.blocker));
  addPointLight(scene, {0, static_cast<float>(kHeight), 0}, glm::vec3(static_cast<float>(kIntensity)));
  const ReferenceScene reference(finish(std::move(scene)));
  for (const double x : {0.0, 0.7, 2.0}) {
    ReferenceSettings settings;
    settings.diffuse = c.diffuse;
    settings.diffuseDepth = 0;
    const double squared = x * x + kHeight * kHeight;
    const double irradiance = kIntensity * kHeight / std::pow(squared, 1.5);
    const float radiance = reference.radiance({static_cast<float>(x), 1, 0}, {0, -1, 0}, settings, 0).x;
    EXPECT_NEAR(static_cast<double>(radiance), c.visible * kAlbedo / glm::pi<double>() * irradiance, 1e-6) << x;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, PointLight,
    testing::Values(PointLightCase{"local light casts no shadow", false, DiffuseTransport::local, 1.0f, 1.0},
                    PointLightCase{"shadow", true, DiffuseTransport::local, 1.0f, 0.0},
                    PointLightCase{"shadow of a veil", true, DiffuseTransport::local, 0.25f, 0.75},
                    PointLightCase{"shadow of nothing", true, DiffuseTransport::local, 0.0f, 1.0},
                    PointLightCase{"traced shadow", false, DiffuseTransport::traced, 1.0f, 0.0},
                    PointLightCase{"traced shadow of a veil", false, DiffuseTransport::traced, 0.25f, 0.75}));

// Of four samples none differs from the others: point lights alone need no random numbers.
TEST(PointLight, Shadowed_IsFreeOfNoise) {
  Scene scene = makeSceneUnder(makeProceduralSky());
  scene.castsShadows = true;
  add(scene, makeFloor(10.0f), makeDiffuseMaterial("floor", glm::vec3(0.5f)));
  add(scene, makeSphereMesh(0.5f, 16, 8), makeDiffuseMaterial("ball", glm::vec3(0.5f)));
  addPointLight(scene, {0, 3, 0}, glm::vec3(5.0f));
  const auto samples = samplesAlong(ReferenceScene(finish(std::move(scene))), {0.7f, 1, 0}, {0, -1, 0}, {}, 4);
  EXPECT_EQ(statisticsOf(samples).variance, 0.0);
}

// A lamp over a floor: sampled with shadow rays it gives what the closed form gives without them, locally and traced.
TEST(AreaLight, Unoccluded_GivesTheClosedFormHoweverItIsSampled) {
  const auto reference = [](bool shadows) {
    Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
    scene.castsShadows = shadows;
    add(scene, makeFloor(10.0f), makeDiffuseMaterial("floor", glm::vec3(0.7f)));
    add(scene, makeSquareMesh({0.5f, 1, 0}, {1, 0, 0}, {0, 0, 1}, 0.5f), makeEmitter(glm::vec3(2.0f)));
    // Beside the floor's points: half of it is below their horizon.
    add(scene, makeSquareMesh({-2, 0, 0}, {0, 0, 1}, {0, -1, 0}, 0.5f), makeEmitter(glm::vec3(3.0f)));
    return std::make_unique<ReferenceScene>(finish(std::move(scene)));
  };
  const auto closed = reference(false), shadowed = reference(true);
  for (const float x : {0.3f, -1.0f, 2.5f}) {
    const glm::vec3 origin(x, 0.5f, 0.2f), down(0, -1, 0);
    const auto expected = static_cast<double>(closed->radiance(origin, down, {}, 0).x);
    for (const ReferenceSettings& settings : {ReferenceSettings{}, tracedTo(0)}) {
      const Statistics s = statisticsOf(samplesAlong(*shadowed, origin, down, settings, 20000));
      EXPECT_NEAR(s.mean, expected, kSigmas * s.standardError) << x;
      EXPECT_LT(s.standardError, 0.02 * expected) << x;
    }
  }
}

TEST(AreaLight, BehindABlocker_IsDark) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  scene.castsShadows = true;
  add(scene, makeFloor(10.0f), makeDiffuseMaterial("floor", glm::vec3(0.7f)));
  add(scene, makeSquareMesh({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 0.5f), makeEmitter(glm::vec3(2.0f)));
  add(scene, makeSquareMesh({0, 0.8f, 0}, {1, 0, 0}, {0, 0, 1}, 5.0f), makeDiffuseMaterial("b", glm::vec3(0.0f)));
  const ReferenceScene reference(finish(std::move(scene)));
  for (const ReferenceSettings& settings : {ReferenceSettings{}, kTraced})
    EXPECT_EQ(statisticsOf(samplesAlong(reference, {0.1f, 0.5f, 0}, {0, -1, 0}, settings, 200)).mean, 0.0);
}

// Layers of coverage o that emit E before a sky of 1: from front to back the sum of o E (1 - o)^k, then (1 - o)^n.
TEST(Coverage, OfDiffuseLayers_AddsUpWithoutNoise) {
  constexpr double kOpacity = 0.3, kEmission = 2.0;
  constexpr int kLayers = 5;
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(1.0f)));
  for (int i = 0; i < kLayers; ++i)
    add(scene, makeSquareMesh({0, 0, -static_cast<float>(i)}, {1, 0, 0}, {0, 1, 0}, 1.0f),
        veiled(makeEmitter(glm::vec3(static_cast<float>(kEmission))), static_cast<float>(kOpacity)));
  const auto snapshot = finish(std::move(scene));
  const double behind = std::pow(1.0 - kOpacity, kLayers);
  for (const std::optional<int> depth : {std::optional<int>(1), std::optional<int>()}) {
    const auto samples = samplesAlong(ReferenceScene(snapshot), {0.1f, 0, 2}, {0, 0, -1}, {.depth = depth}, 4);
    EXPECT_EQ(statisticsOf(samples).variance, 0.0);
    EXPECT_NEAR(samples.front(), kEmission * (1.0 - behind) + behind, 1e-6);
  }
}

// Half of a mirror before half of an emitter before the sky; the mirror sees the sky as well.
TEST(Coverage, OfAMirror_IsItsShareInTheMean) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(1.0f)));
  add(scene, makeSquareMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f),
      veiled(makeMirrorMaterial("mirror", glm::vec3(0.5f)), 0.4f));
  add(scene, makeSquareMesh({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, 1.0f), veiled(makeEmitter(glm::vec3(3.0f)), 0.5f));
  const ReferenceScene reference(finish(std::move(scene)));
  const Statistics s = statisticsOf(samplesAlong(reference, {0.1f, 0, 2}, {0, 0, -1}, {}, 20000));
  EXPECT_NEAR(s.mean, 0.4 * 0.5 + 0.6 * (0.5 * 3.0 + 0.5), kSigmas * s.standardError);
}

TEST(Coverage, OfNothing_IsNotThere) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  for (const float z : {1.5f, 1.0f, -1.0f})
    add(scene, makeSquareMesh({0, 0, z}, {1, 0, 0}, {0, 1, 0}, 2.0f), veiled(makeMirrorMaterial("mirror"), 0.0f));
  add(scene, makeSquareMesh({0, 0, -2}, {1, 0, 0}, {0, 1, 0}, 2.0f), makeMirrorMaterial("mirror", glm::vec3(0.5f)));
  add(scene, makeSquareMesh({0, 0, 3}, {-1, 0, 0}, {0, 1, 0}, 2.0f), makeEmitter(glm::vec3(1.0f)));
  const ReferenceScene reference(finish(std::move(scene)));
  // The second hit is that of the emitter: at depth 2 the path still gets there.
  const auto samples = samplesAlong(reference, {0.1f, 0, 2}, {0, 0, -1}, {.depth = 2}, 4);
  EXPECT_EQ(statisticsOf(samples).variance, 0.0);
  EXPECT_NEAR(samples.front(), 0.5, 1e-6);
}

// After its only hit a rough metal sees the environment, which nothing hides.
TEST(Depth, OfARoughMetal_ShowsTheEnvironmentUnoccluded) {
  const auto mean = [](bool enclosed) {
    Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(1.0f)));
    add(scene, makeFloor(1.0f), makeGlossy(0.5f, 1.0f, glm::vec3(1.0f)));
    Material box = makeEmitter(glm::vec3(7.0f));
    box.doubleSided = true;
    if (enclosed) add(scene, makeBoxMesh(glm::vec3(8.0f)), box);
    return statisticsOf(
        samplesAlong(ReferenceScene(finish(std::move(scene))), {0, 1, 0.2f}, {0, -1, 0}, {.depth = 1}, 20000));
  };
  const Statistics open = mean(false), enclosed = mean(true);
  EXPECT_NEAR(open.mean, enclosed.mean, kSigmas * std::hypot(open.standardError, enclosed.standardError));
  EXPECT_LT(open.standardError, 5e-3);
}

// What a probe leaves out of its captures gives no light to rough surfaces either.
TEST(HiddenLamp, IsDarkForRoughMetal) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  add(scene, makeFloor(5.0f), makeGlossy(0.6f, 1.0f, glm::vec3(1.0f)));
  const int lamp = add(scene, makeSquareMesh({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 0.5f), makeEmitter(glm::vec3(2.0f)));
  const ReferenceScene reference(finish(std::move(scene)));
  const glm::vec3 origin(0.0f, 0.5f, 0.7f), direction(0.0f, -0.5f, -0.5f);
  EXPECT_GT(statisticsOf(samplesAlong(reference, origin, direction, {}, 200)).mean, 0.1);
  ReferenceSettings settings;
  settings.hiddenInstances = {lamp};
  EXPECT_EQ(statisticsOf(samplesAlong(reference, origin, direction, settings, 200)).mean, 0.0);
}

// Sum over a grid of primary rays, each with samples of its own.
Statistics sumOver(const TracedScene& scene, const ReferenceSettings& settings, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const auto x = 0.1f * static_cast<float>(i % 21) - 1.0f, z = 0.1f * static_cast<float>(i / 21 % 21) - 1.0f;
    Sampler sampler(5, static_cast<std::uint32_t>(i % 441), static_cast<std::uint64_t>(i / 441));
    const glm::vec3 origin(0.0f, 2.0f, 1.5f);
    const PathResult path = tracePath(scene, {origin, glm::vec3(x, 0.0f, z) - origin}, 0.0f, settings, sampler);
    values.push_back(static_cast<double>(luminance(path.radiance)));
  }
  return statisticsOf(values);
}

struct MisCase {
  const char* name;
  Material material;
  ReferenceSettings settings;
};
void PrintTo(const MisCase& c, std::ostream* out) { *out << c.name; }
class LightSamples : public testing::TestWithParam<MisCase> {};

// Light samples change the noise, not the mean: nothing is counted twice and nothing is lost. Two-sided test of the
// difference of two means; the rays of both are the same, their samples hardly correlated.
TEST_P(LightSamples, KeepTheMean) {
  const MisCase& c = GetParam();
  Scene scene = makeSceneUnder(makeProceduralSky());
  scene.environment.sky.glow.w = 40.0f;
  add(scene, makeFloor(3.0f), c.material);
  Material lamp = makeEmitter(glm::vec3(6.0f, 5.0f, 4.0f));
  lamp.doubleSided = true;
  add(scene, makeSquareMesh({0.3f, 0.8f, -0.6f}, {1, 0, 0}, {0, 1, 0}, 0.3f), lamp);
  add(scene, makeSquareMesh({-0.8f, 0.5f, 0}, {0, 0, 1}, {0, 1, 0}, 0.4f), veiled(makeEmitter(glm::vec3(1.0f)), 0.5f));
  Node node;
  node.translation = {0.7f, 0.3f, 0.4f};
  add(scene, makeSphereMesh(0.3f, 32, 16), makeGlass(1.5f), node);
  const auto snapshot = finish(std::move(scene));
  const EmbreeScene embree(*snapshot);
  const LightSampler lights(*snapshot);
  const HiddenInstances hidden(snapshot->instances.size(), 0);
  const Statistics with = sumOver({*snapshot, embree, hidden, hidden, &lights}, c.settings, 60000);
  const Statistics without = sumOver({*snapshot, embree, hidden, hidden, nullptr}, c.settings, 240000);
  EXPECT_NEAR(with.mean, without.mean, kSigmas * std::hypot(with.standardError, without.standardError));
  EXPECT_LT(without.standardError, 0.01 * without.mean);
}

Material makeRoughGlass() {
  Material m = makeGlass(1.3f);
  m.constants.factors.y = 0.4f;
  m.constants.kind.z = 0.0f;
  return m;
}

ReferenceSettings atDepth(int depth) {
  ReferenceSettings settings;
  settings.depth = depth;
  return settings;
}
ReferenceSettings tracedAtDepth(int depth, int diffuseDepth) {
  ReferenceSettings settings = tracedTo(diffuseDepth);
  settings.depth = depth;
  return settings;
}

INSTANTIATE_TEST_SUITE_P(
    All, LightSamples,
    testing::Values(MisCase{"rough metal", makeGlossy(0.5f, 1.0f, glm::vec3(0.9f, 0.7f, 0.4f)), {}},
                    MisCase{"smoother metal", makeGlossy(0.25f, 1.0f, glm::vec3(0.9f)), {}},
                    MisCase{"rough metal at depth 1", makeGlossy(0.5f, 1.0f, glm::vec3(0.9f)), atDepth(1)},
                    MisCase{"rough metal at depth 2", makeGlossy(0.5f, 1.0f, glm::vec3(0.9f)), atDepth(2)},
                    MisCase{"coated", makeGlossy(0.4f, 0.0f, glm::vec3(0.6f)), {}},
                    MisCase{"veil", veiled(makeGlossy(0.4f, 0.0f, glm::vec3(0.6f)), 0.5f), {}},
                    MisCase{"thin rough glass", makeRoughGlass(), {}},
                    MisCase{"traced diffuse", makeDiffuseMaterial("d", glm::vec3(0.7f)), kTraced},
                    MisCase{"traced diffuse at 0 bounces", makeDiffuseMaterial("d", glm::vec3(0.7f)), tracedTo(0)},
                    MisCase{"traced coated", makeGlossy(0.4f, 0.0f, glm::vec3(0.6f)), kTraced},
                    MisCase{"traced coated at 0 bounces", makeGlossy(0.4f, 0.0f, glm::vec3(0.6f)), tracedTo(0)},
                    MisCase{"traced coated at depth 1", makeGlossy(0.4f, 0.0f, glm::vec3(0.6f)), tracedAtDepth(1, 1)},
                    MisCase{"traced veil", veiled(makeGlossy(0.4f, 0.0f, glm::vec3(0.6f)), 0.5f), kTraced}));

// Light that rough glass sends through both its faces, from a lamp inside of it, too.
TEST(LightSamples, ThroughRoughGlass_KeepTheMean) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.3f)));
  Material glass = makeGlass(1.4f);
  glass.constants.factors.y = 0.5f;
  setAttenuation(glass, {0.5f, 0.7f, 0.9f}, 1.0f);
  add(scene, makeBoxMesh({4.0f, 1.0f, 4.0f}), glass);
  Material lamp = makeEmitter(glm::vec3(5.0f));
  lamp.doubleSided = true;
  add(scene, makeSquareMesh({0.2f, 0.0f, -0.3f}, {1, 0, 0}, {0, 0, 1}, 0.3f), lamp);
  add(scene, makeSquareMesh({-0.3f, -1.0f, 0.3f}, {1, 0, 0}, {0, 0, 1}, 0.3f), lamp);
  const auto snapshot = finish(std::move(scene));
  const EmbreeScene embree(*snapshot);
  const LightSampler lights(*snapshot);
  const HiddenInstances hidden(snapshot->instances.size(), 0);
  const Statistics with = sumOver({*snapshot, embree, hidden, hidden, &lights}, {}, 60000);
  const Statistics without = sumOver({*snapshot, embree, hidden, hidden, nullptr}, {}, 120000);
  EXPECT_NEAR(with.mean, without.mean, kSigmas * std::hypot(with.standardError, without.standardError));
}

}  // namespace
}  // namespace pb
