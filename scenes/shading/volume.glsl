// Inside of refractive objects: absorption and dispersion.

// Beer-Lambert law: what is left after lengthMetres in a medium of the given absorption coefficients (1/m).
PB_FUNC vec3 transmittance(vec3 absorption, float lengthMetres) {
  return vec3(exp(-absorption.x * lengthMetres), exp(-absorption.y * lengthMetres), exp(-absorption.z * lengthMetres));
}

// Index of refraction of the red, green or blue channel, from that at 587.6 nm and dispersion = 20 / Abbe number: the
// Cauchy formula of KHR_materials_dispersion at the Fraunhofer lines that define the Abbe number, C 656.3 nm (red),
// d 587.6 nm (green) and F 486.1 nm (blue), so that n_F - n_C = (n_d - 1) / Abbe number.
PB_FUNC float channelIor(float ior, float dispersion, int channel) {
  float wavelength = channel == 0 ? 656.3f : (channel == 1 ? 587.6f : 486.1f);
  float slope = (ior - 1.0f) * dispersion / 20.0f;
  return max(ior + slope * (523655.0f / (wavelength * wavelength) - 1.5168f), 1.0f);
}

// Where the viewer's ray leaves a slab whose two sides have the same normal n at the point it meets (unit direction d
// against n), relative to that point: KHR_materials_volume as glTF viewers draw it.
PB_FUNC vec3 slabExitOffset(vec3 d, vec3 n, float relativeIor, float thicknessMetres) {
  vec3 refracted = refractedDirection(d, n, relativeIor);
  return thicknessMetres * refracted;
}
