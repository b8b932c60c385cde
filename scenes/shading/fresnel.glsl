// Reflectance of smooth interfaces.

// Schlick, "An Inexpensive BRDF Model for Physically-based Rendering" (1994), eq. 15.
PB_FUNC vec3 F_Schlick(vec3 f0, float cosine) {
  return f0 + (vec3(1.0f) - f0) * pow5(clamp(1.0f - cosine, 0.0f, 1.0f));
}

// Unpolarised Fresnel equations of a dielectric; relativeIor = n_transmitted / n_incident, cosine >= 0 on the incident side.
// 1 beyond the critical angle.
PB_FUNC float F_Dielectric(float cosine, float relativeIor) {
  float c = clamp(cosine, 0.0f, 1.0f);
  float sinTransmittedSquared = (1.0f - c * c) / (relativeIor * relativeIor);
  if (sinTransmittedSquared >= 1.0f) return 1.0f;
  float t = sqrt(1.0f - sinTransmittedSquared);
  float rs = (c - relativeIor * t) / (c + relativeIor * t);
  float rp = (relativeIor * c - t) / (relativeIor * c + t);
  return 0.5f * (rs * rs + rp * rp);
}

// Refracted unit direction of the unit vector d at normal n (against d); zero beyond the critical angle.
PB_FUNC vec3 refractedDirection(vec3 d, vec3 n, float relativeIor) {
  float eta = 1.0f / relativeIor;
  float c = -dot(d, n);
  float k = 1.0f - eta * eta * (1.0f - c * c);
  return k < 0.0f ? vec3(0.0f) : eta * d + (eta * c - sqrt(k)) * n;
}

// Unpolarised Fresnel equations of a conductor in air or vacuum; index of refraction eta + i k.
// Born and Wolf, "Principles of Optics", 7th ed., section 14.2, in the real form with a^2 + b^2.
PB_FUNC float F_ConductorChannel(float cosine, float eta, float k) {
  float c = clamp(cosine, 0.0f, 1.0f);
  if (c == 0.0f) return 1.0f;  // also where nothing reflects otherwise, eta = 1 and k = 0: 0 / 0
  float c2 = c * c;
  float s2 = 1.0f - c2;
  float t = eta * eta - k * k - s2;
  float sum = sqrt(t * t + 4.0f * eta * eta * k * k);  // a^2 + b^2
  float a = sqrt(max(0.5f * (sum + t), 0.0f));
  float b2 = max(0.5f * (sum - t), 0.0f);
  // Sums of squares can't become negative where nothing reflects.
  float rs = ((a - c) * (a - c) + b2) / ((a + c) * (a + c) + b2);
  float rp = rs * ((a * c - s2) * (a * c - s2) + b2 * c2) / ((a * c + s2) * (a * c + s2) + b2 * c2);
  return 0.5f * (rs + rp);
}

PB_FUNC vec3 F_Conductor(float cosine, vec3 eta, vec3 k) {
  return vec3(F_ConductorChannel(cosine, eta.x, k.x), F_ConductorChannel(cosine, eta.y, k.y),
              F_ConductorChannel(cosine, eta.z, k.z));
}

// The plain ratio of course documents: max(0, min(1, bias + scale (1 - cosine)^power)).
PB_FUNC float F_Ratio(float cosine, float bias, float scale, float power) {
  float x = clamp(1.0f - cosine, 0.0f, 1.0f);
  // Guarded because pow(0, 0) is undefined in GLSL.
  float lobe = x > 0.0f ? pow(x, power) : 0.0f;
  return clamp(bias + scale * lobe, 0.0f, 1.0f);
}

// Which law a renderer uses, as vec4(law, bias, scale, power); the last three are read by kFresnelRatio only.
const float kFresnelExact = 0.0f;
const float kFresnelSchlick = 1.0f;
const float kFresnelRatio = 2.0f;

// Reflectance at normal incidence of a dielectric.
PB_FUNC float dielectricF0(float ior) {
  float r = (ior - 1.0f) / (ior + 1.0f);
  return r * r;
}

// Reflectance of a smooth dielectric by the given law. Schlick's takes the cosine on the thinner side, and is 1 beyond the
// critical angle.
PB_FUNC float dielectricReflectance(vec4 law, float cosine, float relativeIor) {
  if (law.x == kFresnelRatio) return F_Ratio(cosine, law.y, law.z, law.w);
  if (law.x == kFresnelExact) return F_Dielectric(cosine, relativeIor);
  float c = clamp(cosine, 0.0f, 1.0f);
  if (relativeIor < 1.0f) {
    float sinTransmittedSquared = (1.0f - c * c) / (relativeIor * relativeIor);
    if (sinTransmittedSquared >= 1.0f) return 1.0f;
    c = sqrt(1.0f - sinTransmittedSquared);
  }
  float f0 = dielectricF0(relativeIor);
  return f0 + (1.0f - f0) * pow5(1.0f - c);
}

PB_FUNC vec3 reflectedDirection(vec3 d, vec3 n) { return d - 2.0f * dot(d, n) * n; }
