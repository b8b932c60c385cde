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

// The smallest rectangle that has both in it.
TexelRect joined(const TexelRect& a, const TexelRect& b);

// Has in it all texels of a square view of `size` texels along an edge that show a part of the box.
TexelRect texelsShowing(const Bounds& box, const shading::View& view, int size);

}  // namespace pb
