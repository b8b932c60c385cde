#include "raster/texel_rect.h"

#include <algorithm>
#include <cmath>

namespace pb {

TexelRect joined(const TexelRect& a, const TexelRect& b) {
  if (a.texels() == 0) return b;
  if (b.texels() == 0) return a;
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}

TexelRect texelsShowing(const Bounds& box, const shading::View& view, int size) {
  glm::vec2 lower(1.0f), upper(-1.0f);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p((corner & 1) != 0 ? box.upper.x : box.lower.x, (corner & 2) != 0 ? box.upper.y : box.lower.y,
                      (corner & 4) != 0 ? box.upper.z : box.lower.z);
    const glm::vec4 clip = shading::clipFromWorldPosition(view, p);
    if (clip.w <= view.origin.w) return {0, 0, size, size};
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
