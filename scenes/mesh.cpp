#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <numeric>
#include <unordered_map>

#include "scenes/error.h"
#include "scenes/scene.h"
#include "scenes/tangents.h"

namespace pb {
namespace {

bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void checkInput(const Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  if (mesh.indices.size() % 3 != 0)
    throwInputError("mesh '{}' wants three indices a triangle, got {} indices", mesh.name, mesh.indices.size());
  for (std::size_t i = 0; i < count; ++i)
    if (!isFinite(mesh.positions[i]))
      throwInputError("mesh '{}' has a vertex position that is not finite: vertex {}", mesh.name, i);
  for (const std::uint32_t index : mesh.indices)
    if (index >= count)
      throwInputError("mesh '{}' has an index out of range: {} of {} vertices", mesh.name, index, count);
  const auto wantSize = [&](std::size_t size, const char* what) {
    if (size != 0 && size != count)
      throwInputError("mesh '{}' has {} {} for {} vertices", mesh.name, size, what, count);
  };
  wantSize(mesh.normals.size(), "normals");
  wantSize(mesh.tangents.size(), "tangents");
  wantSize(mesh.uvs[0].size(), "texture coordinates");
  wantSize(mesh.uvs[1].size(), "second texture coordinates");
  wantSize(mesh.colors.size(), "colours");
}

// Twice the area as a vector along the face normal, in double precision: float products of tiny triangles underflow.
glm::dvec3 areaVector(const Mesh& mesh, std::size_t triangle) {
  const glm::dvec3 a = mesh.positions[mesh.indices[3 * triangle]];
  const glm::dvec3 b = mesh.positions[mesh.indices[3 * triangle + 1]];
  const glm::dvec3 c = mesh.positions[mesh.indices[3 * triangle + 2]];
  return glm::cross(b - a, c - a);
}

void dropTrianglesWithoutArea(Mesh& mesh) {
  std::vector<std::uint32_t> kept;
  kept.reserve(mesh.indices.size());
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    if (glm::length(areaVector(mesh, t)) > 0.0)
      kept.insert(kept.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * t),
                  mesh.indices.begin() + static_cast<std::ptrdiff_t>(3 * t + 3));
  mesh.indices = std::move(kept);
}

// Gives every triangle vertices of its own.
void splitVertices(Mesh& mesh) {
  const auto gather = [&](auto& values) {
    if (values.empty()) return;
    std::remove_reference_t<decltype(values)> split;
    split.reserve(mesh.indices.size());
    for (const std::uint32_t index : mesh.indices) split.push_back(values[index]);
    values = std::move(split);
  };
  gather(mesh.positions);
  gather(mesh.tangents);
  gather(mesh.uvs[0]);
  gather(mesh.uvs[1]);
  gather(mesh.colors);
  std::iota(mesh.indices.begin(), mesh.indices.end(), 0U);
}

void computeFlatNormals(Mesh& mesh) {
  splitVertices(mesh);
  mesh.normals.resize(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const glm::vec3 normal = glm::vec3(glm::normalize(areaVector(mesh, t)));
    std::fill_n(mesh.normals.begin() + static_cast<std::ptrdiff_t>(3 * t), 3, normal);
  }
}

void normaliseNormals(Mesh& mesh) {
  for (glm::vec3& n : mesh.normals) {
    if (!isFinite(n)) throwInputError("mesh '{}' has a normal that is not finite", mesh.name);
    // Dividing what is unit already would change its last bits, and a saved scene would load with other normals.
    if (std::abs(glm::dot(n, n) - 1.0f) > 1e-6f) n = shading::safeNormalize(n);
  }
}

void computeUvPerMetre(Mesh& mesh) {
  mesh.uvPerMetre.assign(mesh.positions.size(), 0.0f);
  const std::vector<glm::vec2>& uv = mesh.uvs[0].empty() ? mesh.uvs[1] : mesh.uvs[0];
  if (uv.empty()) return;
  std::vector<int> adjacent(mesh.positions.size(), 0);
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const std::uint32_t* i = &mesh.indices[3 * t];
    const glm::dvec2 d1 = uv[i[1]] - uv[i[0]];
    const glm::dvec2 d2 = uv[i[2]] - uv[i[0]];
    const double density = std::sqrt(std::abs(d1.x * d2.y - d2.x * d1.y) / glm::length(areaVector(mesh, t)));
    for (int k = 0; k < 3; ++k) {
      mesh.uvPerMetre[i[k]] += static_cast<float>(density);
      ++adjacent[i[k]];
    }
  }
  for (std::size_t v = 0; v < adjacent.size(); ++v)
    if (adjacent[v] > 0) mesh.uvPerMetre[v] /= static_cast<float>(adjacent[v]);
}

