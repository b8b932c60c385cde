// Paths of the reference renderer through refractive objects: nesting, absorption, dispersion, thin walls.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "reference/medium_stack.h"
#include "reference/renderer.h"
#include "scenes/builtin/shapes.h"
#include "tests/analytic/reference_scenes.h"

namespace pb {
namespace {

using namespace test;

// Radiance a + b * y above the horizon, a below it.
constexpr double kHorizon = 0.2, kSlope = 1.2;
Environment makeLinearSky() {
  shading::Sky sky;
  sky.horizon = glm::vec4(glm::vec3(static_cast<float>(kHorizon)), 0.0f);
  sky.zenith = glm::vec4(glm::vec3(static_cast<float>(kHorizon + kSlope)), 0.0f);
  sky.below = sky.horizon;
  sky.glow = {0.0f, 0.0f, 0.0f, 1.0f};
  sky.toGlow = {0.0f, 1.0f, 0.0f, 0.0f};
  return makeGradientEnvironment(sky);
}
double linearSky(double y) { return kHorizon + kSlope * std::max(y, 0.0); }

// F of a dielectric in doubles, by Snell's law and the two polarisations.
double fresnel(double cosine, double relativeIor) {
  const double sine = std::sqrt(1.0 - cosine * cosine) / relativeIor;
  if (sine >= 1.0) return 1.0;
  const double t = std::sqrt(1.0 - sine * sine);
  const double s = (cosine - relativeIor * t) / (cosine + relativeIor * t);
  const double p = (relativeIor * cosine - t) / (relativeIor * cosine + t);
  return 0.5 * (s * s + p * p);
}

TEST(MediumStack, TheLastEnteredOfThoseNotLeft_IsInnermost) {
  const Material glass = makeGlass(1.5f), water = makeGlass(1.3f);
  const Medium outer{0, 0, &glass}, inner{1, 1, &water};
  MediumStack stack;
  EXPECT_EQ(stack.innermost().ior(), 1.0f);
  stack.enter(outer);
  stack.enter(inner);
  EXPECT_EQ(stack.innermost().ior(), 1.3f);
  stack.leave(outer);  // overlapping, not nested
  EXPECT_EQ(stack.innermost().ior(), 1.3f);
  stack.leave(inner);
  EXPECT_EQ(stack.innermost().ior(), 1.0f);
}

TEST(MediumStack, KnowsTheParts_OfOneMesh) {
  const Material glass = makeGlass(1.5f), water = makeGlass(1.3f);
  const Medium lower{3, 1, &glass}, upper{4, 1, &glass}, content{5, 1, &water};
  MediumStack stack;
  stack.enter(lower);
  EXPECT_TRUE(stack.contains(upper));
  EXPECT_FALSE(stack.contains(content));
  stack.leave(upper);
  EXPECT_EQ(stack.innermost().instance, kVacuum.instance);
}

TEST(MediumStack, ForgetsTheOutermostOfTooMany) {
  const Material glass = makeGlass(1.5f);
  const auto medium = [&](int i) { return Medium{i, i, &glass}; };
  MediumStack stack;
  for (int i = 0; i < 9; ++i) stack.enter(medium(i));
  EXPECT_FALSE(stack.contains(medium(0)));
  for (int i = 8; i > 0; --i) {
    EXPECT_EQ(stack.innermost().instance, i);
    stack.leave(medium(i));
  }
  EXPECT_EQ(stack.innermost().instance, kVacuum.instance);
}

// A ball of the same index as the box around it makes no interface, and draws no random numbers: every sample is that
// of the box alone, up to rounding.
TEST(NestedMedia, OfOneIndex_AreInvisible) {
  const auto reference = [](bool withBall) {
    Scene scene = makeSceneUnder(makeLinearSky());
    add(scene, makeBoxMesh({6.0f, 3.0f, 3.0f}), makeGlass(1.5f));
    if (withBall) add(scene, makeSphereMesh(1.0f, 64, 32), makeGlass(1.5f));
    return std::make_unique<ReferenceScene>(finish(std::move(scene)));
  };
  const auto with = reference(true), without = reference(false);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const glm::vec3 direction(0.1f, 0.004f * static_cast<float>(i) - 0.4f, -1.0f);
    const glm::vec3 a = with->radiance({0.1f, 0.2f, 4.0f}, direction, {.depth = 40}, i);
    const glm::vec3 b = without->radiance({0.1f, 0.2f, 4.0f}, direction, {.depth = 40}, i);
    EXPECT_NEAR(a.x, b.x, 2e-5f) << i;
  }
}

// A ball of index n in a medium of index m turns a ray that meets it at height h by 2 (asin h - asin(h m / n)) towards
// the axis; the face of the box refracts it once more on its way out. Through a ball of air it turns the other way.
TEST(NestedMedia, RefractByTheRatioOfTheirIndices) {
  constexpr double kOuter = 1.5;
  for (const double inner : {1.33, 1.0, 1.8}) {
    Scene scene = makeSceneUnder(makeLinearSky());
    add(scene, makeBoxMesh({8.0f, 8.0f, 4.0f}), makeGlass(static_cast<float>(kOuter)));
    add(scene, makeSphereMesh(1.0f, 512, 256), makeGlass(static_cast<float>(inner)));
    const ReferenceScene reference(finish(std::move(scene)));
    for (const double height : {0.15, 0.35, 0.5}) {
      const double turned = 2.0 * (std::asin(height) - std::asin(height * kOuter / inner));
      // Meets the ball on the side from which it is turned upwards.
      const double sign = turned > 0.0 ? -1.0 : 1.0;
      const glm::vec3 origin(0.01f, sign * height, 4.0f);
      const double radiance = medianOf(samplesAlong(reference, origin, {0, 0, -1}, {}, 31));
      // As for the glass ball in air (reference_test.cpp), with the last refraction on top.
      EXPECT_NEAR(radiance, linearSky(kOuter * std::sin(std::abs(turned))), 6e-4) << inner << " " << height;
    }
  }
}

// Where two balls overlap the one entered last counts: leaving the other changes nothing.
TEST(OverlappingMedia, LeavingTheOuterInsideOfTheInner_IsNoInterface) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  const auto slab = [&](float centre, float ior) {
    Node node;
    node.translation.z = centre;
    add(scene, makeBoxMesh({10.0f, 10.0f, 1.0f}), makeGlass(ior), node);
  };
  slab(0.0f, 1.5f);   // -0.5 to 0.5
  slab(-0.7f, 1.5f);  // -1.2 to -0.2
  add(scene, makeSquareMesh({0, 0, -2}, {1, 0, 0}, {0, 1, 0}, 8.0f), makeEmitter(glm::vec3(1.0f)));
  const ReferenceScene reference(finish(std::move(scene)));
  // One slab with two faces: 2 F (1 - F)^2 / (1 - F^2) less is not reflected away: T = (1 - F) / (1 + F).
  const double F = 0.04;
  const Statistics s = statisticsOf(samplesAlong(reference, {0, 0, 2}, {0, 0, -1}, {}, 20000));
  EXPECT_NEAR(s.mean, (1.0 - F) / (1.0 + F), kSigmas * s.standardError);
}

