#version 450 core
// Depth alone. Holes of masks throw no shadow, and blended surfaces do where they cover at least half.
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/surface_fetch.glsl"

void main() {
#if defined(ALPHA_MASK) || defined(ALPHA_BLEND)
  Fragment fragment;
  fragment.toViewer = vec3(0.0f);
  fragment.normal = vec3(0.0f);
  fragment.cosine = 1.0f;
  fragment.coneWidth = 0.0f;  // rays to lights have no width: level 0
  if (readSurface(fragment).opacity < 0.5f) discard;
#endif
}
