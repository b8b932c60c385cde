// What a pass draws to.
#pragma once

#include "raster/gl/context.h"

namespace pb {

struct RenderTarget {
  GLuint framebuffer;
  int widthPx;
  int heightPx;
};

}  // namespace pb
