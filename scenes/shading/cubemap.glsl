// The one definition of cube-map orientation: used by capture, oracle probes, environments, sampling and tests.
//
// Faces 0..5 are +X -X +Y -Y +Z -Z. s runs along the texels of a row, t along the rows in memory order, both in [-1,1]
// at the face's edges: the layout of OpenGL 4.5 core, table 8.19 (left-handed seen from inside).

// Unit vector through the face's centre.
PB_FUNC vec3 cubeFaceForward(int face) {
  float side = (face % 2 == 0) ? 1.0f : -1.0f;
  if (face < 2) return vec3(side, 0.0f, 0.0f);
  if (face < 4) return vec3(0.0f, side, 0.0f);
  return vec3(0.0f, 0.0f, side);
}

// d(direction)/ds.
PB_FUNC vec3 cubeFaceRight(int face) {
  if (face == 0) return vec3(0.0f, 0.0f, -1.0f);
  if (face == 1) return vec3(0.0f, 0.0f, 1.0f);
  if (face == 5) return vec3(-1.0f, 0.0f, 0.0f);
  return vec3(1.0f, 0.0f, 0.0f);
}

// d(direction)/dt.
PB_FUNC vec3 cubeFaceDown(int face) {
  if (face == 2) return vec3(0.0f, 0.0f, 1.0f);
  if (face == 3) return vec3(0.0f, 0.0f, -1.0f);
  return vec3(0.0f, -1.0f, 0.0f);
}

// Not normalised: its component along the face's forward vector is 1.
PB_FUNC vec3 cubeDirection(int face, vec2 st) {
  return cubeFaceForward(face) + st.x * cubeFaceRight(face) + st.y * cubeFaceDown(face);
}

// The face with the largest component; on ties x before y before z.
PB_FUNC int cubeFaceOf(vec3 d) {
  vec3 a = abs(d);
  if (a.x >= a.y && a.x >= a.z) return d.x >= 0.0f ? 0 : 1;
  if (a.y >= a.z) return d.y >= 0.0f ? 2 : 3;
  return d.z >= 0.0f ? 4 : 5;
}

// Inverse of cubeDirection on the given face; d need not be normalised but must point to that side.
PB_FUNC vec2 cubeFaceCoordinates(int face, vec3 d) {
  float major = max(abs(dot(d, cubeFaceForward(face))), 1e-30f);
  return vec2(dot(d, cubeFaceRight(face)), dot(d, cubeFaceDown(face))) / major;
}

// Integral of the solid angle from the face's centre to (s, t) in one quadrant: atan(s t / sqrt(1 + s^2 + t^2)).
PB_FUNC float cubeCornerSolidAngle(vec2 st) {
  return atan(st.x * st.y / sqrt(1.0f + st.x * st.x + st.y * st.y));
}

// Solid angle in steradians of texel (x, y) of a face of n x n texels; all 6 n^2 of them sum to 4 pi.
PB_FUNC float cubeTexelSolidAngle(ivec2 texel, int n) {
  float step = 2.0f / float(n);
  vec2 lo = vec2(-1.0f) + step * vec2(texel);
  vec2 hi = lo + vec2(step);
  return cubeCornerSolidAngle(lo) + cubeCornerSolidAngle(hi) - cubeCornerSolidAngle(vec2(lo.x, hi.y)) -
         cubeCornerSolidAngle(vec2(hi.x, lo.y));
}

// Solid angle of the unit of area at (s, t): the cosine over the distance squared. Of small texels, of which the differences
// above cancel.
PB_FUNC float cubeSolidAngleDensity(vec2 st) {
  float distanceSquared = 1.0f + dot(st, st);
  return 1.0f / (distanceSquared * sqrt(distanceSquared));
}

// (x, y, face) of the texel that continues the given face beyond one of its edges: the neighbour face's texel in which
// the direction through the outside texel's centre falls. Texels of the face itself are returned as they are.
PB_FUNC ivec3 cubeWrapTexel(ivec2 texel, int face, int n) {
  if (texel.x >= 0 && texel.y >= 0 && texel.x < n && texel.y < n) return ivec3(texel, face);
  vec2 st = (2.0f * vec2(texel) + vec2(1.0f)) / float(n) - vec2(1.0f);
  vec3 d = cubeDirection(face, st);
  int neighbour = cubeFaceOf(d);
  vec2 uv = 0.5f * (cubeFaceCoordinates(neighbour, d) + vec2(1.0f)) * float(n);
  return ivec3(clamp(ivec2(floor(uv)), ivec2(0), ivec2(n - 1)), neighbour);
}

// Seamless bilinear footprint in a cube map of n x n texels a face: four texels (x, y, face) and their weights.
// The missing texel beyond a cube corner counts as the mean of the other three (OpenGL 4.5 core, section 8.14.3).
struct CubeTaps {
  ivec3 p00;
  ivec3 p10;
  ivec3 p01;
  ivec3 p11;
  vec4 weights;  // of p00 p10 p01 p11, summing to 1
};

PB_FUNC CubeTaps cubeBilinearTaps(vec3 d, int n) {
  int face = cubeFaceOf(d);
  vec2 uv = 0.5f * (cubeFaceCoordinates(face, d) + vec2(1.0f)) * float(n) - vec2(0.5f);
  vec2 corner = floor(uv);
  vec2 f = uv - corner;
  ivec2 p = ivec2(corner);
  bool outX0 = p.x < 0;
  bool outX1 = p.x + 1 >= n;
  bool outY0 = p.y < 0;
  bool outY1 = p.y + 1 >= n;
  vec4 w = vec4((1.0f - f.x) * (1.0f - f.y), f.x * (1.0f - f.y), (1.0f - f.x) * f.y, f.x * f.y);
  float third = 1.0f / 3.0f;
  if (outX0 && outY0) w = vec4(0.0f, w.y + w.x * third, w.z + w.x * third, w.w + w.x * third);
  else if (outX1 && outY0) w = vec4(w.x + w.y * third, 0.0f, w.z + w.y * third, w.w + w.y * third);
  else if (outX0 && outY1) w = vec4(w.x + w.z * third, w.y + w.z * third, 0.0f, w.w + w.z * third);
  else if (outX1 && outY1) w = vec4(w.x + w.w * third, w.y + w.w * third, w.z + w.w * third, 0.0f);
  CubeTaps taps;
  taps.p00 = cubeWrapTexel(p, face, n);
  taps.p10 = cubeWrapTexel(p + ivec2(1, 0), face, n);
  taps.p01 = cubeWrapTexel(p + ivec2(0, 1), face, n);
  taps.p11 = cubeWrapTexel(p + ivec2(1, 1), face, n);
  taps.weights = w;
  return taps;
}

// Seamless bilinear lookup of level 0. `faces` holds the six faces as layers.
PB_FUNC vec4 sampleCube(sampler2DArray faces, vec3 d) {
  CubeTaps taps = cubeBilinearTaps(d, textureSize(faces, 0).x);
  return taps.weights.x * texelFetch(faces, taps.p00, 0) + taps.weights.y * texelFetch(faces, taps.p10, 0) +
         taps.weights.z * texelFetch(faces, taps.p01, 0) + taps.weights.w * texelFetch(faces, taps.p11, 0);
}
