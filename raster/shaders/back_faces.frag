#version 450 core
// What lies behind a transmitting object's surface: normal on the viewer's side, so inward, and distance from the viewer.
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/surface_fetch.glsl"

layout(location = 0) out vec4 backFace;

void main() {
  Fragment fragment = makeFragment();
  Surface surface = readSurface(fragment);
#if defined(ALPHA_MASK) || defined(ALPHA_BLEND)
  if (surface.opacity == 0.0f) discard;
#endif
  backFace = vec4(surface.normal, length(vec3(pass.view.origin) - worldPosition));
}
