// Where a ray that starts at a surface meets surroundings of a simple shape, as a direction from the probe that captured
// them. Not normalised. Lookups as if everything were infinitely far away take the ray's own direction instead.

// A sphere around the probe; `from` is relative to the probe, d a unit vector. From outside, rays that miss the sphere
// keep their direction.
PB_FUNC vec3 sphereProxyDirection(vec3 from, vec3 d, float radius) {
  float b = dot(from, d);
  float discriminant = b * b - dot(from, from) + radius * radius;
  float way = sqrt(max(discriminant, 0.0f)) - b;
  return discriminant < 0.0f || way <= 0.0f ? d : from + way * d;
}

// Way along d to the plane of a box that bounds what lies ahead on one axis.
PB_FUNC float wayToBoxPlane(float from, float d, float lower, float upper) {
  if (abs(d) < 1e-20f) return 1e20f;
  return ((d > 0.0f ? upper : lower) - from) / d;
}

// A box of the given corners, `from` and `probe` in the same space: Lagarde and Zanuttini, "Local Image-based Lighting
// With Parallax-corrected Cubemaps" (SIGGRAPH 2012). Rays that leave the box's outside keep their direction.
PB_FUNC vec3 boxProxyDirection(vec3 from, vec3 d, vec3 lower, vec3 upper, vec3 probe) {
  float way = min(wayToBoxPlane(from.x, d.x, lower.x, upper.x),
                  min(wayToBoxPlane(from.y, d.y, lower.y, upper.y), wayToBoxPlane(from.z, d.z, lower.z, upper.z)));
  return way <= 0.0f ? d : from - probe + way * d;
}

// Distance impostors: Szirmay-Kalos, Aszodi, Lazanyi and Premecz, "Approximate Ray-Tracing on the GPU with Distance
// Impostors" (2005). Everything is relative to the probe.
//
// The ray from + way d, way = |from| t / (1 - t), is searched as t goes from 0 at its start to 1 at infinity. The point
// at t lies in the direction (1 - t) from + t |from| d. `far` is |from| d.
PB_FUNC vec3 impostorDirection(vec3 from, vec3 far, float t) { return (1.0f - t) * from + t * far; }

// Negative in front of what was captured, positive behind it. `captured` is the reciprocal of the depth in the impostor's
// direction, along the axis of its cube face: 0 for what is infinitely far away. In front of a plane, where reciprocal
// depth is linear in the direction, this is linear in t: one secant step finds it.
PB_FUNC float impostorExcess(vec3 direction, float t, float captured) {
  vec3 a = abs(direction);
  return max(a.x, max(a.y, a.z)) * captured - (1.0f - t);
}

// Where the line through two points of excess < 0 and > 0 crosses zero.
PB_FUNC float impostorSecant(vec2 front, vec2 behind) {
  return front.x + (behind.x - front.x) * front.y / min(front.y - behind.y, -1e-20f);
}

// Where a point of a screen with texture coordinates uv looks its reflection up in one picture; r is the reflected
// direction along the screen's right and down. As a report on a heap of CRT monitors does it, by eye.
PB_FUNC vec2 singleViewCoordinates(vec2 uv, vec2 r) {
  return 0.5f * (0.25f * (uv - vec2(0.5f)) + 0.75f * 0.5f * r) + vec2(0.5f);
}
