// Texels of the probes' maps, by Technique::format.
#pragma once

#include <glad/gl.h>

#include <cstdint>

#include "raster/technique.h"

namespace pb {

struct TexelFormat {
  GLenum shown;     // what lookups read
  GLenum captured;  // what captures are drawn to: the same, unless OpenGL can't draw to that
  std::int64_t shownBytes;
  std::int64_t capturedBytes;
  float largestRadiance;  // that all channels hold
  GLenum image;           // what shaders write texels as: the same, or GL_R32UI for what is no format of images
  const char* defines;    // of shaders that write texels (raster/shaders/store_texel.glsl)

  bool isConverted() const { return shown != captured; }
};

const TexelFormat& texelFormat(ProbeFormat format);

// RGBA32F, of filtered environments: the sun of a photographed sky exceeds halves.
const TexelFormat& floatTexels();

}  // namespace pb
