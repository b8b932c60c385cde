// What a specular surface shows of its surroundings.

// Reflectance of a rough lobe to uniform light: the split sum (Karis 2013) with the law's values at normal and at grazing
// incidence. dfg: of surfaceDfg().
vec3 splitSum(Surface s, vec2 dfg) {
  if (s.kind == kSurfaceGlass)
    return vec3(dfg.x * dielectricReflectance(kFresnelLaw, 1.0f, s.ior) +
                dfg.y * dielectricReflectance(kFresnelLaw, 0.0f, s.ior));
  return dfg.x * specularReflectance(s, 1.0f, kFresnelLaw) + dfg.y * specularReflectance(s, 0.0f, kFresnelLaw);
}

// Whether the table holds for the lobe. It has no thin walls, and no interfaces seen from inside.
bool hasSplitSum(Surface s) {
  if (s.alpha == 0.0f) return false;
  return s.kind == kSurfaceGlossy || (s.kind == kSurfaceGlass && !isThinWalled(s) && gl_FrontFacing);
}

#ifdef PLANAR_LOOKUP
layout(binding = kPlanarUnit) uniform sampler2D mirroredView;
#endif

// Of a flat reflector, the mirrored view's sample at the same place: of its plane whatever its normal map, and of one
// direction whatever its roughness.
vec3 reflectedRadiance(Surface s, vec3 toViewer) {
#ifdef PLANAR_LOOKUP
  return vec3(texelFetch(mirroredView, ivec2(gl_FragCoord.xy), 0));
#else
  return lobeRadiance(s.position, reflectedDirection(-toViewer, s.normal), s.alpha);
#endif
}

vec3 specularRadiance(Surface s, vec3 toViewer, vec2 dfg) {
  float relativeIor = gl_FrontFacing ? s.ior : 1.0f / s.ior;
  float cosine = max(dot(s.normal, toViewer), 0.0f);
  SpecularWeights weights = specularWeights(s, cosine, relativeIor, kFresnelLaw);
#ifdef FILTERED_LOOKUP
  if (hasSplitSum(s)) weights.reflection = splitSum(s, dfg);
#endif
  vec3 sum = weights.reflection * reflectedRadiance(s, toViewer);
#ifdef RECORDS_LOOKUP
  lookedUp.weight = weights.reflection;
  lookedUp.cosine = cosine;
#endif
  if (s.kind == kSurfaceGlass) sum += refractedRadiance(s, toViewer, weights.refraction);
  return sum;
}
