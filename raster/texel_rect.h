// Parts of a face or an image: pure functions.
#pragma once

#include <cstdint>

#include "scenes/scene.h"
#include "scenes/shading/shading.h"

namespace pb {

struct TexelRect {
  int left = 0, top = 0, right = 0, bottom = 0;  // right and bottom are not inside

  std::int64_t texels() const { return std::int64_t{right - left} * (bottom - top); }
  friend bool operator==(const TexelRect&, const TexelRect&) = default;
};

struct Ball {
  glm::vec3 centre;
  float radius;  // metres
};

// The smallest rectangle that has both in it, and the largest one that both have in them.
TexelRect joined(const TexelRect& a, const TexelRect& b);
TexelRect common(const TexelRect& a, const TexelRect& b);

// Has in it all texels of a square view of `size` texels along an edge that show a part of the box, or of the ball.
TexelRect texelsShowing(const Bounds& box, const shading::View& view, int size);
TexelRect texelsShowing(const Ball& ball, const shading::View& view, int size);

// A ball that holds the transformed one. Exact for matrices that rotate, move and scale alike.
Ball transformed(const Ball& ball, const glm::mat4& matrix);

}  // namespace pb
