#version 450 core
// Radiance of the environment behind everything.
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/environment_lookup.glsl"

layout(location = 0) out vec4 radiance;

void main() {
  vec2 size = vec2(pass.image.x, pass.image.y);
  vec2 st = 2.0f * vec2(gl_FragCoord.x, gl_FragCoord.y) / size - vec2(1.0f);
  vec3 d = safeNormalize(viewDirection(pass.view, st));
  radiance = vec4(min(environmentAlong(d), vec3(pass.image.z)), 0.0f);
}
