#include "scenes/closed_mesh.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <map>
#include <unordered_map>

namespace pb {
namespace {

// Finds one number for all positions that are as good as equal.
class Welder {
 public:
  explicit Welder(const Bounds& bounds)
      : origin_(bounds.lower), tolerance_(1e-5 * glm::length(glm::dvec3(bounds.extent()))) {}

  std::vector<int> indicesOf(const std::vector<glm::vec3>& positions) {
    std::vector<int> indices;
    indices.reserve(positions.size());
    for (const glm::vec3& p : positions) indices.push_back(indexOf(p));
    return indices;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct CellHash {
    std::size_t operator()(const Cell& c) const {
      // Multipliers of Teschner et al., "Optimized Spatial Hashing for Collision Detection" (2003), section 3.
      return static_cast<std::size_t>(c[0] * 73856093 ^ c[1] * 19349663 ^ c[2] * 83492791);
    }
  };

  int indexOf(const glm::vec3& position) {
    const glm::dvec3 p = position;
    const Cell cell = cellOf(p);
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z)
          for (const int index : inCell({cell[0] + x, cell[1] + y, cell[2] + z}))
            if (glm::distance(positions_[static_cast<std::size_t>(index)], p) <= tolerance_) return index;
    positions_.push_back(p);
    const int index = static_cast<int>(positions_.size()) - 1;
    cells_[cell].push_back(index);
    return index;
  }

  // Cells are as wide as the tolerance, so that neighbours lie in adjacent ones.
  Cell cellOf(const glm::dvec3& p) const {
    const glm::dvec3 cell = glm::floor((p - origin_) / tolerance_);
    return {static_cast<std::int64_t>(cell.x), static_cast<std::int64_t>(cell.y), static_cast<std::int64_t>(cell.z)};
  }

  std::span<const int> inCell(const Cell& cell) const {
    const auto found = cells_.find(cell);
    return found == cells_.end() ? std::span<const int>() : found->second;
  }

  glm::dvec3 origin_;
  double tolerance_;
  std::vector<glm::dvec3> positions_;
  std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

// Six times the volume of the tetrahedron between the triangle and `apex`; summed over a closed mesh that faces
// outwards it is positive.
double signedVolume(const Mesh& mesh, std::size_t triangle, const glm::dvec3& apex) {
  const auto corner = [&](std::size_t k) { return glm::dvec3(mesh.positions[mesh.indices[3 * triangle + k]]) - apex; };
  return glm::dot(corner(0), glm::cross(corner(1), corner(2)));
}

bool isThickGlass(const Scene& scene, const Instance& instance) {
  const shading::MaterialConstants& c = scene.materials[static_cast<std::size_t>(instance.material)].constants;
  return c.kind.x == shading::kSurfaceGlass && c.kind.z > 0.0f;
}

}  // namespace

Boundary boundaryOf(std::span<const Mesh* const> meshes) {
  Bounds bounds;
  for (const Mesh* mesh : meshes) bounds.include(mesh->bounds);
  Welder welder(bounds);
  std::map<std::pair<int, int>, int> surplus;  // by edge: triangles through it upwards less those downwards
  double volume = 0.0;
  for (const Mesh* mesh : meshes) {
    const std::vector<int> welded = welder.indicesOf(mesh->positions);
    for (std::size_t t = 0; t < mesh->triangleCount(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = welded[mesh->indices[3 * t + k]], b = welded[mesh->indices[3 * t + (k + 1) % 3]];
        if (a != b) surplus[std::minmax(a, b)] += a < b ? 1 : -1;
      }
      volume += signedVolume(*mesh, t, glm::dvec3(bounds.centre()));
    }
  }
  if (std::ranges::any_of(surplus, [](const auto& edge) { return edge.second != 0; })) return Boundary::open;
  return volume < 0.0 ? Boundary::insideOut : Boundary::closed;
}

void warnOfOpenGlass(Scene& scene) {
  std::map<int, std::vector<const Mesh*>> glassOfNode;
  for (const Instance& instance : scene.instances)
    if (isThickGlass(scene, instance)) glassOfNode[instance.node].push_back(instance.mesh.get());
  std::map<std::vector<const Mesh*>, Boundary> known;  // many nodes may show one mesh
  for (const auto& [node, meshes] : glassOfNode) {
    const auto [found, isNew] = known.try_emplace(meshes, Boundary::closed);
    if (isNew) found->second = boundaryOf(meshes);
    if (found->second == Boundary::closed) continue;
    scene.warnings.push_back(fmt::format("node '{}': its glass has a thickness, but mesh '{}' {}",
                                         scene.nodes[static_cast<std::size_t>(node)].name, meshes.front()->name,
                                         found->second == Boundary::open
                                             ? "is not closed: light that enters it may never leave it"
                                             : "is inside out: its triangles face the inside"));
  }
}

}  // namespace pb