// A slab of thickness t at normal incidence: (1 - F)^2 a / (1 - F^2 a^2) with a = exp(-absorption t), all orders of
// reflection between its faces summed.
TEST(AbsorbingSlab, TransmitsByBeerLambert) {
  constexpr double kThickness = 0.8, kF = 0.04;
  const glm::vec3 color(0.9f, 0.4f, 0.05f);
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  Material glass = makeGlass(1.5f);
  setAttenuation(glass, color, 0.5f);
  add(scene, makeBoxMesh({10.0f, 10.0f, static_cast<float>(kThickness)}), glass);
  add(scene, makeSquareMesh({0, 0, -2}, {1, 0, 0}, {0, 1, 0}, 8.0f), makeEmitter(glm::vec3(1.0f)));
  const ReferenceScene reference(finish(std::move(scene)));
  std::array<std::vector<double>, 3> values;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const glm::vec3 radiance = reference.radiance({0, 0, 2}, {0, 0, -1}, {}, i);
    for (int c = 0; c < 3; ++c) values[static_cast<std::size_t>(c)].push_back(static_cast<double>(radiance[c]));
  }
  for (int c = 0; c < 3; ++c) {
    const double a = std::pow(static_cast<double>(color[c]), kThickness / 0.5);
    const Statistics s = statisticsOf(values[static_cast<std::size_t>(c)]);
    EXPECT_NEAR(s.mean, (1.0 - kF) * (1.0 - kF) * a / (1.0 - kF * kF * a * a), kSigmas * s.standardError) << c;
  }
}

