#include "scenes/closed_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <utility>

#include "scenes/numbering.h"

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

  int indexOf(const glm::vec3& position) {
    const glm::dvec3 p = position;
    if (const std::optional<int> found = near(p)) return *found;
    const auto index = static_cast<int>(positions_.size());
    const std::uint32_t cell = cells_.numberOf(cellOf(p));
    if (cell == newestIn_.size()) newestIn_.push_back(kNone);
    positions_.push_back(p);
    olderOf_.push_back(std::exchange(newestIn_[cell], index));
    return index;
  }

  // The first position within the tolerance: in the cells that a box of that half width touches.
  std::optional<int> near(const glm::dvec3& p) const {
    const Cell low = cellOf(p - tolerance_), high = cellOf(p + tolerance_);
    std::optional<int> first;
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z)
          if (const std::optional<std::uint32_t> cell = cells_.find({x, y, z}))
            for (int i = newestIn_[*cell]; i != kNone; i = olderOf_[static_cast<std::size_t>(i)])
              if ((!first || i < *first) && glm::distance(positions_[static_cast<std::size_t>(i)], p) <= tolerance_)
                first = i;
    return first;
  }

  // Some times as wide as the tolerance: most boxes of near() lie in one to four cells, which hold few positions.
  Cell cellOf(const glm::dvec3& p) const {
    constexpr double kWidth = 4.0;
    const glm::dvec3 cell = glm::floor((p - origin_) / (kWidth * tolerance_));
    return {static_cast<std::int64_t>(cell.x), static_cast<std::int64_t>(cell.y), static_cast<std::int64_t>(cell.z)};
  }

  static constexpr int kNone = -1;

  glm::dvec3 origin_;
  double tolerance_;
  std::vector<glm::dvec3> positions_;
  std::vector<int> olderOf_;  // by position: the one before it in its cell
  Numbering<Cell> cells_;
  std::vector<int> newestIn_;  // by cell
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
  Numbering<std::array<int, 2>> edges;
  std::vector<int> surplus;  // by edge: triangles through it upwards less those downwards
  double volume = 0.0;
  for (const Mesh* mesh : meshes) {
    const std::vector<int> welded = welder.indicesOf(mesh->positions);
    for (std::size_t t = 0; t < mesh->triangleCount(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = welded[mesh->indices[3 * t + k]], b = welded[mesh->indices[3 * t + (k + 1) % 3]];
        if (a == b) continue;
        const std::uint32_t edge = edges.numberOf({std::min(a, b), std::max(a, b)});
        if (edge == surplus.size()) surplus.push_back(0);
        surplus[edge] += a < b ? 1 : -1;
      }
      volume += signedVolume(*mesh, t, glm::dvec3(bounds.centre()));
    }
  }
  if (std::ranges::any_of(surplus, [](int triangles) { return triangles != 0; })) return Boundary::open;
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
