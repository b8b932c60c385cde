#include "raster/texel_rect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <vector>

namespace pb {
namespace {

// The corners of what is left of the box beyond the near plane, in clip space.
std::vector<glm::vec4> visibleCorners(const Bounds& box, const shading::View& view) {
  std::array<glm::vec4, 8> corners;
  for (unsigned i = 0; i < 8; ++i)
    corners[i] = shading::clipFromWorldPosition(
        view, {(i & 1u) != 0 ? box.upper.x : box.lower.x, (i & 2u) != 0 ? box.upper.y : box.lower.y,
               (i & 4u) != 0 ? box.upper.z : box.lower.z});
  const float zNear = view.origin.w;
  std::vector<glm::vec4> visible;
  for (unsigned i = 0; i < 8; ++i) {
    const glm::vec4& from = corners[i];
    if (from.w > zNear) visible.push_back(from);
    for (const unsigned axis : {1u, 2u, 4u}) {
      const glm::vec4& to = corners[i ^ axis];
      if (from.w > zNear && to.w <= zNear) visible.push_back(glm::mix(to, from, (zNear - to.w) / (from.w - to.w)));
    }
  }
  return visible;
}

// One texel more on each side than what floats and the snapping of vertices to 1/256 texel may move. lower, upper: of
// the view's square of edge 2 around the origin.
TexelRect texelsBetween(const glm::vec2& lower, const glm::vec2& upper, int size) {
  const auto texel = [size](float st) {
    return 0.5f * (std::clamp(st, -1.0f, 1.0f) + 1.0f) * static_cast<float>(size);
  };
  const auto first = [&](float st) { return std::max(static_cast<int>(std::floor(texel(st))) - 1, 0); };
  const auto last = [&](float st) { return std::min(static_cast<int>(std::ceil(texel(st))) + 1, size); };
  return {first(lower.x), first(lower.y), last(upper.x), last(upper.y)};
}

struct Range {
  float lower, upper;
};

// Tangents of the angles between the middle of the view and what it sees of a circle: in the plane of `forward` and one
// axis of the picture, with its centre there. Infinite where the circle reaches behind the view.
Range tangentsOf(float along, float forward, float radius) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float distance = std::hypot(along, forward);
  if (distance <= radius) return {-kInfinity, kInfinity};
  const float middle = std::atan2(along, forward), half = std::asin(radius / distance);
  const float quarter = 0.5f * glm::pi<float>();
  return {middle - half > -quarter ? std::tan(middle - half) : -kInfinity,
          middle + half < quarter ? std::tan(middle + half) : kInfinity};
}

}  // namespace

TexelRect joined(const TexelRect& a, const TexelRect& b) {
  if (a.texels() == 0) return b;
  if (b.texels() == 0) return a;
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}

TexelRect common(const TexelRect& a, const TexelRect& b) {
  const TexelRect rect = {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right),
                          std::min(a.bottom, b.bottom)};
  return rect.left < rect.right && rect.top < rect.bottom ? rect : TexelRect{};
}

TexelRect texelsShowing(const Bounds& box, const shading::View& view, int size) {
  const std::vector<glm::vec4> corners = visibleCorners(box, view);
  if (corners.empty()) return {};
  glm::vec2 lower(1.0f), upper(-1.0f);
  for (const glm::vec4& clip : corners) {
    const glm::vec2 st = glm::clamp(glm::vec2(clip) / clip.w, glm::vec2(-1.0f), glm::vec2(1.0f));
    lower = glm::min(lower, st);
    upper = glm::max(upper, st);
  }
  return texelsBetween(lower, upper, size);
}

TexelRect texelsShowing(const Ball& ball, const shading::View& view, int size) {
  const glm::vec3 toCentre = ball.centre - glm::vec3(view.origin);
  const float forward = glm::dot(toCentre, glm::vec3(view.forward));
  if (forward + ball.radius < view.origin.w) return {};
  glm::vec2 lower, upper;
  for (int axis = 0; axis < 2; ++axis) {
    const glm::vec3 edge(axis == 0 ? view.right : view.down);
    const float tangent = glm::length(edge);  // of half the angle of view
    const Range range = tangentsOf(glm::dot(toCentre, edge) / tangent, forward, ball.radius);
    lower[axis] = range.lower / tangent;
    upper[axis] = range.upper / tangent;
  }
  return texelsBetween(lower, upper, size);
}

// No vector becomes longer than by the root of the largest row sum of the squared matrix (Gershgorin).
Ball transformed(const Ball& ball, const glm::mat4& matrix) {
  const glm::mat3 linear(matrix);
  const glm::mat3 squared = glm::transpose(linear) * linear;
  float largest = 0.0f;
  for (int column = 0; column < 3; ++column)
    largest = std::max(largest, glm::dot(glm::abs(squared[column]), glm::vec3(1.0f)));
  return {glm::vec3(matrix * glm::vec4(ball.centre, 1.0f)), ball.radius * std::sqrt(largest)};
}

}  // namespace pb