// From inside of glass light comes out below the angle asin(1 / n) and not above it.
TEST(TotalInternalReflection, BeginsAtTheCriticalAngle) {
  constexpr double kIor = 1.5;
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  add(scene, makeBoxMesh({200.0f, 200.0f, 2.0f}), makeGlass(static_cast<float>(kIor)));
  add(scene, makeSquareMesh({0, 0, -2}, {1, 0, 0}, {0, 1, 0}, 5e3f), makeEmitter(glm::vec3(1.0f)));
  const ReferenceScene reference(finish(std::move(scene)));
  const double critical = std::asin(1.0 / kIor);
  for (const double offset : {-0.1, -0.01, -0.001, 0.001, 0.01, 0.1}) {
    const double angle = critical + offset;
    // At depth 2 a ray that is reflected has met the far face, too, and ends in the black environment.
    const Statistics s = statisticsOf(
        samplesAlong(reference, {0, 0, 0}, glm::vec3(std::sin(angle), 0.0, -std::cos(angle)), {.depth = 2}, 4000));
    const double expected = 1.0 - fresnel(std::cos(angle), 1.0 / kIor);
    EXPECT_NEAR(s.mean, expected, kSigmas * std::sqrt(expected * (1.0 - expected) / 4000) + 1e-4) << offset;
    EXPECT_TRUE(offset < 0.0 || s.mean == 0.0) << offset;
  }
}

Mesh makePrismMesh(double apex) {
  const auto tangent = static_cast<float>(std::tan(0.5 * apex));
  // Apex upwards along Y, height 1, long in Z.
  const std::array<glm::vec2, 3> profile = {glm::vec2(-tangent, 0.0f), glm::vec2(tangent, 0.0f), glm::vec2(0.0f, 1.0f)};
  Mesh mesh;
  mesh.name = "prism";
  const auto quad = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec3& p : {a, b, c, d}) mesh.positions.push_back(p);
    mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
  };
  const auto at = [&](std::size_t i, float z) { return glm::vec3(profile[i], z); };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    quad(at(i, 5.0f), at(i, -5.0f), at(j, -5.0f), at(j, 5.0f));
  }
  for (const float z : {5.0f, -5.0f}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::size_t i = 0; i < 3; ++i) mesh.positions.push_back(at(z > 0.0f ? i : 2 - i, z));
    mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2});
  }
  return mesh;
}

