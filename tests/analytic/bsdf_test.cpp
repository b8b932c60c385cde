// Lobes of the reference renderer: samples against densities, energy against closed forms.
#include "reference/bsdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "scenes/shading/shading.h"
#include "tests/analytic/reference_scenes.h"

namespace pb {
namespace {

using namespace test;

shading::Surface surfaceOf(const Material& material) {
  return shading::makeSurface(material.constants, glm::vec3(0.0f), {0, 0, 1}, glm::vec4(1.0f), glm::vec4(1.0f),
                              glm::vec4(1.0f), glm::vec4(1.0f), glm::vec4(1.0f));
}

Material rough(Material material, float roughness) {
  material.constants.factors.y = roughness;
  return material;
}

Material makeMetal(float roughness) {
  Material m = rough(makeMirrorMaterial("metal", glm::vec3(0.9f, 0.7f, 0.4f)), roughness);
  m.constants.kind.x = shading::kSurfaceGlossy;
  return m;
}

Material makePlastic(float roughness) {
  Material m = rough(makeDiffuseMaterial("plastic", glm::vec3(0.8f, 0.5f, 0.3f)), roughness);
  m.constants.kind.x = shading::kSurfaceGlossy;
  m.constants.specular.w = 1.0f;
  return m;
}

Material makeHalfClear(float roughness) {
  Material m = rough(makeGlass(1.5f), roughness);
  m.constants.factors.w = 0.6f;
  return m;
}

Material makeThin(float roughness) {
  Material m = rough(makeGlass(1.5f), roughness);
  m.constants.kind.z = 0.0f;
  return m;
}

Material makeVeil(float roughness) {
  Material m = makePlastic(roughness);
  m.constants.baseColor.w = 0.4f;
  m.constants.alpha.x = shading::kAlphaBlend;
  return m;
}

struct LobeCase {
  const char* name;
  Material material;
  float relativeIor;
  float NoV;
};
void PrintTo(const LobeCase& c, std::ostream* out) { *out << c.name << " at NoV " << c.NoV; }

class Lobes : public testing::TestWithParam<LobeCase> {
 protected:
  Lobes()
      : surface(surfaceOf(GetParam().material)),
        toViewer(std::sqrt(1.0f - GetParam().NoV * GetParam().NoV), 0.0f, GetParam().NoV),
        bsdf(surface, toViewer, {glm::vec3(GetParam().relativeIor), -1}, DiffuseTransport::traced) {}

