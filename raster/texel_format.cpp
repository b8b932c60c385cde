#include "raster/texel_format.h"

#include <array>
#include <limits>

namespace pb {

const TexelFormat& texelFormat(ProbeFormat format) {
  // Largest radiances: OpenGL 4.5 core, sections 2.3.4.2 to 2.3.4.4 (half, 11 and 10 bits), and
  // EXT_texture_shared_exponent.
  static constexpr std::array<TexelFormat, 4> kFormats = {
      {{GL_RGBA16F, GL_RGBA16F, 8, 8, 65504.0f, GL_RGBA16F, ""},
       {GL_R11F_G11F_B10F, GL_R11F_G11F_B10F, 4, 4, 64512.0f, GL_R11F_G11F_B10F, ""},
       {GL_RGB9_E5, GL_RGBA16F, 4, 8, 65408.0f, GL_R32UI, "#define STORE_RGB9_E5\n"},
       {GL_SRGB8_ALPHA8, GL_SRGB8_ALPHA8, 4, 4, 1.0f, GL_R32UI, "#define STORE_SRGB8\n"}}};
  return kFormats[static_cast<std::size_t>(format)];
}

const TexelFormat& floatTexels() {
  static constexpr TexelFormat kFloats = {GL_RGBA32F, GL_RGBA32F, 16, 16, std::numeric_limits<float>::infinity(),
                                          GL_RGBA32F, ""};
  return kFloats;
}

}  // namespace pb
