// Light transport of the reference renderer against closed forms.
#include "reference/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "scenes/builtin/shapes.h"
#include "tests/analytic/reference_scenes.h"

namespace pb {
namespace {

using namespace test;

const glm::vec3 kHorizon(0.2f, 0.5f, 0.9f);
const glm::vec3 kZenith(1.4f, 0.3f, 0.1f);

// Radiance linear in the direction's y above the horizon and constant below, without a step.
Environment makeLinearSky() {
  shading::Sky sky;
  sky.horizon = glm::vec4(kHorizon, 0.0f);
  sky.zenith = glm::vec4(kZenith, 0.0f);
  sky.below = sky.horizon;
  sky.glow = {0.0f, 0.0f, 0.0f, 1.0f};
  sky.toGlow = {0.0f, 1.0f, 0.0f, 0.0f};
  return makeGradientEnvironment(sky);
}

glm::dvec3 linearSky(const glm::dvec3& d) {
  const double y = std::max(d.y / glm::length(d), 0.0);
  return (1.0 - y) * glm::dvec3(kHorizon) + y * glm::dvec3(kZenith);
}

double largestDifference(const glm::vec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = glm::abs(glm::dvec3(a) - b);
  return std::max({d.x, d.y, d.z});
}

// Direction of the only sample of pixel (x, y) in an image of n x n pixels.
glm::dvec3 pixelDirection(const shading::View& view, int x, int y, int n) {
  const glm::dvec2 st = (2.0 * glm::dvec2(x, y) + 1.0) / static_cast<double>(n) - 1.0;
  return glm::normalize(glm::dvec3(glm::vec3(view.forward)) + st.x * glm::dvec3(glm::vec3(view.right)) +
                        st.y * glm::dvec3(glm::vec3(view.down)));
}

TEST(FlatMirror, UnderLinearSky_MatchesClosedForm) {
  const glm::dvec3 f0(0.9, 0.6, 0.3);
  Scene scene = makeSceneUnder(makeLinearSky());
  add(scene, makeSquareMesh({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 1e3f), makeMirrorMaterial("mirror", glm::vec3(f0)));
  addCamera(scene, "camera", {0, 2, 5}, {0, 0, 0}, glm::radians(60.0f), 0.1f);
  const auto snapshot = finish(std::move(scene));
  constexpr int kSize = 32;
  const Image image =
      ReferenceScene(snapshot).render(snapshot->camera, kSize, kSize, {.samplesPerAxis = 1, .spp = 2}).mean();
  int reflected = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const glm::dvec3 d = pixelDirection(snapshot->camera, x, y, kSize);
      if (d.y > -0.01) continue;  // beyond the mirror's edge
      ++reflected;
      // Schlick's reflectance of a plane with normal +Y at cosine -d.y; the reflected ray has y = -d.y.
      const glm::dvec3 reflectance = f0 + (1.0 - f0) * std::pow(1.0 + d.y, 5.0);
      // A dozen float roundings of values below 1.5.
      EXPECT_LT(largestDifference(image(x, y), reflectance * linearSky({d.x, -d.y, d.z})), 2e-6) << x << " " << y;
    }
  EXPECT_GT(reflected, kSize * kSize / 2);
}

// RMS error of a tessellated mirror ball against the exact one, over the pixels where the view meets it at a cosine
// above 0.2.
double mirrorBallError(int segments) {
  Scene scene = makeSceneUnder(makeLinearSky());
  add(scene, makeSphereMesh(1.0f, segments, segments / 2), makeMirrorMaterial("mirror"));
  const glm::dvec3 eye(1, 2, 4);
  addCamera(scene, "camera", glm::vec3(eye), {0, 0, 0}, glm::radians(30.0f), 0.1f);
  const auto snapshot = finish(std::move(scene));
  constexpr int kSize = 96;
  const Image image =
      ReferenceScene(snapshot).render(snapshot->camera, kSize, kSize, {.samplesPerAxis = 1, .spp = 2}).mean();
  double squares = 0.0;
  int count = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const glm::dvec3 d = pixelDirection(snapshot->camera, x, y, kSize);
      const double b = glm::dot(eye, d), discriminant = b * b - glm::dot(eye, eye) + 1.0;
      if (discriminant < 0.2 * 0.2) continue;  // its root is the cosine at the unit sphere
      const glm::dvec3 n = eye + (-b - std::sqrt(discriminant)) * d;
      const glm::dvec3 error = glm::dvec3(image(x, y)) - linearSky(d - 2.0 * glm::dot(d, n) * n);
      squares += glm::dot(error, error);
      count += 3;
    }
  EXPECT_GT(count, 3 * kSize * kSize / 4);
  return std::sqrt(squares / count);
}

// A chord lies theta^2 / 8 inside the sphere, theta the angle of a segment, and so does the point that is shaded: the
// error is of second order.
TEST(MirrorBall, UnderLinearSky_ConvergesToClosedForm) {
  const double coarse = mirrorBallError(64), fine = mirrorBallError(256);
  const double theta = glm::two_pi<double>() / 256;
  EXPECT_LT(fine, theta * theta);
  EXPECT_NEAR(coarse / fine, 16.0, 4.0);
}

// Mirrors of reflectance rho that face each other along Z, unbounded for the rays here, and both emit 1.
std::shared_ptr<const Snapshot> makeFacingMirrors(float rho, float halfEdge, float emission, glm::vec3 sky) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(sky));
  Material mirror = makeMirrorMaterial("mirror", glm::vec3(rho));
  mirror.constants.emission = glm::vec4(glm::vec3(emission), 1.0f);
  add(scene, makeSquareMesh({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, halfEdge), mirror);
  add(scene, makeSquareMesh({0, 0, 1}, {-1, 0, 0}, {0, 1, 0}, halfEdge), mirror);
  return finish(std::move(scene));
}