  const shading::Surface surface;
  const glm::vec3 toViewer;
  const Bsdf bsdf;
};

glm::vec3 valueOf(const LobeValues& v, Lobe lobe) { return lobe == Lobe::diffuse ? v.diffuse : v.specular; }
float densityOf(const LobeValues& v, Lobe lobe) { return lobe == Lobe::diffuse ? v.diffusePdf : v.specularPdf; }

// The same from two sides: formulas of evaluate() at the direction against what sample() made on its way there. Half
// vectors are rebuilt from directions, which loses digits where the density is high: narrow lobes and refraction by an
// index near 1 lose most.
void expectPairs(const Bsdf& bsdf) {
  int checked = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Sampler sampler(1, 0, i);
    const auto ray = bsdf.sample(sampler);
    if (!ray || ray->lobe == Lobe::straight) continue;
    ++checked;
    const LobeValues values = bsdf.evaluate(ray->direction);
    const float density = densityOf(values, ray->lobe);
    ASSERT_NEAR(density, ray->pdf, 1e-2f * ray->pdf);
    const glm::vec3 weight = valueOf(values, ray->lobe) / density;
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(weight[c], ray->weight[c], 1e-3f * ray->weight[c]);
  }
  EXPECT_GT(checked, 300);
}

TEST_P(Lobes, SamplesWeighTheirValueOverTheirDensity) { expectPairs(bsdf); }

// Turned, so that cosines are not those of the axes: 1 - cos^2 alone would be rounding here.
TEST(NarrowLobes, SamplesWeighTheirValueOverTheirDensity) {
  const glm::vec3 normal = glm::normalize(glm::vec3(0.48f, -0.61f, 0.37f));
  const shading::Frame frame = shading::makeFrame(normal);
  for (const float roughness : {0.033f, 0.05f, 0.2f})
    for (const float NoV : {0.97f, 0.5f, 0.15f}) {
      shading::Surface surface = surfaceOf(makeMetal(roughness));
      surface.normal = normal;
      const glm::vec3 toViewer = shading::toWorld(frame, {std::sqrt(1.0f - NoV * NoV), 0.0f, NoV});
      SCOPED_TRACE(testing::Message() << "roughness " << roughness << ", NoV " << NoV);
      expectPairs(Bsdf(surface, toViewer, {}, DiffuseTransport::traced));
    }
}

// Where mapped normals lean away from the viewer, rough lobes are those of a raised viewer; what is not there stays not
// there.
TEST(Veil, SeenFromBehindItsNormal_LetsLightStraightOn) {
  const shading::Surface surface = surfaceOf(makeVeil(0.7f));
  const glm::vec3 toViewer = glm::normalize(glm::vec3(0.9f, 0.1f, -0.3f));
  const Bsdf bsdf(surface, toViewer, {}, DiffuseTransport::local);
  int straight = 0;
  for (std::uint64_t i = 0; i < 100; ++i) {
    Sampler sampler(4, 0, i);
    const auto ray = bsdf.sample(sampler);
    if (!ray || ray->lobe != Lobe::straight) continue;
    ++straight;
    EXPECT_EQ(ray->direction, -toViewer);
  }
  EXPECT_GT(straight, 20);
}

// Bins of equal solid angle over the sphere: cosine and azimuth.
constexpr int kCosines = 20, kAzimuths = 16;
int binOf(const glm::vec3& d) {
  const double azimuth = std::atan2(static_cast<double>(d.y), static_cast<double>(d.x)) / (2.0 * M_PI) + 0.5;
  const int i = std::clamp(static_cast<int>((static_cast<double>(d.z) + 1.0) / 2.0 * kCosines), 0, kCosines - 1);
  const int j = std::clamp(static_cast<int>(azimuth * kAzimuths), 0, kAzimuths - 1);
  return i * kAzimuths + j;
}

// Integral of the density over a bin by the midpoint rule.
double expectedShare(const Bsdf& bsdf, int bin) {
  constexpr int kSteps = 48;
  const int i = bin / kAzimuths, j = bin % kAzimuths;
  double sum = 0.0;
  for (int a = 0; a < kSteps; ++a)
    for (int b = 0; b < kSteps; ++b) {
      const double z = -1.0 + 2.0 * (i + (a + 0.5) / kSteps) / kCosines;
      const double azimuth = 2.0 * M_PI * ((j + (b + 0.5) / kSteps) / kAzimuths - 0.5);
      const double r = std::sqrt(1.0 - z * z);
      const LobeValues v = bsdf.evaluate(glm::vec3(r * std::cos(azimuth), r * std::sin(azimuth), z));
      sum += static_cast<double>(v.diffusePdf) + static_cast<double>(v.specularPdf);
    }
  return sum / (kSteps * kSteps) * 4.0 * M_PI / (kCosines * kAzimuths);
}

// Wilson and Hilferty (1931): the cube root of chi-square over its degrees of freedom is nearly normal.
double normalScore(double chiSquare, double degrees) {
  const double t = 2.0 / (9.0 * degrees);
  return (std::cbrt(chiSquare / degrees) - (1.0 - t)) / std::sqrt(t);
}

// Pearson's test; bins that expect few samples are pooled. What is missing to 1 are the samples without a direction.
// Two-sided at 4.5 for each of the cases, 7e-6 apiece: with Sidak's correction below 2e-4 for all of them.
TEST_P(Lobes, SampledDirectionsFollowTheDensity) {
  constexpr int kSamples = 40000, kBins = kCosines * kAzimuths;
  std::vector<double> observed(kBins + 1, 0.0), expected(kBins + 1, 0.0);
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    Sampler sampler(2, 0, i);
    const auto ray = bsdf.sample(sampler);
    ++observed[static_cast<std::size_t>(ray && ray->lobe != Lobe::straight ? binOf(ray->direction) : kBins)];
  }
  double total = 0.0;
  for (int b = 0; b < kBins; ++b) total += expected[static_cast<std::size_t>(b)] = kSamples * expectedShare(bsdf, b);
  ASSERT_LT(total, kSamples * 1.002);  // the quadrature's error
  expected.back() = std::max(kSamples - total, 0.0);
  double chiSquare = 0.0, pooledObserved = 0.0, pooledExpected = 0.0;
  int cells = 0;
  for (std::size_t b = 0; b < expected.size(); ++b) {
    if (expected[b] < 20.0) {
      pooledObserved += observed[b];
      pooledExpected += expected[b];
      continue;
    }
    chiSquare += (observed[b] - expected[b]) * (observed[b] - expected[b]) / expected[b];
    ++cells;
  }
  if (pooledExpected >= 20.0) {
    chiSquare += (pooledObserved - pooledExpected) * (pooledObserved - pooledExpected) / pooledExpected;
    ++cells;
  }
  ASSERT_GT(cells, 10);
  EXPECT_LT(std::abs(normalScore(chiSquare, cells - 1)), kSigmas);
}

