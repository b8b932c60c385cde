#include "raster/texel_rect.h"

#include <algorithm>
#include <array>
#include <cmath>
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

}  // namespace

TexelRect joined(const TexelRect& a, const TexelRect& b) {
  if (a.texels() == 0) return b;
  if (b.texels() == 0) return a;
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
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
  // One texel more on each side than what floats and the snapping of vertices to 1/256 texel may move.
  const auto texel = [size](float st) { return 0.5f * (st + 1.0f) * static_cast<float>(size); };
  const auto first = [&](float st) { return std::max(static_cast<int>(std::floor(texel(st))) - 1, 0); };
  const auto last = [&](float st) { return std::min(static_cast<int>(std::ceil(texel(st))) + 1, size); };
  return {first(lower.x), first(lower.y), last(upper.x), last(upper.y)};
}

}  // namespace pb
