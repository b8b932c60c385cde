#include "raster/inward_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace pb {
namespace {

using glm::vec3;

// From a corner towards its triangle's centroid: far enough to leave the neighbours' planes, near enough to be the
// vertex's distance.
constexpr float kCornerInset = 1e-2f;
// Rays start on a triangle: nearer hits, relative to the mesh's extent, are that triangle.
constexpr float kNearestHit = 1e-6f;
constexpr std::size_t kLeafTriangles = 4;

struct Triangle {
  vec3 p, e1, e2;  // a corner, and the two edges from it

  vec3 centroid() const { return p + (e1 + e2) / 3.0f; }
};

struct Ray {
  vec3 origin, direction, inverse;
};

// Distance along the ray to a triangle that it meets from behind. Moeller and Trumbore, "Fast, Minimum Storage
// Ray/Triangle Intersection" (1997).
std::optional<float> hitFromBehind(const Triangle& triangle, const Ray& ray, float nearest) {
  const vec3 p = glm::cross(ray.direction, triangle.e2);
  const float determinant = glm::dot(triangle.e1, p);  // positive when the front is met
  if (!(determinant < 0.0f)) return std::nullopt;
  const vec3 s = ray.origin - triangle.p;
  const float u = glm::dot(s, p) / determinant;
  const vec3 q = glm::cross(s, triangle.e1);
  const float v = glm::dot(ray.direction, q) / determinant;
  const float t = glm::dot(triangle.e2, q) / determinant;
  if (u < 0.0f || v < 0.0f || u + v > 1.0f || t <= nearest) return std::nullopt;
  return t;
}

// Distances between which the ray is inside of the box; exit < enter if it misses it.
struct Span {
  float enter, exit;
};

// Rays parallel to a side have infinities in `inverse`.
Span spanInside(const Bounds& box, const Ray& ray) {
  Span span{0.0f, std::numeric_limits<float>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    const float a = (box.lower[axis] - ray.origin[axis]) * ray.inverse[axis];
    const float b = (box.upper[axis] - ray.origin[axis]) * ray.inverse[axis];
    // NaN where the ray runs along the side's plane: no bound.
    if (std::isnan(a) || std::isnan(b)) continue;
    span.enter = std::max(span.enter, std::min(a, b));
    span.exit = std::min(span.exit, std::max(a, b));
  }
  return span;
}

// Bounding volumes of a mesh's triangles, split at the median of the centroids along the longest axis.
class TriangleTree {
 public:
  explicit TriangleTree(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
    nodes_.reserve(2 * triangles_.size());
    if (!triangles_.empty()) build(0, triangles_.size());
  }

  // Of the first triangle that the ray meets from behind, farther than `nearest`.
  std::optional<float> firstFromBehind(const Ray& ray, float nearest) const {
    std::optional<float> best;
    if (!nodes_.empty()) visit(0, ray, nearest, best);
    return best;
  }

 private:
  struct Node {
    Bounds bounds;
    std::size_t first, count;  // triangles of a leaf, else count is 0
    std::size_t right;         // the left child follows its parent
  };

  std::size_t build(std::size_t first, std::size_t count) {
    const std::size_t node = nodes_.size();
    Bounds bounds, centroids;
    for (const Triangle& t : std::span(triangles_).subspan(first, count)) {
      for (const vec3& p : {t.p, t.p + t.e1, t.p + t.e2}) bounds.include(p);
      centroids.include(t.centroid());
    }
    nodes_.push_back({bounds, first, count, 0});
    if (count <= kLeafTriangles) return node;
    const vec3 extent = centroids.extent();
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
    const auto begin = triangles_.begin() + static_cast<std::ptrdiff_t>(first);
    const std::size_t half = count / 2;
    std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(half), begin + static_cast<std::ptrdiff_t>(count),
                     [axis](const Triangle& a, const Triangle& b) { return a.centroid()[axis] < b.centroid()[axis]; });
    nodes_[node].count = 0;
    build(first, half);
    const std::size_t right = build(first + half, count - half);
    nodes_[node].right = right;
    return node;
  }

  void visit(std::size_t index, const Ray& ray, float nearest, std::optional<float>& best) const {
    const Node& node = nodes_[index];
    const Span span = spanInside(node.bounds, ray);
    if (span.exit < span.enter || (best && *best < span.enter)) return;
    for (const Triangle& triangle : std::span(triangles_).subspan(node.first, node.count))
      if (const std::optional<float> t = hitFromBehind(triangle, ray, nearest)) best = std::min(best.value_or(*t), *t);
    if (node.count > 0) return;
    visit(index + 1, ray, nearest, best);
    visit(node.right, ray, nearest, best);
  }

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

Triangle triangleOf(const Mesh& mesh, std::size_t t) {
  const vec3& p = mesh.positions[mesh.indices[3 * t]];
  return {p, mesh.positions[mesh.indices[3 * t + 1]] - p, mesh.positions[mesh.indices[3 * t + 2]] - p};
}

}  // namespace

std::vector<float> inwardDistances(const Mesh& mesh) {
  std::vector<Triangle> triangles;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) triangles.push_back(triangleOf(mesh, t));
  const TriangleTree tree(triangles);
  const float nearest = kNearestHit * glm::length(mesh.bounds.extent());

  std::vector<float> sums(mesh.positions.size(), 0.0f);
  std::vector<float> corners(mesh.positions.size(), 0.0f);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::uint32_t vertex = mesh.indices[i];
    const vec3 direction = -mesh.normals[vertex];
    const vec3 origin = glm::mix(mesh.positions[vertex], triangles[i / 3].centroid(), kCornerInset);
    const Ray ray{origin, direction, 1.0f / direction};
    const std::optional<float> hit = tree.firstFromBehind(ray, nearest);
    sums[vertex] += hit ? *hit : std::max(spanInside(mesh.bounds, ray).exit, 0.0f);
    corners[vertex] += 1.0f;
  }
  for (std::size_t v = 0; v < sums.size(); ++v) sums[v] /= std::max(corners[v], 1.0f);
  return sums;
}

}  // namespace pb