std::vector<LobeCase> lobeCases() {
  std::vector<LobeCase> cases;
  for (const float NoV : {0.97f, 0.5f, 0.15f}) {
    cases.push_back({"metal 0.5", makeMetal(0.5f), 1.0f, NoV});
    cases.push_back({"metal 1", makeMetal(1.0f), 1.0f, NoV});
    cases.push_back({"plastic", makePlastic(0.5f), 1.0f, NoV});
    cases.push_back({"veil", makeVeil(0.7f), 1.0f, NoV});
    cases.push_back({"glass from outside", rough(makeGlass(1.5f), 0.6f), 1.5f, NoV});
    cases.push_back({"glass from inside", rough(makeGlass(1.5f), 0.6f), 1.0f / 1.5f, NoV});
    cases.push_back({"half clear glass", makeHalfClear(0.6f), 1.5f, NoV});
    cases.push_back({"thin glass", makeThin(0.6f), 1.5f, NoV});
  }
  return cases;
}
INSTANTIATE_TEST_SUITE_P(All, Lobes, testing::ValuesIn(lobeCases()));

Statistics reflected(const Bsdf& bsdf, int count) {
  std::vector<double> weights;
  for (int i = 0; i < count; ++i) {
    Sampler sampler(3, 0, static_cast<std::uint64_t>(i));
    const auto ray = bsdf.sample(sampler);
    weights.push_back(ray ? static_cast<double>(ray->weight.x) : 0.0);
  }
  return statisticsOf(weights);
}

// GGX with alpha = 1 has D = 1 / pi, and seen from above Lambda(V) = 0, G2 = G1(L) = 2 c / (1 + c) with c = NoL. What a
// white metal reflects of uniform light is then the integral of D G1 / (4 NoV) over the hemisphere, that of c / (1 + c)
// from 0 to 1: 1 - ln 2.
TEST(RoughMetal, SeenFromAbove_ReflectsOneMinusLnTwo) {
  Material white = makeMetal(1.0f);
  white.constants.baseColor = glm::vec4(1.0f);
  const shading::Surface surface = surfaceOf(white);
  const Statistics s = reflected(Bsdf(surface, {0, 0, 1}, {}, DiffuseTransport::local), 200000);
  EXPECT_NEAR(s.mean, 1.0 - std::log(2.0), kSigmas * s.standardError);
  EXPECT_LT(s.standardError, 1e-3);
}

// Directional albedo of a white metal in doubles, over half vectors in spherical coordinates: integral of
// D G2 VoH / (NoV NoL) NoL dh, by the midpoint rule.
double directionalAlbedo(double NoV, double alpha) {
  constexpr int kPolar = 2000, kAround = 256;
  const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - c * c) / (c * c)) - 1.0); };
  const glm::dvec3 v(std::sqrt(1.0 - NoV * NoV), 0.0, NoV);
  double sum = 0.0;
  for (int i = 0; i < kPolar; ++i)
    for (int j = 0; j < kAround; ++j) {
      const double theta = 0.5 * M_PI * (i + 0.5) / kPolar, phi = 2.0 * M_PI * (j + 0.5) / kAround;
      const glm::dvec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double VoH = glm::dot(v, h), NoL = 2.0 * VoH * h.z - NoV;
      if (VoH <= 0.0 || NoL <= 0.0) continue;
      const double t = 1.0 + h.z * h.z * (alpha * alpha - 1.0);
      const double D = alpha * alpha / (M_PI * t * t), G2 = 1.0 / (1.0 + lambda(NoV) + lambda(NoL));
      sum += D * G2 * VoH / NoV * std::sin(theta);
    }
  return sum * (0.5 * M_PI / kPolar) * (2.0 * M_PI / kAround);
}