// K hits see the emission of K mirrors, each through one reflection more, then the sky: the sum over k < K of rho^k
// plus rho^K L_sky.
TEST(FacingMirrors, AtDepthK_GiveKTermsOfTheGeometricSeries) {
  constexpr double kRho = 0.75, kSky = 3.0;
  const auto snapshot = makeFacingMirrors(static_cast<float>(kRho), 10.0f, 1.0f, glm::vec3(kSky));
  for (int depth = 1; depth <= 24; ++depth) {
    const double power = std::pow(kRho, depth);
    const double expected = (1.0 - power) / (1.0 - kRho) + power * kSky;
    const glm::vec3 radiance = radianceAlong(snapshot, {0.3f, 0.2f, 0.1f}, {0, 0, -1}, {.depth = depth});
    EXPECT_NEAR(static_cast<double>(radiance.x), expected, 1e-6 * expected) << "depth " << depth;
  }
}

TEST(FacingMirrors, Converged_SumTheWholeGeometricSeries) {
  constexpr double kRho = 0.9;
  const ReferenceScene scene(makeFacingMirrors(static_cast<float>(kRho), 10.0f, 1.0f, glm::vec3(0.0f)));
  const Statistics s = statisticsOf(samplesAlong(scene, {0.3f, 0.2f, 0.1f}, {0, 0, -1}, {}, 20000));
  const double expected = 1.0 / (1.0 - kRho);
  EXPECT_NEAR(s.mean, expected, kSigmas * s.standardError);
  // The last term lost would be rho^16 = 19 % of the sum.
  EXPECT_LT(s.standardError, 0.01 * expected);
}

