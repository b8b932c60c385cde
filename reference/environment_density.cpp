#include "reference/environment_density.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "scenes/luminance.h"

namespace pb {
namespace {

// Cells along a face's edge at most: 6 * 512^2 of them take 30 MB. The sun is 1/200 of a radian wide, a cell 1/256.
constexpr int kMaxCells = 512;

// Along an edge of a face on which the gradient's glow is to be seen: its density falls by e within sqrt(2 / exponent)
// radians, which ought to be two cells of 2 / n radians.
int cellsFor(const shading::Sky& sky) {
  constexpr int kOfGradient = 32;
  const float exponent = glm::vec3(sky.glow) == glm::vec3(0.0f) ? 0.0f : std::clamp(sky.glow.w, 0.0f, 1e6f);
  const auto wanted = static_cast<unsigned>(std::ceil(4.0f * std::sqrt(0.5f * exponent)));
  return std::clamp(static_cast<int>(std::bit_ceil(std::max(wanted, 1u))), kOfGradient, kMaxCells);
}

// Of one face, with a border of one texel for the bilinear filter. Beyond a corner of the cube the missing texel is the
// mean of the three others (shading/cubemap.glsl).
Plane paddedLuminance(const std::vector<ImageRgba>& faces, int face) {
  const int n = faces.front().width();
  Plane padded(n + 2, n + 2);
  for (int y = -1; y <= n; ++y)
    for (int x = -1; x <= n; ++x) {
      if ((x < 0 || x == n) && (y < 0 || y == n)) continue;
      const shading::ivec3 texel = shading::cubeWrapTexel({x, y}, face, n);
      padded(x + 1, y + 1) = luminance(glm::vec3(faces[static_cast<std::size_t>(texel.z)](texel.x, texel.y)));
    }
  for (const int y : {0, n + 1})
    for (const int x : {0, n + 1}) {
      const int inX = x == 0 ? 1 : n, inY = y == 0 ? 1 : n;
      padded(x, y) = (padded(inX, inY) + padded(x, inY) + padded(inX, y)) / 3.0f;
    }
  return padded;
}

// Mean over a texel of the bilinearly filtered picture: the integral of the tent over the texel is 3/4 for the texel
// itself and 1/8 for its neighbour on either side.
double filteredMean(const Plane& padded, int x, int y) {
  constexpr double kTent[3] = {0.125, 0.75, 0.125};
  double sum = 0.0;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) sum += kTent[i] * kTent[j] * static_cast<double>(padded(x + i, y + j));
  return sum;
}

}  // namespace

EnvironmentDensity::EnvironmentDensity(const Environment& environment) {
  const bool isCubeMap = environment.sky.toGlow.w > 0.5f;
  texels_ = isCubeMap ? environment.faces.front().width() : cellsFor(environment.sky);
  texelsPerCell_ = (texels_ + kMaxCells - 1) / kMaxCells;
  cells_ = (texels_ + texelsPerCell_ - 1) / texelsPerCell_;
  const std::vector<Light> light = isCubeMap ? lightOfCubeMap(environment.faces) : lightOfGradient(environment.sky);
  double flux = 0.0, sphere = 0.0;
  for (const Light& cell : light) {
    flux += cell.flux;
    sphere += cell.solidAngle;
  }
  for (const Light& cell : light) weights_.push_back(std::max(cell.flux - flux / sphere * cell.solidAngle, 0.0));
  totalWeight_ = std::accumulate(weights_.begin(), weights_.end(), 0.0);
  constexpr double kSmallestShare = 0.01;
  if (totalWeight_ >= kSmallestShare * flux) return;
  weights_.assign(weights_.size(), 0.0);
  totalWeight_ = 0.0;
}

std::vector<EnvironmentDensity::Light> EnvironmentDensity::lightOfCubeMap(const std::vector<ImageRgba>& faces) const {
  std::vector<Light> light(std::size_t{6} * static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_));
  const double texelArea = 4.0 / (static_cast<double>(texels_) * static_cast<double>(texels_));
  for (int face = 0; face < 6; ++face) {
    const Plane padded = paddedLuminance(faces, face);
    for (int y = 0; y < texels_; ++y)
      for (int x = 0; x < texels_; ++x) {
        const glm::vec2 st = (2.0f * glm::vec2(x, y) + 1.0f) / static_cast<float>(texels_) - 1.0f;
        const int cell = (face * cells_ + y / texelsPerCell_) * cells_ + x / texelsPerCell_;
        const double solidAngle = texelArea * static_cast<double>(shading::cubeSolidAngleDensity(st));
        light[static_cast<std::size_t>(cell)].flux += filteredMean(padded, x, y) * solidAngle;
        light[static_cast<std::size_t>(cell)].solidAngle += solidAngle;
      }
  }
  return light;
}

std::vector<EnvironmentDensity::Light> EnvironmentDensity::lightOfGradient(const shading::Sky& sky) const {
  constexpr int kPoints = 4;  // each way
  const int n = cells_ * kPoints;
  const double area = 4.0 / (static_cast<double>(n) * static_cast<double>(n));
  std::vector<Light> light(std::size_t{6} * static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_));
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const glm::vec2 st = (2.0f * glm::vec2(x, y) + 1.0f) / static_cast<float>(n) - 1.0f;
        const double solidAngle = area * static_cast<double>(shading::cubeSolidAngleDensity(st));
        Light& cell = light[static_cast<std::size_t>((face * cells_ + y / kPoints) * cells_ + x / kPoints)];
        const glm::vec3 d = glm::normalize(shading::cubeDirection(face, st));
        cell.flux += static_cast<double>(luminance(shading::gradientSky(sky, d))) * solidAngle;
        cell.solidAngle += solidAngle;
      }
  return light;
}

float EnvironmentDensity::edge(int i) const {
  return 2.0f * static_cast<float>(std::min(i * texelsPerCell_, texels_)) / static_cast<float>(texels_) - 1.0f;
}

float EnvironmentDensity::perSteradian(int x, int y, const glm::vec2& st) const {
  const float area = (edge(x + 1) - edge(x)) * (edge(y + 1) - edge(y));
  return 1.0f / (area * shading::cubeSolidAngleDensity(st));
}

EnvironmentDensity::Point EnvironmentDensity::pointIn(std::size_t cell, const glm::vec2& u) const {
  const int index = static_cast<int>(cell);
  const int x = index % cells_, y = index / cells_ % cells_, face = index / (cells_ * cells_);
  const glm::vec2 st(glm::mix(edge(x), edge(x + 1), u.x), glm::mix(edge(y), edge(y + 1), u.y));
  return {glm::normalize(shading::cubeDirection(face, st)), perSteradian(x, y, st)};
}

EnvironmentDensity::Cell EnvironmentDensity::cellOf(const glm::vec3& direction) const {
  const int face = shading::cubeFaceOf(direction);
  const glm::vec2 st = shading::cubeFaceCoordinates(face, direction);
  const auto cellAt = [&](float c) {
    const auto texel = static_cast<int>(0.5f * (c + 1.0f) * static_cast<float>(texels_));
    return std::clamp(texel, 0, texels_ - 1) / texelsPerCell_;
  };
  const int x = cellAt(st.x), y = cellAt(st.y);
  return {static_cast<std::size_t>((face * cells_ + y) * cells_ + x), perSteradian(x, y, st)};
}

}  // namespace pb
