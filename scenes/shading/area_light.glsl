// Diffuse light of emitting triangles, in closed form and without shadows.

struct AreaLight {
  vec4 a;         // xyz corners in world space, counter-clockwise seen from the side that emits; w: 1 if both sides do
  vec4 b;
  vec4 c;
  vec4 radiance;  // rgb, W/(sr m^2)
};

// theta / sin(theta) times the component along n of the cross product of unit vectors theta apart: one edge of Lambert's
// formula, "Photometria" (1760); see Baum, Rushmeier and Winget, "Improving Radiosity Solutions Through the Use of
// Analytically Determined Form-Factors" (1989), eq. 5.
PB_FUNC float edgeIrradiance(vec3 from, vec3 to, vec3 n) {
  vec3 perpendicular = cross(from, to);
  float sine = sqrt(dot(perpendicular, perpendicular));
  float theta = atan(sine, dot(from, to));
  float ratio = sine > 1e-6f ? theta / sine : 1.0f;
  return ratio * dot(perpendicular, n);
}

// Twice the signed form factor times pi of the triangle whose corners lie in directions a, b, c from the point, none of
// them below the horizon of n.
PB_FUNC float triangleSum(vec3 a, vec3 b, vec3 c, vec3 n) {
  vec3 u = safeNormalize(a);
  vec3 v = safeNormalize(b);
  vec3 w = safeNormalize(c);
  return edgeIrradiance(u, v, n) + edgeIrradiance(v, w, n) + edgeIrradiance(w, u, n);
}

// The point of the edge on the horizon; ha and hb are heights over it, of different signs.
PB_FUNC vec3 horizonPoint(vec3 a, vec3 b, float ha, float hb) { return a + (ha / (ha - hb)) * (b - a); }

// a is above, b and c are below.
PB_FUNC float sumOneAbove(vec3 a, vec3 b, vec3 c, float ha, float hb, float hc, vec3 n) {
  return triangleSum(a, horizonPoint(a, b, ha, hb), horizonPoint(a, c, ha, hc), n);
}

// a is below, b and c are above.
PB_FUNC float sumOneBelow(vec3 a, vec3 b, vec3 c, float ha, float hb, float hc, vec3 n) {
  vec3 ab = horizonPoint(a, b, ha, hb);
  vec3 ca = horizonPoint(c, a, hc, ha);
  return triangleSum(ab, b, c, n) + triangleSum(ab, c, ca, n);
}

// Whether the point lies in the triangle's plane, but for rounding: 1e-5 of its distances is a hundred times that, and
// light from so flat an angle is nothing. Without this the light's own points would see it cover all of their sky or
// nothing of it, as rounding has it.
PB_FUNC bool isInPlane(vec3 a, vec3 b, vec3 c) {
  vec3 normal = cross(b - a, c - a);
  float height = dot(a, normal);
  return height * height <= 1e-10f * dot(normal, normal) * (dot(a, a) + dot(b, b) + dot(c, c));
}

// Irradiance at p with unit normal n, W/m^2, unoccluded.
PB_FUNC vec3 areaLightIrradiance(AreaLight light, vec3 p, vec3 n) {
  vec3 a = vec3(light.a) - p;
  vec3 b = vec3(light.b) - p;
  vec3 c = vec3(light.c) - p;
  if (isInPlane(a, b, c)) return vec3(0.0f);
  float ha = dot(a, n);
  float hb = dot(b, n);
  float hc = dot(c, n);
  int above = (ha > 0.0f ? 1 : 0) + (hb > 0.0f ? 2 : 0) + (hc > 0.0f ? 4 : 0);
  float sum = 0.0f;
  if (above == 7) sum = triangleSum(a, b, c, n);
  if (above == 1) sum = sumOneAbove(a, b, c, ha, hb, hc, n);
  if (above == 2) sum = sumOneAbove(b, c, a, hb, hc, ha, n);
  if (above == 4) sum = sumOneAbove(c, a, b, hc, ha, hb, n);
  if (above == 6) sum = sumOneBelow(a, b, c, ha, hb, hc, n);
  if (above == 5) sum = sumOneBelow(b, c, a, hb, hc, ha, n);
  if (above == 3) sum = sumOneBelow(c, a, b, hc, ha, hb, n);
  // Seen from the side that emits, corners run against the edges' orientation around n.
  float facing = light.a.w > 0.5f ? abs(sum) : max(-sum, 0.0f);
  return 0.5f * facing * vec3(light.radiance);
}
