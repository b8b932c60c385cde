#version 450 core
// A level convolved with a GGX lobe seen along its axis (N = V = R: Karis, "Real Shading in Unreal Engine 4", 2013) by
// filtered importance sampling (Krivanek and Colbert, "Real-time Shading with Filtered Importance Sampling", 2008).
#include "raster/shaders/prefilter.glsl"

#ifndef LOBE_SAMPLES
#define LOBE_SAMPLES 1
#endif

layout(binding = kFilterSourceUnit) uniform samplerCube source;
// Of equal weight: unit directions around +Z, and the level whose texels cover what each stands for, at a face's centre.
layout(std140, binding = kLobeBlock) uniform LobeBlock { vec4 lobe[LOBE_SAMPLES]; };

void main() {
  ivec3 texel = targetTexel();
  if (isOutside(texel)) return;
  vec3 axis = safeNormalize(cubeDirection(texel.z, texelCentre(texel.xy, float(job.y))));
  // Turns continuously with the axis except at the poles, where no texel's centre lies.
  vec3 tangent = safeNormalize(vec3(axis.z, 0.0f, -axis.x));
  vec3 bitangent = cross(axis, tangent);
  vec3 sum = vec3(0.0f);
  for (int i = 0; i < LOBE_SAMPLES; ++i) {
    vec3 d = lobe[i].x * tangent + lobe[i].y * bitangent + lobe[i].z * axis;
    // A texel's solid angle falls with the third power of the largest component; a level has a quarter of the texels.
    float largest = max(abs(d.x), max(abs(d.y), abs(d.z)));
    sum += vec3(textureLod(source, d, lobe[i].w - 1.5f * log2(largest)));
  }
  storeTexel(texel, sum / float(LOBE_SAMPLES));
}
