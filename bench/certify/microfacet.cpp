// The shading model's GGX lobe by itself, against integrals that are known and against a second spelling in double
// precision (microfacet_oracle.h).
#include <fmt/format.h>

#include <array>
#include <random>
#include <vector>

#include "bench/certify.h"
#include "bench/certify/common.h"
#include "bench/certify/microfacet_oracle.h"
#include "scenes/dfg_table.h"

namespace pb {
namespace {

constexpr std::array<float, 5> kRoughnesses = {0.1f, 0.3f, 0.5f, 0.8f, 1.0f};
constexpr std::array<float, 4> kCosines = {0.1f, 0.4f, 0.7f, 1.0f};

Check ofModel(std::string name, std::string quantity, double measured, double expected, double tolerance) {
  return {std::move(name), "shading model", std::move(quantity), measured, expected, tolerance};
}

// The integral of D cosine over the hemisphere is 1. Midpoints of a smooth function: the float function's rounding is
// what remains: a few epsilon.
double normalisationError() {
  double largest = 0.0;
  for (const float roughness : {0.033f, 0.1f, 0.3f, 0.5f, 0.8f, 1.0f}) {
    const float alpha = roughness * roughness;
    double sum = 0.0;
    oracle::forEachMicrofacet(static_cast<double>(alpha), 256, [&](double NoH, double, double weight) {
      sum += weight *
             static_cast<double>(shading::D_GGX(static_cast<float>(NoH), static_cast<float>(1.0 - NoH * NoH), alpha)) /
             oracle::ggxDensity(NoH, static_cast<double>(alpha));
    });
    largest = std::max(largest, std::abs(sum - 1.0));
  }
  return largest;
}

// Masked microfacets project to the area that the viewer sees: the integral of G1 max(VoH, 0) D over the hemisphere is
// NoV (Heitz 2014, eq. 14).
double weakFurnaceError() {
  double largest = 0.0;
  for (const float roughness : kRoughnesses)
    for (const float NoV : kCosines) {
      const float alpha = roughness * roughness;
      const double sinV = std::sqrt(1.0 - static_cast<double>(NoV) * static_cast<double>(NoV));
      double sum = 0.0;
      oracle::forEachMicrofacet(static_cast<double>(alpha), 512, [&](double NoH, double phi, double weight) {
        const double VoH = static_cast<double>(NoV) * NoH + sinV * std::sqrt(1.0 - NoH * NoH) * std::cos(phi);
        sum += weight / NoH * std::max(VoH, 0.0);
      });
      sum *= static_cast<double>(shading::G1_SmithGGX(NoV, alpha)) / static_cast<double>(NoV);
      largest = std::max(largest, std::abs(sum - 1.0));
    }
  return largest;
}

// Largest difference of the table, as surfaces read it, from the quadrature.
double tableError() {
  const shading::sampler2D table{&dfgTable(shading::kGeometrySmithCorrelated).levels};
  double largest = 0.0;
  for (const float roughness : kRoughnesses)
    for (const float NoV : kCosines) {
      const glm::vec2 read = shading::sampleDfg(table, NoV, roughness);
      const double alpha = static_cast<double>(roughness) * static_cast<double>(roughness);
      const oracle::Albedo exact = oracle::directionalAlbedo(static_cast<double>(NoV), alpha);
      largest = std::max(
          {largest, std::abs(static_cast<double>(read.x) - exact.x), std::abs(static_cast<double>(read.y) - exact.y)});
    }
  return largest;
}

glm::vec3 randomDirection(std::mt19937& engine) {
  const auto uniform = [&] { return static_cast<float>(engine() >> 8) / 16777216.0f; };
  const float z = 0.05f + 0.95f * uniform();
  const float phi = 6.2831853f * uniform();
  const float s = std::sqrt(1.0f - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

shading::Surface surfaceOf(const Material& material) {
  const glm::vec4 white(1.0f);
  return shading::makeSurface(material.constants, glm::vec3(0.0f), {0.0f, 0.0f, 1.0f}, white, white, white, white,
                              white);
}

// Relative difference of the BRDF from itself with the directions exchanged, for every geometry term.
double reciprocityError() {
  std::mt19937 engine(11);
  double largest = 0.0;
  for (const float roughness : kRoughnesses) {
    const shading::Surface s =
        surfaceOf(makeMetalMaterial("gold", {0.21f, 0.43f, 1.04f}, {3.27f, 2.46f, 1.83f}, roughness));
    for (int i = 0; i < 4000; ++i) {
      const glm::vec3 a = randomDirection(engine), b = randomDirection(engine);
      const auto term = static_cast<float>(i % 4);
      const glm::vec4 law(shading::kFresnelExact, 0.0f, 0.0f, 0.0f);
      const float forth = shading::specularBsdf(s, a, b, s.ior, law, term).x;
      const float back = shading::specularBsdf(s, b, a, s.ior, law, term).x;
      largest = std::max(largest, static_cast<double>(std::abs(forth - back) / std::max(forth, 1e-6f)));
    }
  }
  return largest;
}

// Upper tail of the chi-square distribution: Wilson and Hilferty, "The Distribution of Chi-Square" (1931).
double chiSquareTail(double statistic, int degrees) {
  const double v = 2.0 / (9.0 * degrees);
  const double z = (std::cbrt(statistic / degrees) - (1.0 - v)) / std::sqrt(v);
  return 0.5 * std::erfc(z / std::numbers::sqrt2);
}

// Bins in the microfacet normal's cosine and azimuth; a bin's expected count by midpoints of the density.
class NormalHistogram {
 public:
  static constexpr int kRows = 24, kColumns = 16, kSubsteps = 24;

  void add(const glm::vec3& h) {
    const double phi = std::atan2(static_cast<double>(h.y), static_cast<double>(h.x)) / (2.0 * oracle::kPi) + 0.5;
    const int row = std::min(static_cast<int>(static_cast<double>(h.z) * kRows), kRows - 1);
    const int column = std::min(static_cast<int>(phi * kColumns), kColumns - 1);
    ++counts_[static_cast<std::size_t>(row * kColumns + column)];
    ++samples_;
  }

  // Bins that expect fewer than 10 samples are pooled.
  double tailAgainst(const glm::vec3& toViewer, float alpha) const {
    double statistic = 0.0, pooledExpected = 0.0, pooledCount = 0.0;
    int bins = 0;
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) {
        const double expected = samples_ * probability(row, column, toViewer, alpha);
        const double count = counts_[static_cast<std::size_t>(row * kColumns + column)];
        if (expected < 10.0) {
          pooledExpected += expected;
          pooledCount += count;
          continue;
        }
        statistic += (count - expected) * (count - expected) / expected;
        ++bins;
      }
    if (pooledExpected > 1.0) {
      statistic += (pooledCount - pooledExpected) * (pooledCount - pooledExpected) / pooledExpected;
      ++bins;
    }
    return chiSquareTail(statistic, bins - 1);
  }

 private:
  static double probability(int row, int column, const glm::vec3& toViewer, float alpha) {
    double sum = 0.0;
    for (int i = 0; i < kSubsteps; ++i)
      for (int j = 0; j < kSubsteps; ++j) {
        const double z = (row + (i + 0.5) / kSubsteps) / kRows;
        const double phi = 2.0 * oracle::kPi * ((column + (j + 0.5) / kSubsteps) / kColumns - 0.5);
        const double s = std::sqrt(1.0 - z * z);
        const glm::vec3 h(s * std::cos(phi), s * std::sin(phi), z);
        sum += static_cast<double>(
            shading::pdfVisibleNormal(toViewer.z, h.z, static_cast<float>(s * s), glm::dot(toViewer, h), alpha));
      }
    return sum / (kSubsteps * kSubsteps) * 2.0 * oracle::kPi / (kRows * kColumns);
  }

  std::array<double, static_cast<std::size_t>(kRows* kColumns)> counts_{};
  double samples_ = 0.0;
};

// Visible normals from random numbers follow their density: tail probability of the worst of the cases.
std::vector<Check> samplerChecks() {
  struct Case {
    float roughness, NoV;
  };
  // Rough enough that the density is smooth over a bin.
  constexpr std::array<Case, 4> kCases = {{{0.6f, 0.9f}, {0.6f, 0.3f}, {1.0f, 0.7f}, {0.8f, 0.15f}}};
  constexpr double kSignificance = 0.01;
  // Sidak: of four independent tests at this level one fails by chance with probability 0.01.
  const double level = 1.0 - std::pow(1.0 - kSignificance, 1.0 / kCases.size());
  std::mt19937 engine(5);
  const auto uniform = [&] { return static_cast<float>(engine() >> 8) / 16777216.0f; };
  double smallest = 1.0;
  for (const Case& c : kCases) {
    const float alpha = c.roughness * c.roughness;
    const glm::vec3 toViewer(std::sqrt(1.0f - c.NoV * c.NoV), 0.0f, c.NoV);
    NormalHistogram histogram;
    for (int i = 0; i < 200'000; ++i)
      histogram.add(shading::sampleVisibleNormal(toViewer, alpha, {uniform(), uniform()}));
    smallest = std::min(smallest, histogram.tailAgainst(toViewer, alpha));
  }
  // Passes from the corrected level to 1.
  return {ofModel("GGX sampler", "chi-square tail probability, smallest of 4", smallest, 1.0, 1.0 - level)};
}

}  // namespace

std::vector<Check> certifyMicrofacets(RasterDevice& /*device*/) {
  std::vector<Check> checks = {
      ofModel("GGX normalisation", "largest deviation of the projected area from 1", normalisationError(), 0.0, 2e-4),
      ofModel("GGX weak white furnace", "largest deviation from 1", weakFurnaceError(), 0.0, 2e-4),
      // Linear between 64 texels a side: 1e-3 where the albedo bends most, at NoV = 0.1.
      ofModel("GGX directional albedo", "largest error of the table", tableError(), 0.0, 2e-3),
      ofModel("GGX reciprocity", "largest relative difference", reciprocityError(), 0.0, 1e-4),
  };
  const std::vector<Check> samplers = samplerChecks();
  checks.insert(checks.end(), samplers.begin(), samplers.end());
  return checks;
}

}  // namespace pb