// A prism of apex angle A turns a ray that comes in at angle a by a + a' - A, with sin a' = n sin(A - asin(sin a / n)):
// Snell's law at both faces. The path carries one channel behind the first face, chosen by its share of what is
// refracted; the weight of that choice is known, so that the sky tells the direction.
TEST(Prism, TurnsEachChannelByItsOwnIndex) {
  constexpr double kIor = 1.6, kAbbe = 25.0;
  const double apex = glm::radians(50.0), incidence = glm::radians(42.0);
  // The Cauchy formula through the Fraunhofer lines C, d, F: n_F - n_C = (n_d - 1) / Abbe number.
  const auto inverseSquare = [](double nm) { return 1.0 / (nm * nm); };
  const double slope = (kIor - 1.0) / kAbbe / (inverseSquare(486.1) - inverseSquare(656.3));
  std::array<double, 3> ior, transmitted;
  const std::array<double, 3> lines = {656.3, 587.6, 486.1};
  for (std::size_t c = 0; c < 3; ++c) {
    ior[c] = kIor + slope * (inverseSquare(lines[c]) - inverseSquare(587.6));
    transmitted[c] = 1.0 - fresnel(std::cos(incidence), ior[c]);
  }
  const double weight = (transmitted[0] + transmitted[1] + transmitted[2]) /
                        (0.2126 * transmitted[0] + 0.7152 * transmitted[1] + 0.0722 * transmitted[2]);

  Scene scene = makeSceneUnder(makeLinearSky());
  Material glass = makeGlass(static_cast<float>(kIor));
  glass.constants.kind.w = static_cast<float>(20.0 / kAbbe);
  // Turned upside down, so that rays are turned upwards.
  Node node;
  node.rotation = glm::angleAxis(glm::pi<float>(), glm::vec3(0, 0, 1));
  add(scene, makePrismMesh(apex), glass, node);
  const ReferenceScene reference(finish(std::move(scene)));
  // The normal of the face on the side of -X points down by half the apex angle.
  const double fall = incidence - 0.5 * apex;  // of the ray's direction, downwards
  const glm::dvec3 direction(std::cos(fall), -std::sin(fall), 0.0);
  const glm::vec3 origin = glm::vec3(glm::dvec3(-0.5 * std::tan(0.5 * apex), -0.5, 0.1) - 2.0 * direction);
  std::array<std::vector<double>, 3> seen;
  for (std::uint64_t i = 0; i < 600; ++i) {
    const glm::vec3 radiance = reference.radiance(origin, glm::vec3(direction), {}, i);
    for (int c = 0; c < 3; ++c)
      if (radiance[c] > 0.0f && radiance[c] == radiance.x + radiance.y + radiance.z)
        seen[static_cast<std::size_t>(c)].push_back(static_cast<double>(radiance[c]));
  }
  double last = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    ASSERT_GT(seen[c].size(), 100u);
    const double emergence = std::asin(ior[c] * std::sin(apex - std::asin(std::sin(incidence) / ior[c])));
    const double deviation = incidence + emergence - apex;
    // The shared formula's constants have five and six digits: 4e-6 of index, in a sky of slope 1.2, weighted by 3.
    EXPECT_NEAR(medianOf(seen[c]), weight * linearSky(std::sin(deviation - fall)), 5e-5) << c;
    EXPECT_GT(deviation, last);  // blue more than red
    last = deviation;
  }
}

// Without refraction there is nothing to disperse: reflections keep all channels together.
TEST(Dispersion, LeavesReflectionsWhite) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(1.0f)));
  Material glass = makeGlass(1.5f);
  glass.constants.kind.w = 1.0f;
  add(scene, makeBoxMesh(glm::vec3(1.0f)), glass);
  const ReferenceScene reference(finish(std::move(scene)));
  int reflections = 0;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const glm::vec3 radiance = reference.radiance({0.1f, 0.2f, 3.0f}, {0, 0, -1}, {.depth = 1}, i);
    if (radiance.x == 0.0f || radiance.y == 0.0f || radiance.z == 0.0f) continue;
    ++reflections;
    EXPECT_NEAR(radiance.x, radiance.z, 0.1f);
  }
  EXPECT_GT(reflections, 4);  // of 4 %
  EXPECT_LT(reflections, 40);
}

// A wall without thickness lets light straight through: T = (1 - F) / (1 + F) of both its interfaces, times its colour.
TEST(ThinWall, LetsLightStraightThrough) {
  const double angle = 0.9, F = fresnel(std::cos(angle), 1.5);
  Scene scene = makeSceneUnder(makeLinearSky());
  Material wall = makeGlass(1.5f);
  wall.constants.kind.z = 0.0f;
  wall.constants.baseColor = {0.5f, 0.5f, 0.5f, 1.0f};
  add(scene, makeSquareMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 5.0f), wall);
  const ReferenceScene reference(finish(std::move(scene)));
  const glm::vec3 direction(0.0, std::sin(angle), -std::cos(angle));
  for (const float side : {1.0f, -1.0f}) {  // the same from behind
    const glm::vec3 toward(direction.x, direction.y, side * direction.z);
    const Statistics s = statisticsOf(samplesAlong(reference, -toward, toward, {}, 20000));
    // The reflected direction rises as much as the transmitted one.
    const double expected = (0.5 * (1.0 - F) / (1.0 + F) + 2.0 * F / (1.0 + F)) * linearSky(std::sin(angle));
    EXPECT_NEAR(s.mean, expected, kSigmas * s.standardError + 1e-6);
  }
}

}  // namespace
}  // namespace pb
