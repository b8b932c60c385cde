#version 450 core
// The next smaller level: means of 2 x 2 texels, the last row and column of odd sizes left out. SOLID_ANGLES weighs the
// texels by theirs; without it this is what glGenerateMipmap does.
#include "raster/shaders/prefilter.glsl"

layout(binding = kFilterSourceUnit) uniform sampler2DArray source;

void main() {
  ivec3 texel = targetTexel();
  if (isOutside(texel)) return;
  vec3 sum = vec3(0.0f);
  float weights = 0.0f;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      ivec2 p = 2 * texel.xy + ivec2(i, j);
#ifdef SOLID_ANGLES
      float weight = cubeSolidAngleDensity(texelCentre(p, 2.0f * float(job.y)));
#else
      float weight = 1.0f;
#endif
      sum += weight * vec3(texelFetch(source, ivec3(p, texel.z), job.z));
      weights += weight;
    }
  storeTexel(texel, sum / weights);
}
