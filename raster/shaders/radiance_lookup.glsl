// Radiance that arrives at a point from a direction: of the surface's cube map if PROBE_LOOKUP, else of the environment.
//
// Variants by defines: ROUGH_LOBE for materials whose lobe is wider than a mirror's, with SMOOTH_TEXELS if not everywhere;
// one of FILTER_GGX (number of levels above level 0) and FILTER_BOX (texels along an edge of level 0) if the cube map is
// filtered, none for the technique filter = none; MIPS if smooth lobes read its levels, too, with
// MIPS_GGX if they are those of FILTER_GGX; MAP_OCTAHEDRAL or
// MAP_PARABOLOIDS if maps are no cubes, SINGLE_VIEW if they are one picture; BLENDED_PROBES for surfaces between two probes,
// and those of lookup_direction.glsl.
#include "raster/shaders/gloss_lod.glsl"

#if defined(ROUGH_LOBE) && (defined(FILTER_GGX) || defined(FILTER_BOX))
#define FILTERED_LOOKUP
#endif

#ifdef PROBE_LOOKUP
#if defined(SINGLE_VIEW)
#define PROBE_SAMPLER sampler2D
#elif defined(MAP_OCTAHEDRAL) || defined(MAP_PARABOLOIDS)
#include "scenes/shading/probe_map.glsl"
#define PROBE_SAMPLER sampler2DArray
#else
#define PROBE_SAMPLER samplerCube
#endif
layout(binding = kProbeUnit) uniform PROBE_SAMPLER probe;
#ifdef BLENDED_PROBES
layout(binding = kSecondProbeUnit) uniform PROBE_SAMPLER secondProbe;
#endif
#include "raster/shaders/lookup_direction.glsl"

#if defined(SINGLE_VIEW)
vec3 texelAlong(sampler2D map, vec3 st, float lod) { return vec3(textureLod(map, vec2(st), lod)); }
#elif defined(MAP_OCTAHEDRAL)
vec3 texelAlong(sampler2DArray map, vec3 d, float lod) {
  vec2 at = borderedTextureCoordinates(octahedralCoordinates(d), textureSize(map, 0).x);
  return vec3(textureLod(map, vec3(at, 0.0f), lod));
}
#elif defined(MAP_PARABOLOIDS)
vec3 texelAlong(sampler2DArray map, vec3 d, float lod) {
  vec2 at = borderedTextureCoordinates(paraboloidCoordinates(safeNormalize(d)), textureSize(map, 0).x);
  return vec3(textureLod(map, vec3(at, d.y < 0.0f ? 1.0f : 0.0f), lod));
}
#else
#ifdef RECORDS_LOOKUP
// The fragment's only lookup.
struct LookedUp {
  vec3 weight;
  float lod;
  vec3 direction;
  float alpha;
  float cosine;  // to the viewer, of the surface
};
LookedUp lookedUp = LookedUp(vec3(0.0f), 0.0f, vec3(0.0f), 0.0f, 0.0f);
#endif

vec3 texelAlong(samplerCube map, vec3 d, float lod) {
  vec4 texel = textureLod(map, d, lod);
#ifdef RECORDS_LOOKUP
  lookedUp.direction = d;
  lookedUp.lod = lod;
  lookedUp.alpha = texel.w;
#endif
  return vec3(texel);
}
#endif

vec3 radianceOfLevel(vec3 from, vec3 d, float lod) {
  vec3 radiance = texelAlong(probe, FIRST_DIRECTION(from, d), lod);
#ifdef BLENDED_PROBES
  radiance = mix(radiance, texelAlong(secondProbe, SECOND_DIRECTION(from, d), lod), instance.volume.y);
#endif
  return radiance;
}
#ifdef MIPS
#include "raster/shaders/footprint_lod.glsl"
vec3 radianceAlong(vec3 from, vec3 d) {
  vec3 first = FIRST_DIRECTION(from, d);
  vec3 radiance = texelAlong(probe, first, footprintLod(probe, first));
#ifdef BLENDED_PROBES
  vec3 second = SECOND_DIRECTION(from, d);
  radiance = mix(radiance, texelAlong(secondProbe, second, footprintLod(secondProbe, second)), instance.volume.y);
#endif
  return radiance;
}
#else
vec3 radianceAlong(vec3 from, vec3 d) { return radianceOfLevel(from, d, 0.0f); }
#endif
#else
#include "raster/shaders/environment_lookup.glsl"
vec3 radianceAlong(vec3 from, vec3 d) { return environmentAlong(d); }
#ifdef FILTERED_LOOKUP
layout(binding = kEnvironmentLevelsUnit) uniform samplerCube environmentLevels;
vec3 radianceOfLevel(vec3 from, vec3 d, float lod) { return vec3(textureLod(environmentLevels, d, lod)); }
#endif
#endif

#ifdef FILTERED_LOOKUP
float lobeLod(float alpha) {
#ifdef FILTER_BOX
  return boxLod(alpha, FILTER_BOX);
#else
  return ggxLod(sqrt(alpha), FILTER_GGX);
#endif
}
#endif

// Mean radiance that arrives at a point over a lobe of that alpha around d, as the technique's filter has it; smooth
// lobes see one direction.
vec3 lobeRadiance(vec3 from, vec3 d, float alpha) {
#ifdef FILTERED_LOOKUP
#ifdef SMOOTH_TEXELS
#ifdef MIPS
  vec3 smoothRadiance = radianceAlong(from, d);  // derivatives are undefined where fragments part
  if (alpha == 0.0f) return smoothRadiance;
#else
  if (alpha == 0.0f) return radianceAlong(from, d);
#endif
#endif
  return radianceOfLevel(from, d, lobeLod(alpha));
#else
  return radianceAlong(from, d);
#endif
}

// GGX alpha of a lobe around the reflected direction that is as wide as the transmitted one. A microfacet tilted by a
// small angle turns what it reflects by 2 angles, and what passes both interfaces of a volume (ior - 1) angles at each,
// independently. A thin wall's lobe is the reflected one mirrored (KHR_materials_transmission).
float transmittedAlpha(float alpha, float ior, bool thinWalled) {
  return thinWalled ? alpha : min(0.70710678f * abs(ior - 1.0f) * alpha, 1.0f);
}