// Between perfect mirrors a ray that walks off the edge after 24 hits survives 8 times with 0.95: its samples are 0 or
// 0.95^-8 times the sky, with mean 1 and variance 0.95^-8 - 1 (see tracePath).
TEST(FacingMirrors, Perfect_RouletteHasTheStatedMeanAndVariance) {
  constexpr float kHalfEdge = 4.0f;
  const ReferenceScene scene(makeFacingMirrors(1.0f, kHalfEdge, 0.0f, glm::vec3(1.0f)));
  // Hit k (from 0) is at x = (1 + 2 k) slope; the 24th at 47 slope is still on a mirror and the 25th would be at 49
  // slope.
  const glm::vec3 direction(kHalfEdge / 48.0f, 0.0f, -1.0f);
  constexpr int kCount = 20000;
  const Statistics s = statisticsOf(samplesAlong(scene, {0, 0, 0}, direction, {}, kCount));
  const double survival = std::pow(0.95, 8), variance = 1.0 / survival - 1.0;
  EXPECT_NEAR(s.mean, 1.0, kSigmas * std::sqrt(variance / kCount));
  // Variance of a variance: (fourth central moment - variance^2) / n, for a Bernoulli variable over its mean.
  const double kurtosisTerm = variance * (1.0 - 4.0 * survival * (1.0 - survival)) / (survival * survival);
  EXPECT_NEAR(s.variance, variance, kSigmas * std::sqrt(kurtosisTerm / kCount) + 1e-3);
}

TEST(FacingMirrors, PerfectAndEndless_Terminate) {
  const auto snapshot = makeFacingMirrors(1.0f, 10.0f, 0.0f, glm::vec3(1.0f));
  EXPECT_EQ(radianceAlong(snapshot, {0, 0, 0}, {0, 0, -1}), glm::vec3(0.0f));
}

TEST(Depth, LastDirection_ShowsTheEnvironmentUnoccluded) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f, 0.0f, 1.0f)));
  add(scene, makeSquareMesh({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, 10.0f), makeMirrorMaterial("mirror"));
  add(scene, makeSquareMesh({0, 0, 1}, {-1, 0, 0}, {0, 1, 0}, 10.0f), makeEmitter({1.0f, 0.0f, 0.0f}));
  const auto snapshot = finish(std::move(scene));
  const glm::vec3 emitter(1.0f, 0.0f, 0.0f), sky(0.0f, 0.0f, 1.0f);
  EXPECT_EQ(radianceAlong(snapshot, {0, 0, 0}, {0, 0, -1}, {.depth = 1}), sky);
  EXPECT_EQ(radianceAlong(snapshot, {0, 0, 0}, {0, 0, -1}, {.depth = 2}), emitter);
  EXPECT_EQ(radianceAlong(snapshot, {0, 0, 0}, {0, 0, -1}), emitter);
  // Without a specular hit the depth changes nothing.
  EXPECT_EQ(radianceAlong(snapshot, {0, 0, 0}, {0, 0, 1}, {.depth = 1}), emitter);
}

struct FurnaceCase {
  const char* name;
  Mesh (*mesh)();
  Material material;
  std::optional<int> depth;
};
void PrintTo(const FurnaceCase& c, std::ostream* out) { *out << c.name; }

class WhiteFurnace : public testing::TestWithParam<FurnaceCase> {};

// Under a sky of radiance 1 from everywhere nothing that neither absorbs nor emits can be seen. Each sample's weight is
// a product of w / p with w = p up to rounding, at most some 10 factors.
TEST_P(WhiteFurnace, ShapesThatAbsorbNothing_AreInvisible) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(1.0f)));
  add(scene, GetParam().mesh(), GetParam().material);
  addCamera(scene, "camera", {1.0f, 2.0f, 3.0f}, {0, 0, 0}, glm::radians(40.0f), 0.1f);
  const auto snapshot = finish(std::move(scene));
  const Image image = ReferenceScene(snapshot)
                          .render(snapshot->camera, 48, 48, {.samplesPerAxis = 2, .spp = 4, .depth = GetParam().depth})
                          .mean();
  for (const glm::vec3& pixel : image) EXPECT_LT(largestDifference(pixel, glm::dvec3(1.0)), 3e-6);
}

