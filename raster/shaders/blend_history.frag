#version 450 core
// What a face of a cube map showed before, for the blend with what was captured now.
#define PB_FUNC
#include "raster/shaders/blocks.glsl"

layout(binding = kFilterSourceUnit) uniform sampler2DArray earlier;
layout(location = 0) uniform int layer;

layout(location = 0) out vec4 color;

void main() { color = texelFetch(earlier, ivec3(gl_FragCoord.xy, layer), 0); }
