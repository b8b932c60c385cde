#version 450 core
// Level 0 of some layers into the same ones of another format.
#include "raster/shaders/prefilter.glsl"

layout(binding = kFilterSourceUnit) uniform sampler2DArray source;

void main() {
  ivec3 texel = targetTexel();
  if (isOutside(texel)) return;
  storeTexel(texel, vec3(texelFetch(source, texel, 0)));
}
