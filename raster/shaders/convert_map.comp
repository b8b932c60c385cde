#version 450 core
// A cube map as another map of directions: OCTAHEDRAL, or two paraboloids, the upper half sphere first.
#include "raster/shaders/prefilter.glsl"
#include "scenes/shading/probe_map.glsl"

layout(binding = kFilterSourceUnit) uniform samplerCube source;

void main() {
  ivec3 texel = targetTexel();
  if (isOutside(texel)) return;
  vec2 st = borderedTexelCentre(texel.xy, job.y);
#ifdef OCTAHEDRAL
  vec3 d = octahedralDirection(st);
#else
  vec3 d = paraboloidDirection(st, texel.z == 0 ? 1.0f : -1.0f);
#endif
  storeTexel(texel, vec3(textureLod(source, d, 0.0f)));
}
