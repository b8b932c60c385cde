#version 450 core
// Level 0 of a cube of the environment: means of SUBTEXELS x SUBTEXELS directions a texel.
#include "raster/shaders/prefilter.glsl"
#include "raster/shaders/environment_lookup.glsl"

#ifndef SUBTEXELS
#define SUBTEXELS 1
#endif

void main() {
  ivec3 texel = targetTexel();
  if (isOutside(texel)) return;
  vec3 sum = vec3(0.0f);
  for (int j = 0; j < SUBTEXELS; ++j)
    for (int i = 0; i < SUBTEXELS; ++i) {
      ivec2 p = SUBTEXELS * texel.xy + ivec2(i, j);
      vec2 st = texelCentre(p, float(SUBTEXELS * job.y));
      sum += environmentAlong(safeNormalize(cubeDirection(texel.z, st)));
    }
  storeTexel(texel, sum / float(SUBTEXELS * SUBTEXELS));
}
