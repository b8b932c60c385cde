// The technique's law of Fresnel: FRESNEL_LAW, a vec4(kFresnel*, bias, scale, power).

#ifndef FRESNEL_LAW
#define FRESNEL_LAW vec4(kFresnelExact, 0.0f, 0.0f, 0.0f)
#endif

// A ratio mixes what is reflected with what is refracted. Metals refract nothing: they keep their own law, or else even a
// perfect mirror would be dark from the front.
vec4 fresnelLawOf(Surface s) {
  vec4 law = FRESNEL_LAW;
  return law.x == kFresnelRatio && s.metallic > 0.5f ? vec4(kFresnelExact, 0.0f, 0.0f, 0.0f) : law;
}
