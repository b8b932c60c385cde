#version 450 core
// Radiance of a surface towards the viewer.
//
// Variants by defines, besides those of the included files: SURFACE_KIND (kSurface*), PROBE_LOOKUP for specular
// surfaces that show their probe's cube map instead of the environment, ALPHA_MASK for surfaces with holes, ALPHA_BLEND for
// those that cover partly and are composed later (layers.glsl), LIGHT_COUNT punctual lights, of the kinds LIGHT_KINDS (none:
// read from a storage block), NO_LIGHTS if lights are left out, SHADOWS if they have shadow maps, AMBIENT for ambient light
// that the compiler knows, CONDUCTOR if the metal's index of refraction is known, and AREA_LIGHTS if surfaces emit.
// RECORDS_LOOKUP, of opaque surfaces that look up one texel of one probe's map, writes what they show as rest + weight * radiance, for later
// bounce iterations (lookup_records.glsl); with MIRROR_RECORDS only what such records have.
//
// The colour's alpha says whether a later bounce iteration of the frame may change it: 0 if none does. What is recorded has
// the number of its group, from 1 on.
#define PB_FUNC
#ifndef SURFACE_KIND
#define SURFACE_KIND kSurfaceDiffuse
#endif
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/surface_fetch.glsl"

#if defined(LIGHT_KINDS)
layout(std140, binding = kLightBlock) uniform LightBlock { Light lights[LIGHT_COUNT]; };
const float kLightKinds[] = LIGHT_KINDS;
#elif defined(LIGHT_COUNT)
layout(std430, binding = kManyLightsBlock) readonly buffer LightBlock { Light lights[]; };
#endif
#ifndef AMBIENT
#define AMBIENT scene.ambient
#endif
layout(std430, binding = kAreaLightBlock) readonly buffer AreaLightBlock { AreaLight areaLights[]; };
layout(binding = kDfgUnit) uniform sampler2D dfgTable;

#include "raster/shaders/fresnel_law.glsl"
#ifndef GEOMETRY_TERM
#define GEOMETRY_TERM kGeometrySmithCorrelated
#endif
const float kGeometry = GEOMETRY_TERM;

#ifdef ALPHA_BLEND
#include "raster/shaders/layers.glsl"
layout(early_fragment_tests) in;  // hidden layers must not be stored
#else
layout(location = 0) out vec4 radiance;
#endif
#ifdef RECORDS_LOOKUP
#include "raster/shaders/settled.glsl"
layout(location = 0) uniform vec2 lookupGroup;  // y: how much of the map is settled
#ifdef MIRROR_RECORDS
layout(location = 4) out vec4 directionAndCosine;
#else
layout(location = 1) out vec4 directionAndLod;
layout(location = 2) out vec4 weight;
layout(location = 3) out vec4 rest;
#endif
#endif

#include "raster/shaders/radiance_lookup.glsl"

#ifdef SHADOWS
#include "raster/shaders/shadow_lookup.glsl"
#endif

// Emission, light of the lights and ambient light: the twin of pb::localRadiance() in scenes/snapshot.h.
vec3 localRadianceOf(Surface s, vec3 toViewer, vec2 dfg) {
  vec3 irradiance = vec3(0.0f);
  vec3 highlights = vec3(0.0f);
#ifndef NO_LIGHTS
#ifdef LIGHT_COUNT
#ifdef SHADOWS
  vec3 triangle = triangleNormal();
#endif
  for (int i = 0; i < LIGHT_COUNT; ++i) {
    Light light = lights[i];
#ifdef LIGHT_KINDS
    light.positionKind.w = kLightKinds[i];
#endif
    vec3 fromLight = lightIrradiance(light, s.position);
#ifdef SHADOWS
    fromLight *= lightVisibility(light, s.position, triangle);
#endif
    vec3 toLight = lightDirection(light, s.position);
    float NoL = dot(s.normal, toLight);
    irradiance += max(NoL, 0.0f) * fromLight;
#ifdef ROUGH_LOBE
    highlights += abs(NoL) * fromLight *
                  specularBsdf(s, toViewer, toLight, gl_FrontFacing ? s.ior : 1.0f / s.ior, kFresnelLaw, kGeometry);
#endif
  }
#endif
#ifdef AREA_LIGHTS
  int count = int(pass.lights.x);
  for (int i = 0; i < count; ++i) irradiance += areaLightIrradiance(areaLights[i], s.position, s.normal);
#endif
#endif
  return highlights + localRadiance(s, irradiance, ambientRadiance(AMBIENT, s.normal), coatAlbedo(s, dfg));
}

#include "raster/shaders/refraction.glsl"
#include "raster/shaders/dispersion.glsl"
#include "raster/shaders/specular.glsl"

void main() {
  Fragment fragment = makeFragment();
  Surface s = readSurface(fragment);
#if defined(ALPHA_MASK) || defined(ALPHA_BLEND)
  if (s.opacity == 0.0f) discard;
#endif
  vec2 dfg = vec2(0.0f);
  if (s.kind == kSurfaceGlass || s.kind == kSurfaceGlossy)
    dfg = surfaceDfg(s, dfgTable, max(dot(s.normal, fragment.toViewer), 0.0f));
  vec3 sum = localRadianceOf(s, fragment.toViewer, dfg);
#if defined(RECORDS_LOOKUP) && !defined(MIRROR_RECORDS)
  rest = vec4(sum, 0.0f);
#endif
#ifndef NO_REFLECTION
  if (isSpecular(s)) sum += specularRadiance(s, fragment.toViewer, dfg);
#endif
  sum = min(sum, vec3(pass.image.z));
#ifdef ALPHA_BLEND
  addLayer(sum, s.opacity);
#elif defined(RECORDS_LOOKUP)
  radiance = vec4(sum, lookupGroup.x * unsettledLookup(lookedUp.alpha, lookupGroup.y));
#ifdef MIRROR_RECORDS
  directionAndCosine = vec4(lookedUp.direction, lookedUp.cosine);
#else
  directionAndLod = vec4(lookedUp.direction, lookedUp.lod);
  weight = vec4(lookedUp.weight, 0.0f);
#endif
#elif defined(PROBE_LOOKUP)
  radiance = vec4(sum, 1.0f);
#else
  radiance = vec4(sum, 0.0f);
#endif
}
