#include "scenes/polygon.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numeric>

namespace pb {
namespace {

// Twice the area times the normal (Newell).
glm::dvec3 areaVector(std::span<const glm::vec3> corners) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += glm::cross(glm::dvec3(corners[i] - corners[0]), glm::dvec3(corners[i + 1] - corners[0]));
  return sum;
}

// Seen along the axis that the normal is nearest to, so that the polygon runs counter-clockwise.
std::vector<glm::dvec2> projected(std::span<const glm::vec3> corners, const glm::dvec3& normal) {
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (normal[axis] < 0.0) std::swap(u, v);
  std::vector<glm::dvec2> points;
  for (const glm::vec3& p : corners) points.emplace_back(p[u], p[v]);
  return points;
}

// Twice the signed area of the triangle.
double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Corners that stand where one of the triangle's stands (polygons with a bridge to a hole have them) are outside.
bool holds(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& p) {
  return p != a && p != b && p != c && area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
}

// Whether the corner at `i` of the remaining ones can be cut off.
bool isEar(const std::vector<glm::dvec2>& points, const std::vector<std::uint32_t>& remaining, std::size_t i) {
  const std::size_t n = remaining.size();
  const glm::dvec2 &a = points[remaining[(i + n - 1) % n]], &b = points[remaining[i]],
                   &c = points[remaining[(i + 1) % n]];
  return area(a, b, c) > 0.0 &&
         std::ranges::none_of(remaining, [&](std::uint32_t other) { return holds(a, b, c, points[other]); });
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const glm::vec3> corners) {
  const glm::dvec3 normal = areaVector(corners);
  if (!(glm::dot(normal, normal) > 0.0)) return {};
  const std::vector<glm::dvec2> points = projected(corners, normal);
  std::vector<std::uint32_t> remaining(corners.size());
  std::iota(remaining.begin(), remaining.end(), 0U);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // The search goes on where the last ear was: starting anew would make a fan of slivers.
  for (std::size_t at = 0, tried = 0; remaining.size() > 3;) {
    const std::size_t n = remaining.size();
    at %= n;
    // Without any ear, corners are collinear or edges cross: the next best is cut.
    if (tried < n && !isEar(points, remaining, at)) {
      ++at, ++tried;
      continue;
    }
    triangles.push_back({remaining[(at + n - 1) % n], remaining[at], remaining[(at + 1) % n]});
    remaining.erase(remaining.begin() + static_cast<std::ptrdiff_t>(at));
    ++at, tried = 0;
  }
  triangles.push_back({remaining[0], remaining[1], remaining[2]});
  return triangles;
}

}  // namespace pb
