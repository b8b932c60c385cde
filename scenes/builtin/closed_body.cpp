#include "scenes/builtin/closed_body.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace pb {
namespace {

// Six times the volume: negative if the triangles are seen from inside.
double signedVolume(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                     c = mesh.positions[mesh.indices[i + 2]];
    sum += glm::dot(a, glm::cross(b, c));
  }
  return sum;
}

void addNormals(Mesh& mesh) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t at = mesh.indices[i + k];
      const glm::dvec3 a = glm::dvec3(mesh.positions[mesh.indices[i + (k + 1) % 3]] - mesh.positions[at]);
      const glm::dvec3 b = glm::dvec3(mesh.positions[mesh.indices[i + (k + 2) % 3]] - mesh.positions[at]);
      const glm::dvec3 normal = glm::cross(a, b);
      const double sine = glm::length(normal);
      if (sine > 0.0) sums[at] += std::atan2(sine, glm::dot(a, b)) / sine * normal;
    }
  for (const glm::dvec3& sum : sums) mesh.normals.emplace_back(glm::normalize(sum));
}

}  // namespace

Mesh makeClosedBody(int rings, int columns, const BodyPoint& point) {
  Mesh mesh;
  mesh.positions.emplace_back(point(0.0, 0.0));
  for (int j = 1; j < rings; ++j)
    for (int i = 0; i < columns; ++i)
      mesh.positions.emplace_back(point(static_cast<double>(j) / rings, static_cast<double>(i) / columns));
  mesh.positions.emplace_back(point(1.0, 0.0));
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  const auto at = [&](int j, int i) { return static_cast<std::uint32_t>(1 + (j - 1) * columns + i % columns); };
  for (int i = 0; i < columns; ++i) {
    mesh.indices.insert(mesh.indices.end(), {0, at(1, i), at(1, i + 1)});
    for (int j = 1; j + 1 < rings; ++j)
      mesh.indices.insert(mesh.indices.end(), {at(j, i), at(j + 1, i), at(j + 1, i + 1),  //
                                               at(j, i), at(j + 1, i + 1), at(j, i + 1)});
    mesh.indices.insert(mesh.indices.end(), {last, at(rings - 1, i + 1), at(rings - 1, i)});
  }
  if (signedVolume(mesh) < 0.0)
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  addNormals(mesh);
  return mesh;
}

double signedPower(double x, double exponent) { return std::copysign(std::pow(std::abs(x), exponent), x); }

}  // namespace pb