struct Corner {
  glm::vec3 position;
  glm::vec3 normal;
  friend bool operator==(const Corner&, const Corner&) = default;
};
struct CornerHash {
  std::size_t operator()(const Corner& c) const { return XXH3_64bits(&c, sizeof c); }
};
static_assert(sizeof(Corner) == 6 * sizeof(float));

// Triangles are joined where they share a position with the same normal, by union-find over those corners.
void computeSmoothingGroups(Mesh& mesh) {
  std::unordered_map<Corner, std::uint32_t, CornerHash> corners;
  std::vector<std::uint32_t> parent;
  std::vector<std::uint32_t> cornerOfVertex(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto [found, isNew] =
        corners.try_emplace(Corner{mesh.positions[v], mesh.normals[v]}, static_cast<std::uint32_t>(parent.size()));
    if (isNew) parent.push_back(found->second);
    cornerOfVertex[v] = found->second;
  }
  const auto root = [&](std::uint32_t c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    for (std::size_t k = 1; k < 3; ++k)
      parent[root(cornerOfVertex[mesh.indices[3 * t + k]])] = root(cornerOfVertex[mesh.indices[3 * t]]);
  std::unordered_map<std::uint32_t, std::uint32_t> groups;
  mesh.smoothingGroups.resize(mesh.triangleCount());
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const std::uint32_t r = root(cornerOfVertex[mesh.indices[3 * t]]);
    mesh.smoothingGroups[t] = groups.try_emplace(r, static_cast<std::uint32_t>(groups.size())).first->second;
  }
}

template <class T>
std::uint64_t hashOf(const std::vector<T>& values, std::uint64_t seed) {
  // The count is hashed too, so that moving values from one array to the next changes the hash.
  const std::uint64_t count = values.size();
  seed = XXH3_64bits_withSeed(&count, sizeof count, seed);
  return XXH3_64bits_withSeed(values.data(), values.size() * sizeof(T), seed);
}

std::uint64_t hashOf(const Mesh& mesh) {
  std::uint64_t h = hashOf(mesh.positions, 1);
  h = hashOf(mesh.normals, h);
  h = hashOf(mesh.tangents, h);
  h = hashOf(mesh.uvs[0], h);
  h = hashOf(mesh.uvs[1], h);
  h = hashOf(mesh.colors, h);
  return hashOf(mesh.indices, h);
}

}  // namespace

std::shared_ptr<const Mesh> finishMesh(Mesh mesh, bool needsTangents, int tangentUvSet) {
  checkInput(mesh);
  dropTrianglesWithoutArea(mesh);
  if (mesh.normals.empty()) computeFlatNormals(mesh);
  normaliseNormals(mesh);
  if (needsTangents && mesh.tangents.empty()) computeTangents(mesh, tangentUvSet);
  computeUvPerMetre(mesh);
  computeSmoothingGroups(mesh);
  for (const std::uint32_t index : mesh.indices) mesh.bounds.include(mesh.positions[index]);
  mesh.contentHash = hashOf(mesh);
  return std::make_shared<const Mesh>(std::move(mesh));
}

}  // namespace pb
