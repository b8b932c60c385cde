#include "scenes/mesh_parts.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>

namespace pb {
namespace {

// Disjoint sets of corners, with path halving.
class Sets {
 public:
  explicit Sets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }

  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parent_;
};

struct Part {
  std::vector<std::uint32_t> indices;
  Bounds bounds;
};

std::vector<Part> partsOf(const Mesh& mesh) {
  std::map<std::array<float, 3>, std::size_t> cornerAt;
  std::vector<std::size_t> cornerOf;
  for (const glm::vec3& p : mesh.positions)
    cornerOf.push_back(cornerAt.try_emplace({p.x, p.y, p.z}, cornerAt.size()).first->second);
  Sets sets(cornerAt.size());
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    for (std::size_t k = 1; k < 3; ++k) sets.join(cornerOf[mesh.indices[i + k]], cornerOf[mesh.indices[i]]);
  std::map<std::size_t, std::size_t> partOfRoot;
  std::vector<Part> parts;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const auto [found, isNew] = partOfRoot.try_emplace(sets.root(cornerOf[mesh.indices[i]]), parts.size());
    if (isNew) parts.emplace_back();
    parts[found->second].indices.push_back(mesh.indices[i]);
    parts[found->second].bounds.include(mesh.positions[mesh.indices[i]]);
  }
  return parts;
}

void joinSmallest(std::vector<Part>& parts, std::size_t most) {
  std::ranges::stable_sort(parts, std::greater(), [](const Part& p) { return glm::length(p.bounds.extent()); });
  for (std::size_t i = most; i < parts.size(); ++i) {
    const auto distance = [&](const Part& p) { return glm::distance(p.bounds.centre(), parts[i].bounds.centre()); };
    const auto end = parts.begin() + static_cast<std::ptrdiff_t>(most);
    Part& nearest =
        *std::min_element(parts.begin(), end, [&](const Part& a, const Part& b) { return distance(a) < distance(b); });
    nearest.indices.insert(nearest.indices.end(), parts[i].indices.begin(), parts[i].indices.end());
  }
  if (parts.size() > most) parts.resize(most);
}

template <class T>
void appendIfAny(std::vector<T>& to, const std::vector<T>& from, std::uint32_t vertex) {
  if (!from.empty()) to.push_back(from[vertex]);
}

std::shared_ptr<const Mesh> meshOf(const Mesh& whole, const Part& part, std::size_t number) {
  Mesh mesh;
  mesh.name = whole.name + "/" + std::to_string(number);
  std::map<std::uint32_t, std::uint32_t> newIndex;
  for (const std::uint32_t vertex : part.indices) {
    const auto [found, isNew] = newIndex.try_emplace(vertex, static_cast<std::uint32_t>(newIndex.size()));
    mesh.indices.push_back(found->second);
    if (!isNew) continue;
    mesh.positions.push_back(whole.positions[vertex]);
    appendIfAny(mesh.normals, whole.normals, vertex);
    appendIfAny(mesh.tangents, whole.tangents, vertex);
    for (std::size_t set = 0; set < mesh.uvs.size(); ++set) appendIfAny(mesh.uvs[set], whole.uvs[set], vertex);
    appendIfAny(mesh.colors, whole.colors, vertex);
  }
  return finishMesh(std::move(mesh));
}

}  // namespace

std::vector<std::shared_ptr<const Mesh>> connectedParts(const std::shared_ptr<const Mesh>& mesh, std::size_t most) {
  std::vector<Part> parts = partsOf(*mesh);
  if (parts.size() <= 1 || most <= 1) return {mesh};
  joinSmallest(parts, most);
  std::vector<std::shared_ptr<const Mesh>> meshes;
  for (const Part& part : parts) meshes.push_back(meshOf(*mesh, part, meshes.size()));
  return meshes;
}

}  // namespace pb
