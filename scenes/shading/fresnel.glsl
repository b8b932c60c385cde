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

PB_FUNC vec3 reflectedDirection(vec3 d, vec3 n) { return d - 2.0f * dot(d, n) * n; }
