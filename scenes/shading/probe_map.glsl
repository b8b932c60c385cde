// Directions as points of a square: octahedra (Engelhardt and Dachsbacher, "Octahedron Environment Maps", 2008) and pairs of
// paraboloids (Heidrich and Seidel, "View-independent Environment Maps", 1998). Both stand on the Y axis. Coordinates are in
// [-1,1], x to the right and y downwards in memory order.

PB_FUNC float signOf(float x) { return x < 0.0f ? -1.0f : 1.0f; }

// The lower half of an octahedron on the upper one, and back.
PB_FUNC vec2 octahedralFold(vec2 p) {
  return vec2((1.0f - abs(p.y)) * signOf(p.x), (1.0f - abs(p.x)) * signOf(p.y));
}

// d need not be normalised.
PB_FUNC vec2 octahedralCoordinates(vec3 d) {
  vec2 p = vec2(d.x, d.z) / (abs(d.x) + abs(d.y) + abs(d.z));
  return d.y < 0.0f ? octahedralFold(p) : p;
}

// Beyond an edge the map goes on from the edge's other half: a direction for every point at most 2 outside of the square.
PB_FUNC vec3 octahedralDirection(vec2 st) {
  vec2 p = st;
  if (abs(p.x) > 1.0f) p = vec2(signOf(p.x) * (2.0f - abs(p.x)), -p.y);
  if (abs(p.y) > 1.0f) p = vec2(-p.x, signOf(p.y) * (2.0f - abs(p.y)));
  float y = 1.0f - abs(p.x) - abs(p.y);
  if (y < 0.0f) p = octahedralFold(p);
  return safeNormalize(vec3(p.x, y, p.y));
}

// Of the paraboloid on the direction's side; d must be normalised. Half spheres are unit discs.
PB_FUNC vec2 paraboloidCoordinates(vec3 d) { return vec2(d.x, d.z) / (1.0f + abs(d.y)); }

// side: 1 the upper half sphere, -1 the lower one. Beyond the unit circle the paraboloid goes on into the other half.
PB_FUNC vec3 paraboloidDirection(vec2 st, float side) {
  float squared = dot(st, st);
  return vec3(2.0f * st.x, side * (1.0f - squared), 2.0f * st.y) / (1.0f + squared);
}

// A square of edge x edge texels has one of them around its map on every side, for filtering: coordinates at a texel's
// centre, and texture coordinates of a point.
PB_FUNC vec2 borderedTexelCentre(ivec2 texel, int edge) {
  return (2.0f * vec2(texel) - vec2(1.0f)) / float(edge - 2) - vec2(1.0f);
}
PB_FUNC vec2 borderedTextureCoordinates(vec2 st, int edge) {
  return (0.5f * (st + vec2(1.0f)) * float(edge - 2) + vec2(1.0f)) / float(edge);
}
