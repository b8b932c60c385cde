#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <numeric>

#include "scenes/deformation.h"
#include "scenes/error.h"
#include "scenes/numbering.h"
#include "scenes/scene.h"
#include "scenes/tangents.h"

namespace pb {
namespace {

bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void checkDeformation(const Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  for (std::size_t t = 0; t < mesh.targets.size(); ++t) {
    const MorphTarget& target = mesh.targets[t];
    for (const auto* values : {&target.positions, &target.normals, &target.tangents})
      if (values->size() != count && !values->empty())
        throwInputError("mesh '{}' has {} vertices, morph target {} has {}", mesh.name, count, t, values->size());
      else if (!std::ranges::all_of(*values, isFinite))
        throwInputError("mesh '{}' has a morph target with values that are not finite: target {}", mesh.name, t);
  }
  if (mesh.joints.size() != mesh.jointWeights.size() || (!mesh.joints.empty() && mesh.joints.size() != count))
    throwInputError("mesh '{}' has {} vertices, with {} joint indices and {} joint weights", mesh.name, count,
                    mesh.joints.size(), mesh.jointWeights.size());
}

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
  checkDeformation(mesh);
}

// Weights of unused joints stand at joint 0, as glTF wants it.
void normaliseJointWeights(Mesh& mesh) {
  for (std::size_t v = 0; v < mesh.joints.size(); ++v) {
    glm::vec4& weights = mesh.jointWeights[v];
    const float sum = weights.x + weights.y + weights.z + weights.w;
    const bool isValid = std::isfinite(sum) && sum > 1e-6f && glm::all(glm::greaterThanEqual(weights, glm::vec4(0.0f)));
    if (!isValid)
      throwInputError("mesh '{}' wants joint weights of at least 0 that sum to 1, got {} {} {} {} at vertex {}",
                      mesh.name, weights.x, weights.y, weights.z, weights.w, v);
    // Dividing what sums to 1 already would change its last bits.
    if (std::abs(sum - 1.0f) > 1e-6f) weights /= sum;
    for (int k = 0; k < 4; ++k)
      if (weights[k] == 0.0f) mesh.joints[v][k] = 0;
  }
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
  for (MorphTarget& target : mesh.targets) {
    gather(target.positions);
    gather(target.normals);
    gather(target.tangents);
  }
  gather(mesh.joints);
  gather(mesh.jointWeights);
  std::iota(mesh.indices.begin(), mesh.indices.end(), 0U);
}

// Of triangles that share no vertices. Those without area have any normal.
void computeFlatNormals(Mesh& mesh) {
  mesh.normals.resize(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    const glm::dvec3 area = areaVector(mesh, t);
    const double length = glm::length(area);
    const glm::vec3 normal = length > 0.0 ? glm::vec3(area / length) : glm::vec3(0, 1, 0);
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
    const double area = glm::length(areaVector(mesh, t));
    if (area <= 0.0) continue;
    const double density = std::sqrt(std::abs(d1.x * d2.y - d2.x * d1.y) / area);
    for (int k = 0; k < 3; ++k) {
      mesh.uvPerMetre[i[k]] += static_cast<float>(density);
      ++adjacent[i[k]];
    }
  }
  for (std::size_t v = 0; v < adjacent.size(); ++v)
    if (adjacent[v] > 0) mesh.uvPerMetre[v] /= static_cast<float>(adjacent[v]);
}

// Triangles are joined where they share a position with the same normal, by union-find over those corners.
void computeSmoothingGroups(Mesh& mesh) {
  Numbering<std::array<float, 6>> corners(mesh.positions.size());  // position and normal
  std::vector<std::uint32_t> cornerOfVertex(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::vec3 &p = mesh.positions[v], &n = mesh.normals[v];
    cornerOfVertex[v] = corners.numberOf({p.x, p.y, p.z, n.x, n.y, n.z});
  }
  std::vector<std::uint32_t> parent(corners.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    for (std::size_t k = 1; k < 3; ++k)
      parent[root(cornerOfVertex[mesh.indices[3 * t + k]])] = root(cornerOfVertex[mesh.indices[3 * t]]);
  Numbering<std::uint32_t> groups;  // of roots
  mesh.smoothingGroups.resize(mesh.triangleCount());
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    mesh.smoothingGroups[t] = groups.numberOf(root(cornerOfVertex[mesh.indices[3 * t]]));
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
  for (const MorphTarget& target : mesh.targets) {
    h = hashOf(target.positions, h);
    h = hashOf(target.normals, h);
    h = hashOf(target.tangents, h);
  }
  if (!mesh.joints.empty()) h = hashOf(mesh.jointWeights, hashOf(mesh.joints, h));
  return hashOf(mesh.indices, h);
}

std::shared_ptr<const Mesh> withBoundsAndHash(Mesh mesh) {
  mesh.bounds = {};
  for (const std::uint32_t index : mesh.indices) mesh.bounds.include(mesh.positions[index]);
  mesh.contentHash = hashOf(mesh);
  return std::make_shared<const Mesh>(std::move(mesh));
}

}  // namespace

std::shared_ptr<const Mesh> finishMesh(Mesh mesh, bool needsTangents, int tangentUvSet) {
  checkInput(mesh);
  normaliseJointWeights(mesh);
  if (mesh.targets.empty() && mesh.joints.empty()) dropTrianglesWithoutArea(mesh);
  mesh.hasFlatNormals = mesh.normals.empty();
  if (mesh.hasFlatNormals) {
    splitVertices(mesh);
    computeFlatNormals(mesh);
  }
  normaliseNormals(mesh);
  if (needsTangents && mesh.tangents.empty()) computeTangents(mesh, tangentUvSet);
  computeUvPerMetre(mesh);
  computeSmoothingGroups(mesh);
  return withBoundsAndHash(std::move(mesh));
}

std::shared_ptr<const Mesh> finishDeformedMesh(Mesh mesh) {
  for (const glm::vec3& p : mesh.positions)
    for (const float number : {p.x, p.y, p.z})
      if (!(std::abs(number) <= kLargestWorldTransform))
        throwInputError("deformed vertices stand within {:g} m, one of mesh '{}' is at {:g}", kLargestWorldTransform,
                        mesh.name, number);
  mesh.isDeformed = true;
  if (mesh.hasFlatNormals) computeFlatNormals(mesh);
  computeUvPerMetre(mesh);
  return withBoundsAndHash(std::move(mesh));
}

}  // namespace pb