TEST(RoughMetal, ReflectsItsDirectionalAlbedo) {
  for (const float roughness : {0.3f, 0.6f, 0.9f})
    for (const float NoV : {0.9f, 0.5f, 0.2f}) {
      Material white = makeMetal(roughness);
      white.constants.baseColor = glm::vec4(1.0f);
      const shading::Surface surface = surfaceOf(white);
      const glm::vec3 toViewer(std::sqrt(1.0f - NoV * NoV), 0.0f, NoV);
      const Statistics s = reflected(Bsdf(surface, toViewer, {}, DiffuseTransport::local), 40000);
      const double alpha = static_cast<double>(roughness) * static_cast<double>(roughness);
      EXPECT_NEAR(s.mean, directionalAlbedo(static_cast<double>(NoV), alpha), kSigmas * s.standardError + 1e-5)
          << roughness << " " << NoV;
    }
}

Material makeWhitePlastic(float roughness) {
  Material white = makePlastic(roughness);
  white.constants.baseColor = glm::vec4(1.0f);
  return white;
}

// The coat is traced with Fresnel's equations, and takes from its base what Schlick's approximation says: a smooth coat
// over white reflects 1 + F - F_Schlick of uniform light, the shared model's only error of energy.
TEST(SmoothCoatOverWhite, ReflectsEverything_ButForSchlicksError) {
  for (const float NoV : {0.95f, 0.6f, 0.3f, 0.1f}) {
    const shading::Surface surface = surfaceOf(makeWhitePlastic(0.0f));
    const glm::vec3 toViewer(std::sqrt(1.0f - NoV * NoV), 0.0f, NoV);
    const Statistics s = reflected(Bsdf(surface, toViewer, {}, DiffuseTransport::traced), 20000);
    const float excess = shading::F_Dielectric(NoV, 1.5f) - shading::F_Schlick(glm::vec3(0.04f), NoV).x;
    EXPECT_NEAR(s.mean, 1.0 + static_cast<double>(excess), kSigmas * s.standardError + 1e-5) << NoV;
    EXPECT_LT(std::abs(excess), 0.04f);
  }
}

// Rough coats average Schlick's error (below 0.04 at an index of 1.5) over the angles of their microfacets.
TEST(RoughCoatOverWhite, ReflectsEverything_ButForSchlicksError) {
  for (const float roughness : {0.3f, 0.7f, 1.0f})
    for (const float NoV : {0.95f, 0.6f, 0.3f, 0.1f}) {
      const shading::Surface surface = surfaceOf(makeWhitePlastic(roughness));
      const glm::vec3 toViewer(std::sqrt(1.0f - NoV * NoV), 0.0f, NoV);
      const Statistics s = reflected(Bsdf(surface, toViewer, {}, DiffuseTransport::traced), 20000);
      EXPECT_NEAR(s.mean, 1.0, kSigmas * s.standardError + 0.04) << roughness << " " << NoV;
    }
}

// Rough glass loses what would meet the surface twice, and never gains.
TEST(RoughGlass, NeverSendsOnMoreThanArrives) {
  for (const float relativeIor : {1.5f, 1.0f / 1.5f, 1.1f, 2.4f})
    for (const float roughness : {0.1f, 0.5f, 1.0f})
      for (const float NoV : {0.95f, 0.5f, 0.1f}) {
        const shading::Surface surface = surfaceOf(rough(makeGlass(1.5f), roughness));
        const glm::vec3 toViewer(std::sqrt(1.0f - NoV * NoV), 0.0f, NoV);
        const Bsdf bsdf(surface, toViewer, {glm::vec3(relativeIor), -1}, DiffuseTransport::local);
        const Statistics s = reflected(bsdf, 20000);
        EXPECT_LT(s.mean, 1.0 + kSigmas * s.standardError);
        // Single scattering with independent masking of both sides loses the most, 73 %, where the index is near 1, the
        // surface very rough and the angle grazing.
        EXPECT_GT(s.mean, roughness < 0.2f ? 0.97 : 0.25) << relativeIor << " " << roughness << " " << NoV;
      }
}

// Two media of one index: no interface, however rough.
TEST(RoughGlass, BetweenEqualMedia_IsNotThere) {
  const shading::Surface surface = surfaceOf(rough(makeGlass(1.5f), 0.8f));
  const glm::vec3 toViewer = glm::normalize(glm::vec3(0.6f, 0.2f, 0.5f));
  const Bsdf bsdf(surface, toViewer, {}, DiffuseTransport::local);
  EXPECT_FALSE(bsdf.isSpread());
  Sampler sampler(1, 0, 0);
  const auto ray = bsdf.sample(sampler);
  ASSERT_TRUE(ray);
  EXPECT_LT(glm::distance(ray->direction, -toViewer), 1e-6f);
  EXPECT_EQ(ray->weight, glm::vec3(1.0f));
  EXPECT_FALSE(sampler.used());
}

}  // namespace
}  // namespace pb
