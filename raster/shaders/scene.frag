#version 450 core
// Radiance of a surface towards the viewer.
//
// Variants by defines, besides those of the included files: SURFACE_KIND (kSurface*), and PROBE_LOOKUP for specular
// surfaces that show their probe's cube map instead of the environment.
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/surface_fetch.glsl"

#ifndef SURFACE_KIND
#define SURFACE_KIND kSurfaceDiffuse
#endif

layout(std430, binding = kLightBlock) readonly buffer LightBlock { Light lights[]; };

layout(location = 0) out vec4 radiance;

#ifdef PROBE_LOOKUP
layout(binding = kProbeUnit) uniform samplerCubeArray probes;
vec3 radianceAlong(vec3 d) { return vec3(textureLod(probes, vec4(d, instance.values.y), 0.0f)); }
#else
#include "raster/shaders/environment_lookup.glsl"
vec3 radianceAlong(vec3 d) { return environmentAlong(d); }
#endif

vec3 irradianceOfLights(Surface s) {
  vec3 sum = vec3(0.0f);
  int count = int(pass.image.w);
  for (int i = 0; i < count; ++i) sum += lightIrradianceOn(lights[i], s.position, s.normal);
  return sum;
}

vec3 specularRadiance(Surface s, vec3 toViewer) {
  float relativeIor = gl_FrontFacing ? s.ior : 1.0f / s.ior;
  SpecularWeights weights = specularWeights(s, max(dot(s.normal, toViewer), 0.0f), relativeIor);
  vec3 sum = weights.reflection * radianceAlong(reflectedDirection(-toViewer, s.normal));
  if (s.kind == kSurfaceGlass) {
    vec3 refracted = refractedDirection(-toViewer, s.normal, relativeIor);
    // Zero beyond the critical angle: no direction to look up.
    if (dot(refracted, refracted) > 0.0f) sum += weights.refraction * radianceAlong(refracted);
  }
  return sum;
}

void main() {
  Fragment fragment = makeFragment();
  Surface s = readSurface(fragment);
  s.kind = SURFACE_KIND;  // what the material says, known to the compiler
  vec3 sum = localRadiance(s, irradianceOfLights(s), ambientRadiance(scene.ambient, s.normal));
  if (s.kind == kSurfaceMirror || s.kind == kSurfaceGlass) sum += specularRadiance(s, fragment.toViewer);
  radiance = vec4(min(sum, vec3(pass.image.z)), 1.0f);
}
