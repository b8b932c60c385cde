// Radiance that arrives from infinitely far away, and the ambient light that diffuse surfaces get from it.

// A vertical gradient with a glow around one direction; also a constant sky (all three colours alike, no glow).
struct Sky {
  vec4 horizon;  // rgb; w: upper bound of each channel (0: none)
  vec4 zenith;   // rgb
  vec4 below;    // rgb, for directions under the horizon
  vec4 glow;     // rgb; w: exponent
  vec4 toGlow;   // xyz unit vector; w: 1 if the environment is the cube map instead of this gradient
};

// d is a unit vector.
PB_FUNC vec3 gradientSky(Sky sky, vec3 d) {
  vec3 base = d.y >= 0.0f ? mix(vec3(sky.horizon), vec3(sky.zenith), d.y) : vec3(sky.below);
  float c = max(dot(d, vec3(sky.toGlow)), 0.0f);
  // Guarded because pow(0, 0) is undefined in GLSL.
  float lobe = c > 0.0f ? pow(c, sky.glow.w) : 0.0f;
  vec3 radiance = base + lobe * vec3(sky.glow);
  return sky.horizon.w > 0.0f ? min(radiance, vec3(sky.horizon.w)) : radiance;
}

// The environment's radiance in unit direction d. `faces` is read only if the environment is a cube map.
PB_FUNC vec3 environmentRadiance(Sky sky, sampler2DArray faces, vec3 d) {
  if (sky.toGlow.w > 0.5f) return vec3(sampleCube(faces, d));
  return gradientSky(sky, d);
}

// Irradiance divided by pi as a quadratic polynomial of the normal: Ramamoorthi and Hanrahan, "An Efficient Representation
// for Irradiance Environment Maps" (2001), eq. 10-11, with basis constants, cosine lobe and 1/pi folded into the coefficients.
struct Ambient {
  vec4 constant;
  vec4 y;
  vec4 z;
  vec4 x;
  vec4 xy;
  vec4 yz;
  vec4 zz;  // of 3 z^2 - 1
  vec4 xz;
  vec4 xxyy;  // of x^2 - y^2
};

PB_FUNC vec3 ambientRadiance(Ambient a, vec3 n) {
  vec4 sum = a.constant + n.y * a.y + n.z * a.z + n.x * a.x + (n.x * n.y) * a.xy + (n.y * n.z) * a.yz +
             (3.0f * n.z * n.z - 1.0f) * a.zz + (n.x * n.z) * a.xz + (n.x * n.x - n.y * n.y) * a.xxyy;
  return max(vec3(sum), vec3(0.0f));
}
