#include "scenes/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "scenes/numbering.h"

namespace pb {
namespace {

constexpr std::uint32_t kNone = ~0U;

struct Triangle {
  std::array<std::uint32_t, 3> corners;                      // welded vertices
  std::array<std::uint32_t, 3> across{kNone, kNone, kNone};  // neighbour at the edge from corner k to corner k + 1
  std::array<std::uint32_t, 3> groups{kNone, kNone, kNone};
  glm::dvec3 tangent{0.0};  // unit vector along which u grows while v stays
  bool hasTextureArea = false;
  bool isMirrored = false;  // its texture coordinates are, seen from the front
};

// Triangles around one welded vertex, connected by edges and of one orientation: they share one frame.
struct Group {
  std::uint32_t vertex;
  bool isMirrored;
  glm::dvec3 tangent{0.0};
};

// What makes two vertices one: equal position, normal and texture coordinates.
struct WeldKey {
  std::array<float, 8> values;
};

glm::dvec3 normalisedOrZero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : glm::dvec3(0.0);
}

// Unit vector along the projection of v onto the plane across n.
glm::dvec3 projected(const glm::dvec3& v, const glm::dvec3& n) { return normalisedOrZero(v - n * glm::dot(n, v)); }

glm::dvec3 anyTangent(const glm::dvec3& n) {
  return glm::normalize(glm::cross(n, std::abs(n.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
}

std::size_t next(std::size_t corner) { return (corner + 1) % 3; }
std::size_t previous(std::size_t corner) { return (corner + 2) % 3; }

class TangentSpaces {
 public:
  TangentSpaces(const Mesh& mesh, const std::vector<glm::vec2>& uvs) : mesh_(mesh) {
    weld(uvs);
    for (std::size_t t = 0; t < triangles_.size(); ++t) computeFrame(triangles_[t], uvs, t);
    connect();
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (triangles_[t].hasTextureArea)
        for (std::size_t k = 0; k < 3; ++k) addGroup(t, k);
  }

  // Of the triangle's corner.
  glm::vec4 tangentAt(std::size_t triangle, std::size_t corner) const {
    const glm::dvec3 n = mesh_.normals[mesh_.indices[3 * triangle + corner]];
    const std::uint32_t index = triangles_[triangle].groups[corner];
    if (index == kNone) return glm::vec4(glm::vec3(anyTangent(n)), 1.0f);
    const Group& group = groups_[index];
    const glm::dvec3 tangent = normalisedOrZero(group.tangent);
    const bool cancelled = tangent == glm::dvec3(0.0);
    return glm::vec4(glm::vec3(cancelled ? anyTangent(n) : tangent), group.isMirrored ? -1.0f : 1.0f);
  }

 private:
  void weld(const std::vector<glm::vec2>& uvs) {
    Numbering<WeldKey> welded(mesh_.positions.size());
    std::vector<std::uint32_t> firstOf;  // by number: the first vertex that was welded
    const auto representative = [&](std::uint32_t v) {
      const glm::vec3 &p = mesh_.positions[v], &n = mesh_.normals[v];
      WeldKey key{{p.x, p.y, p.z, n.x, n.y, n.z, uvs[v].x, uvs[v].y}};
      for (float& value : key.values) value += 0.0f;  // -0 equals 0
      const std::uint32_t number = welded.numberOf(key);
      if (number == firstOf.size()) firstOf.push_back(v);
      return firstOf[number];
    };
    triangles_.resize(mesh_.triangleCount());
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) triangles_[t].corners[k] = representative(mesh_.indices[3 * t + k]);
  }

  glm::dvec3 positionOf(std::uint32_t vertex) const { return mesh_.positions[vertex]; }

  // Mikkelsen 2008, section 2.3: the derivative of the position by u, for v that grows upwards in the picture.
  void computeFrame(Triangle& triangle, const std::vector<glm::vec2>& uvs, std::size_t t) const {
    const std::uint32_t* i = &mesh_.indices[3 * t];
    const glm::dvec3 e1 = positionOf(i[1]) - positionOf(i[0]);
    const glm::dvec3 e2 = positionOf(i[2]) - positionOf(i[0]);
    const glm::dvec2 d1 = glm::dvec2(uvs[i[1]]) - glm::dvec2(uvs[i[0]]);
    const glm::dvec2 d2 = glm::dvec2(uvs[i[2]]) - glm::dvec2(uvs[i[0]]);
    // Twice the area in texture space; negative for upright pictures, because glTF's v points down.
    const double area = d1.x * d2.y - d1.y * d2.x;
    triangle.hasTextureArea = area != 0.0;
    triangle.isMirrored = area > 0.0;
    triangle.tangent = (area < 0.0 ? -1.0 : 1.0) * normalisedOrZero(e1 * d2.y - e2 * d1.y);
  }

  // Pairs triangles at edges that they run through in opposite directions. Of several at one edge the first in the
  // order of triangles are paired.
  void connect() {
    struct Edge {
      std::uint32_t low, high, triangle, corner;
      auto operator<=>(const Edge&) const = default;
    };
    std::vector<Edge> edges;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(triangles_[t].corners[k], triangles_[t].corners[next(k)]);
        edges.push_back({low, high, t, k});
      }
    std::ranges::sort(edges);
    for (auto a = edges.begin(); a != edges.end(); ++a) {
      if (triangles_[a->triangle].across[a->corner] != kNone) continue;
      const auto isPartner = [&](const Edge& b) {
        return triangles_[b.triangle].across[b.corner] == kNone &&
               triangles_[b.triangle].corners[b.corner] != triangles_[a->triangle].corners[a->corner];
      };
      const auto last =
          std::find_if(a, edges.end(), [&](const Edge& b) { return b.low != a->low || b.high != a->high; });
      const auto b = std::find_if(a + 1, last, isPartner);
      if (b == last) continue;
      triangles_[a->triangle].across[a->corner] = b->triangle;
      triangles_[b->triangle].across[b->corner] = a->triangle;
    }
  }

  // The group that holds the triangle's corner, if none does so far: grown over edges at the corner's vertex.
  void addGroup(std::uint32_t first, std::size_t corner) {
    if (triangles_[first].groups[corner] != kNone) return;
    const auto index = static_cast<std::uint32_t>(groups_.size());
    groups_.push_back({triangles_[first].corners[corner], triangles_[first].isMirrored});
    std::vector<std::uint32_t> pending = {first};
    while (!pending.empty()) {
      const std::uint32_t t = pending.back();
      pending.pop_back();
      if (t == kNone) continue;
      Triangle& triangle = triangles_[t];
      const auto k = static_cast<std::size_t>(std::ranges::find(triangle.corners, groups_[index].vertex) -
                                              triangle.corners.begin());
      if (!canJoin(triangle, k, groups_[index])) continue;
      triangle.groups[k] = index;
      if (triangle.hasTextureArea) groups_[index].tangent += weightedTangent(triangle, k);
      pending.push_back(triangle.across[previous(k)]);
      pending.push_back(triangle.across[k]);
    }
  }

  // Triangles without area in texture space take the orientation of the first group that reaches them.
  static bool canJoin(Triangle& triangle, std::size_t corner, const Group& group) {
    if (triangle.groups[corner] != kNone) return false;
    if (!triangle.hasTextureArea && std::ranges::all_of(triangle.groups, [](auto g) { return g == kNone; }))
      triangle.isMirrored = group.isMirrored;
    return triangle.isMirrored == group.isMirrored;
  }

  // Weighted by the angle at the corner, both in the plane across the vertex normal (Mikkelsen 2008, section 3.3).
  glm::dvec3 weightedTangent(const Triangle& triangle, std::size_t corner) const {
    const glm::dvec3 n = mesh_.normals[triangle.corners[corner]];
    const glm::dvec3 p = positionOf(triangle.corners[corner]);
    const glm::dvec3 a = projected(positionOf(triangle.corners[next(corner)]) - p, n);
    const glm::dvec3 b = projected(positionOf(triangle.corners[previous(corner)]) - p, n);
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) * projected(triangle.tangent, n);
  }

  const Mesh& mesh_;
  std::vector<Triangle> triangles_;
  std::vector<Group> groups_;
};

// A copy of the vertex without tangent; returns its index.
std::uint32_t appendCopy(Mesh& mesh, std::uint32_t vertex) {
  const auto append = [&](auto& values) {
    if (!values.empty()) values.push_back(values[vertex]);
  };
  append(mesh.positions);
  append(mesh.normals);
  append(mesh.uvs[0]);
  append(mesh.uvs[1]);
  append(mesh.colors);
  for (MorphTarget& target : mesh.targets) {
    append(target.positions);
    append(target.normals);
    append(target.tangents);
  }
  append(mesh.joints);
  append(mesh.jointWeights);
  mesh.tangents.emplace_back(0.0f);
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

// Gives corners their tangents; a vertex whose corners differ is split into one for each tangent.
void assignTangents(Mesh& mesh, const std::vector<glm::vec4>& ofCorners) {
  std::vector<std::vector<std::uint32_t>> copies(mesh.positions.size());
  mesh.tangents.assign(mesh.positions.size(), glm::vec4(0.0f));
  for (std::size_t c = 0; c < mesh.indices.size(); ++c) {
    std::vector<std::uint32_t>& candidates = copies[mesh.indices[c]];
    const auto found =
        std::ranges::find_if(candidates, [&](std::uint32_t v) { return mesh.tangents[v] == ofCorners[c]; });
    if (found != candidates.end()) {
      mesh.indices[c] = *found;
      continue;
    }
    const std::uint32_t vertex = candidates.empty() ? mesh.indices[c] : appendCopy(mesh, mesh.indices[c]);
    mesh.tangents[vertex] = ofCorners[c];
    candidates.push_back(vertex);
    mesh.indices[c] = vertex;
  }
}

}  // namespace

void computeTangents(Mesh& mesh, int uvSet) {
  const std::vector<glm::vec2>& uvs = mesh.uvs[static_cast<std::size_t>(uvSet)];
  if (uvs.empty()) {
    mesh.tangents.clear();
    for (const glm::vec3& n : mesh.normals) mesh.tangents.emplace_back(glm::vec3(anyTangent(n)), 1.0f);
    return;
  }
  const TangentSpaces spaces(mesh, uvs);
  std::vector<glm::vec4> ofCorners;
  ofCorners.reserve(mesh.indices.size());
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    for (std::size_t k = 0; k < 3; ++k) ofCorners.push_back(spaces.tangentAt(t, k));
  assignTangents(mesh, ofCorners);
}

}  // namespace pb
