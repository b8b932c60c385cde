#include "scenes/dfg_table.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

namespace pb {
namespace {

// Visible normals on a midpoint grid. Half the steps change no value of the table by more than 3e-4, except below
// NoV = 0.02 (tests/unit/dfg_table_test.cpp).
constexpr int kStepsAround = 16;
constexpr int kStepsAcross = 32;

float texelCentre(int i) { return (static_cast<float>(i) + 0.5f) / static_cast<float>(kDfgTableSize); }

Texture computeTable(float geometry) {
  ImageRgba texels(kDfgTableSize, kDfgTableSize);
  tbb::parallel_for(0, kDfgTableSize, [&](int y) {
    const float roughness = texelCentre(y);
    const float alpha = std::max(roughness * roughness, shading::kSmoothAlpha);
    for (int x = 0; x < kDfgTableSize; ++x)
      texels(x, y) = glm::vec4(computeDfg(texelCentre(x), alpha, geometry), 0.0f, 0.0f);
  });
  return {"dfg", {texels}};
}

}  // namespace

glm::vec2 computeDfg(float NoV, float alpha, float geometry) {
  const glm::vec3 toViewer(std::sqrt(std::max(1.0f - NoV * NoV, 0.0f)), 0.0f, NoV);
  glm::dvec2 sum(0.0);
  for (int j = 0; j < kStepsAcross; ++j)
    for (int i = 0; i < kStepsAround; ++i) {
      const glm::vec2 u((static_cast<float>(i) + 0.5f) / kStepsAround, (static_cast<float>(j) + 0.5f) / kStepsAcross);
      const glm::vec3 h = shading::sampleVisibleNormal(toViewer, alpha, u);
      const float VoH = glm::dot(toViewer, h);
      const float NoL = 2.0f * VoH * h.z - NoV;
      if (NoL <= 0.0f) continue;
      // BRDF times cosine over the density of the direction, without Fresnel: G / G1 (Heitz 2014, eq. 2 with Walter et
      // al. 2007, eq. 14 and 20).
      const float weight =
          shading::geometryTerm(geometry, NoL, NoV, h.z, VoH, alpha) / shading::G1_SmithGGX(NoV, alpha);
      const float rise = shading::pow5(1.0f - std::min(VoH, 1.0f));
      sum += glm::dvec2(weight * (1.0f - rise), weight * rise);
    }
  return glm::vec2(sum / static_cast<double>(kStepsAround * kStepsAcross));
}

const Texture& dfgTable(float geometry) {
  static std::array<std::once_flag, 4> once;
  static std::array<Texture, 4> tables;
  const auto i = static_cast<std::size_t>(geometry);
  std::call_once(once[i], [&] { tables[i] = computeTable(geometry); });
  return tables[i];
}

}  // namespace pb
