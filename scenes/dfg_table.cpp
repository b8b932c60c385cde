#include "scenes/dfg_table.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

namespace pb {
namespace {

// Visible normals on a midpoint grid. The squares of the steps across put more of them into the lobe's tail, which is
// thin but loses most of its light: u = 1 - (1 - w)^2. The lobe is symmetric: half of the circle will do.
// Against a fine quadrature of other variables (tests/unit/dfg_table_test.cpp) Smith's values err by 8e-4 below
// NoV = 0.05 and by 6e-4 elsewhere, between texels by 4e-3 and 1e-3; Cook and Torrance's kinks cost 4e-3, below
// NoV = 0.05 up to 4e-2; without masking values reach 45 and err by 1e-2 of theirs.
constexpr int kStepsAround = 16;
constexpr int kStepsAcross = 64;

// Of the texel, from 0 to 1; a viewer just above the horizon stands for 0.
float coordinate(int i) { return std::max(static_cast<float>(i) / static_cast<float>(kDfgTableSize - 1), 1e-3f); }

Texture computeTable(float geometry) {
  ImageRgba texels(kDfgTableSize, kDfgTableSize);
  tbb::parallel_for(0, kDfgTableSize, [&](int y) {
    const float roughness = coordinate(y);
    const float alpha = std::max(roughness * roughness, shading::kSmoothAlpha);
    for (int x = 0; x < kDfgTableSize; ++x)
      texels(x, y) = glm::vec4(computeDfg(coordinate(x), alpha, geometry), 0.0f, 0.0f);
  });
  return {"dfg", {texels}};
}

}  // namespace

glm::vec2 computeDfg(float NoV, float alpha, float geometry) {
  const glm::vec3 toViewer(std::sqrt(std::max(1.0f - NoV * NoV, 0.0f)), 0.0f, NoV);
  glm::dvec2 sum(0.0);
  for (int j = 0; j < kStepsAcross; ++j) {
    const float left = 1.0f - (static_cast<float>(j) + 0.5f) / kStepsAcross;
    for (int i = 0; i < kStepsAround; ++i) {
      const glm::vec2 u(0.5f * (static_cast<float>(i) + 0.5f) / kStepsAround, 1.0f - left * left);
      const glm::vec3 h = shading::sampleVisibleNormal(toViewer, alpha, u);
      const float VoH = glm::dot(toViewer, h);
      const float NoL = 2.0f * VoH * h.z - NoV;
      if (NoL <= 0.0f) continue;
      // BRDF times cosine over the density of the direction, without Fresnel: G / G1 (Heitz 2014, eq. 2 with Walter et
      // al. 2007, eq. 14 and 20).
      const float weight =
          2.0f * left * shading::geometryTerm(geometry, NoL, NoV, h.z, VoH, alpha) / shading::G1_SmithGGX(NoV, alpha);
      const float rise = shading::pow5(1.0f - std::min(VoH, 1.0f));
      sum += glm::dvec2(weight * (1.0f - rise), weight * rise);
    }
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
