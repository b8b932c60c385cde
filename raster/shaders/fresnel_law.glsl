// The technique's law of Fresnel: FRESNEL_LAW, a vec4(kFresnel*, bias, scale, power).

#ifndef FRESNEL_LAW
#define FRESNEL_LAW vec4(kFresnelExact, 0.0f, 0.0f, 0.0f)
#endif
const vec4 kFresnelLaw = FRESNEL_LAW;