Mesh sphere() { return makeSphereMesh(1.0f, 64, 32); }
Mesh box() { return makeBoxMesh(glm::vec3(1.2f)); }
Mesh torus() { return makeTorusMesh(0.8f, 0.35f, 64, 32); }  // concave: reflects itself

// Paths inside of glass may be long, so that roulette would add noise: they are cut to a depth.
INSTANTIATE_TEST_SUITE_P(Shapes, WhiteFurnace,
                         testing::Values(FurnaceCase{"mirror sphere", sphere, makeMirrorMaterial("m"), {}},
                                         FurnaceCase{"mirror box", box, makeMirrorMaterial("m"), {}},
                                         FurnaceCase{"mirror torus", torus, makeMirrorMaterial("m"), {}},
                                         FurnaceCase{"glass sphere", sphere, makeGlass(1.5f), 10},
                                         FurnaceCase{"glass box", box, makeGlass(1.5f), 10},
                                         FurnaceCase{"glass torus", torus, makeGlass(1.33f), 10}));

// A mirror that absorbs must be darker than the furnace: the test above could else be met by hitting nothing.
TEST(WhiteFurnace, AbsorbingMirror_IsVisible) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(1.0f)));
  add(scene, makeSquareMesh({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, 1.0f), makeMirrorMaterial("mirror", glm::vec3(0.25f)));
  EXPECT_EQ(radianceAlong(finish(std::move(scene)), {0, 0, 0}, {0, 0, -1}), glm::vec3(0.25f));
}

// A slab of thickness t shifts a ray that meets it at angle a sideways by t sin a (1 - cos a / sqrt(n^2 - sin^2 a)); in
// the slab's plane that is 1 / cos a as much. The edge of an emitter behind the slab is searched by bisection.
TEST(GlassSlab, ShiftsRaysByTheClosedForm) {
  constexpr double kThickness = 0.5, kAngle = 0.7, kIor = 1.5;
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  add(scene, makeBoxMesh({40.0f, 40.0f, static_cast<float>(kThickness)}), makeGlass(static_cast<float>(kIor)));
  // Emits for x < 0 in the plane z = -2.
  add(scene, makeSquareMesh({-20, 0, -2}, {1, 0, 0}, {0, 1, 0}, 20.0f), makeEmitter(glm::vec3(1.0f)));
  const ReferenceScene reference(finish(std::move(scene)));
  const auto seesEmitter = [&](double x) {
    const glm::vec3 origin(x, 0.1f, 2.0f), direction(std::sin(kAngle), 0.0f, -std::cos(kAngle));
    return medianOf(samplesAlong(reference, origin, direction, {}, 31)) > 0.5;
  };
  double inside = -8.0, outside = 2.0;
  ASSERT_TRUE(seesEmitter(inside));
  ASSERT_FALSE(seesEmitter(outside));
  while (outside - inside > 1e-5) {
    const double middle = 0.5 * (inside + outside);
    (seesEmitter(middle) ? inside : outside) = middle;
  }
  const double straight = -4.0 * std::tan(kAngle);  // where the ray through air would start
  const double sine = std::sin(kAngle), cosine = std::cos(kAngle);
  const double shift = kThickness * sine * (1.0 - cosine / std::sqrt(kIor * kIor - sine * sine)) / cosine;
  EXPECT_NEAR(inside - straight, shift, 5e-5);  // the shift is 0.214: the slab acts
}

