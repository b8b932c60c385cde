// The table of directional albedos against a quadrature of its own: other variables, other code, doubles.
#include "scenes/dfg_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pb {
namespace {

struct Albedo {
  double x, y;
};

// G1 of Smith's masking for GGX (Walter et al. 2007, eq. 34), Lambda = (1 / G1) - 1.
double lambdaOf(double cosine, double alpha) {
  const double tan2 = (1.0 - cosine * cosine) / (cosine * cosine);
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}

double schlickMasking(double cosine, double alpha) {
  const double k = alpha / 2.0;
  return cosine / (cosine * (1.0 - k) + k);
}

double maskingOf(float term, double NoL, double NoV, double NoH, double VoH, double alpha) {
  if (term == shading::kGeometryOne) return 1.0;
  if (term == shading::kGeometrySmithK) return schlickMasking(NoL, alpha) * schlickMasking(NoV, alpha);
  if (term == shading::kGeometryCookTorrance) return std::min({1.0, 2.0 * NoH * NoV / VoH, 2.0 * NoH * NoL / VoH});
  return 1.0 / (1.0 + lambdaOf(NoL, alpha) + lambdaOf(NoV, alpha));
}

// Over all microfacet normals, not only the visible ones: equal shares of D(h) NoH, whose cumulative distribution in
// cos^2 theta inverts to (1 - u) / (1 + (alpha^2 - 1) u) (Walter et al. 2007, eq. 35). The integrand BRDF NoL over the
// density of the reflected direction, D NoH / (4 VoH), is G VoH / (NoV NoH).
Albedo quadrature(double NoV, double alpha, float term) {
  constexpr int kAround = 128;
  constexpr int kAcross = 2048;
  const double sinV = std::sqrt(1.0 - NoV * NoV);
  Albedo sum{0.0, 0.0};
  for (int j = 0; j < kAcross; ++j) {
    // Finer towards u = 1, where grazing views see the steepest facets: u = 1 - (1 - t)^2 with density 2 (1 - t).
    const double t = (j + 0.5) / kAcross;
    const double u = 1.0 - (1.0 - t) * (1.0 - t);
    const double NoH = std::sqrt((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u));
    const double sinH = std::sqrt(1.0 - NoH * NoH);
    for (int i = 0; i < kAround; ++i) {
      const double phi = 3.14159265358979 * (i + 0.5) / kAround;  // the other half is its mirror image
      const double VoH = sinV * sinH * std::cos(phi) + NoV * NoH;
      const double NoL = 2.0 * VoH * NoH - NoV;
      if (VoH <= 0.0 || NoL <= 0.0) continue;
      const double weight = 2.0 * (1.0 - t) * maskingOf(term, NoL, NoV, NoH, VoH, alpha) * VoH / (NoV * NoH);
      const double rise = std::pow(1.0 - VoH, 5.0);
      sum.x += weight * (1.0 - rise);
      sum.y += weight * rise;
    }
  }
  return {sum.x / (double{kAround} * kAcross), sum.y / (double{kAround} * kAcross)};
}

constexpr float kTerms[] = {shading::kGeometrySmithCorrelated, shading::kGeometryOne, shading::kGeometrySmithK,
                            shading::kGeometryCookTorrance};

// Largest differences to the quadrature as measured, rounded up; the quadrature's own error is below 1e-4.
// Relative where the albedo is above 1 (without masking). Grazing: NoV below 0.05.
struct Accuracy {
  float term;
  double facing, grazing;
};

TEST(DfgTable, TexelsMatchAnIndependentQuadrature) {
  const auto coordinate = [](int i) { return std::max(static_cast<float>(i) / (kDfgTableSize - 1), 1e-3f); };
  for (const Accuracy& accuracy :
       {Accuracy{shading::kGeometrySmithCorrelated, 7e-4, 1e-3}, Accuracy{shading::kGeometryOne, 1.2e-2, 5e-3},
        Accuracy{shading::kGeometrySmithK, 5e-4, 5e-4}, Accuracy{shading::kGeometryCookTorrance, 5e-3, 5e-2}}) {
    for (int y = 0; y < kDfgTableSize; y += 9)
      for (int x = 0; x < kDfgTableSize; x += x < 4 ? 1 : 7) {
        const float NoV = coordinate(x);
        const float roughness = coordinate(y);
        const float alpha = std::max(roughness * roughness, shading::kSmoothAlpha);
        const Albedo expected = quadrature(double{NoV}, double{alpha}, accuracy.term);
        const glm::vec4 texel = dfgTable(accuracy.term).levels.front()(x, y);
        const double scale = std::max(1.0, expected.x + expected.y);
        const double tolerance = (NoV < 0.05f ? accuracy.grazing : accuracy.facing) * scale;
        EXPECT_NEAR(texel.x, expected.x, tolerance) << accuracy.term << " NoV " << NoV << " roughness " << roughness;
        EXPECT_NEAR(texel.y, expected.y, tolerance) << accuracy.term << " NoV " << NoV << " roughness " << roughness;
      }
  }
}

// One microfacet normal is left: masking goes to 1 and Fresnel's cosine to NoV, whatever the term.
TEST(DfgTable, SmoothLobesReflectAsMirrors) {
  for (const float term : kTerms)
    for (const float NoV : {0.2f, 0.5f, 0.9f, 1.0f}) {
      const glm::vec2 dfg = computeDfg(NoV, shading::kSmoothAlpha, term);
      const float rise = std::pow(1.0f - NoV, 5.0f);
      // Slopes of the facets, of the order of alpha, change the cosine by alpha times the tangent.
      const float tolerance = 1e-3f + 5.0f * shading::kSmoothAlpha / NoV;
      EXPECT_NEAR(dfg.x, 1.0f - rise, tolerance) << "geometry term " << term;
      EXPECT_NEAR(dfg.y, rise, tolerance) << "geometry term " << term;
    }
}

// Masking only removes light: with a physical term no lobe reflects more than it receives.
TEST(DfgTable, PhysicalTermsLoseEnergyAndRougherOnesMore) {
  for (const float term : {shading::kGeometrySmithCorrelated, shading::kGeometrySmithK})
    for (const glm::vec4& texel : dfgTable(term).levels.front()) EXPECT_LE(texel.x + texel.y, 1.0f + 5e-4f);
  const ImageRgba& smith = dfgTable(shading::kGeometrySmithCorrelated).levels.front();
  const int facing = kDfgTableSize - 1;
  for (int y = 1; y < kDfgTableSize; ++y) {
    const glm::vec4 smoother = smith(facing, y - 1);
    EXPECT_LE(smith(facing, y).x + smith(facing, y).y, smoother.x + smoother.y + 1e-4f);
  }
}

}  // namespace
}  // namespace pb