// A ray that meets a ball at height h of its radius is turned by 2 (asin h - asin(h / n)) towards the axis: it leaves
// upwards where it came in below the axis. The sky tells the direction.
TEST(GlassBall, TurnsRaysByTheClosedForm) {
  constexpr double kIor = 1.5;
  Scene scene = makeSceneUnder(makeLinearSky());
  add(scene, makeSphereMesh(1.0f, 512, 256), makeGlass(static_cast<float>(kIor)));
  const ReferenceScene reference(finish(std::move(scene)));
  for (const double height : {0.1, 0.3, 0.5, 0.7}) {
    const double turned = 2.0 * (std::asin(height) - std::asin(height / kIor));
    const glm::vec3 origin(0.01f, -height, 3.0f);
    const double radiance = medianOf(samplesAlong(reference, origin, {0, 0, -1}, {}, 31));
    // Two refractions at chords of 1/512 turn: (2 pi / 512)^2 = 1.5e-4, in a sky that changes by 1.2.
    EXPECT_NEAR(radiance, linearSky({0.0, std::sin(turned), -std::cos(turned)}).x, 2e-4) << height;
  }
}

// Fresnel's equations at normal incidence reflect ((n - 1) / (n + 1))^2.
TEST(Glass, ReflectsAndRefractsInFresnelsProportion) {
  constexpr double kIor = 1.5, kReflectance = 0.04;
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  add(scene, makeSquareMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f), makeGlass(static_cast<float>(kIor)));
  add(scene, makeSquareMesh({0, 0, 2}, {-1, 0, 0}, {0, 1, 0}, 1.0f), makeEmitter(glm::vec3(1.0f)));
  const ReferenceScene reference(finish(std::move(scene)));
  const Statistics s = statisticsOf(samplesAlong(reference, {0, 0, 1}, {0, 0, -1}, {}, 20000));
  EXPECT_NEAR(s.mean, kReflectance, kSigmas * s.standardError);
  EXPECT_LT(s.standardError, 0.05 * kReflectance);
}

// Rays that leave a large mirror meet neither their own triangle nor the one beside it, at any angle: of a mirror that
// reflects 1/2 a second hit would show as 1/4.
TEST(LargeMirror, DoubleSided_DoesNotMeetItself) {
  for (const float halfEdge : {1.0f, 30.0f, 1000.0f, 30000.0f}) {
    Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(1.0f)));
    Material mirror = makeMirrorMaterial("mirror", glm::vec3(0.5f));
    mirror.doubleSided = true;
    const glm::vec3 u = glm::normalize(glm::vec3(3, 1, -2)), v = glm::normalize(glm::cross(u, glm::vec3(0, 1, 0.3f)));
    const glm::vec3 normal = glm::cross(u, v);
    add(scene, makeSquareMesh({0.1f, 0.2f, 0.3f}, u, v, halfEdge), mirror);
    const ReferenceScene reference(finish(std::move(scene)));
    int met = 0;
    for (int i = 0; i < 2000; ++i) {
      // Points along the diagonal that the two triangles share and beside it; cosines down to 1e-3.
      const float along = (static_cast<float>(i % 50) / 25.0f - 0.98f) * 0.9f * halfEdge;
      const glm::vec3 target = glm::vec3(0.1f, 0.2f, 0.3f) + along * (u + v) + 1e-4f * static_cast<float>(i % 7) * u;
      const float cosine = std::pow(10.0f, -3.0f * static_cast<float>(i / 50) / 40.0f);
      const glm::vec3 tangent =
          glm::normalize(u * std::cos(0.1f * static_cast<float>(i)) + v * std::sin(0.1f * static_cast<float>(i)));
      const glm::vec3 direction = -cosine * normal + std::sqrt(1.0f - cosine * cosine) * tangent;
      const glm::vec3 radiance = reference.radiance(target - 0.01f * halfEdge * direction, direction, {}, 0);
      const float reflectance = 0.5f + 0.5f * std::pow(1.0f - cosine, 5.0f);
      if (radiance == glm::vec3(1.0f)) continue;  // missed by rounding, at grazing angles
      ++met;
      ASSERT_NEAR(radiance.x, reflectance, 1e-3f) << "edge " << halfEdge << " cosine " << cosine;
    }
    EXPECT_GT(met, 1990) << "edge " << halfEdge;
  }
}

}  // namespace
}  // namespace pb
