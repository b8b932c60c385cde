// Where in a probe's map a point looks up what it sees along a direction.
//
// Variants by defines, at most one: SPHERE_PROXY (with SPHERE_RADIUS unless the probe's own), BOX_PROXY, or
// DISTANCE_IMPOSTOR (number of evenly spaced samples of the linear search) with SECANT_STEPS; none for surroundings that
// are infinitely far away. With SINGLE_VIEW, coordinates in the probe's one view take the place of the direction.

#ifdef DISTANCE_IMPOSTOR
// x t, y excess there.
vec2 impostorSample(samplerCube depths, float near, vec3 from, vec3 far, float t) {
  vec3 direction = impostorDirection(from, far, t);
  return vec2(t, impostorExcess(direction, t, textureLod(depths, direction, 0.0f).x / near));
}

// The linear search finds the first interval in which the ray goes behind what was captured, the secant search the
// place in it. A ray that starts hidden from the probe counts from where it comes into sight.
vec3 impostorHit(samplerCube depths, float near, vec3 from, vec3 d) {
  vec3 far = length(from) * d;
  vec2 front = impostorSample(depths, near, from, far, 0.0f);
  vec2 behind = vec2(1.0f, 0.0f);
  for (int i = 1; i <= DISTANCE_IMPOSTOR + 1; ++i) {
    vec2 here = impostorSample(depths, near, from, far, float(i) / float(DISTANCE_IMPOSTOR + 1));
    if (behind.y > 0.0f) continue;
    if (front.y <= 0.0f && here.y > 0.0f) behind = here;
    else front = here;
  }
  if (behind.y <= 0.0f) return d;  // what the ray meets is infinitely far away, or hidden from the probe
  // Regula falsi. An end that stays counts half (Illinois), so that both move.
  float side = 0.0f;
  float t = impostorSecant(front, behind);
  for (int i = 1; i < SECANT_STEPS; ++i) {
    vec2 here = impostorSample(depths, near, from, far, t);
    if (here.y < 0.0f) {
      if (side < 0.0f) behind.y *= 0.5f;
      front = here;
    } else {
      if (side > 0.0f) front.y *= 0.5f;
      behind = vec2(here.x, max(here.y, 1e-20f));
    }
    side = here.y;
    t = impostorSecant(front, behind);
  }
  return impostorDirection(from, far, t);
}
#endif

#if defined(SPHERE_PROXY) || defined(BOX_PROXY) || defined(DISTANCE_IMPOSTOR) || defined(SINGLE_VIEW)
#define LOCAL_LOOKUP
layout(std140, binding = kProbeBlock) uniform ProbeBlock { ProbeConstants probeConstants; };
#ifdef BLENDED_PROBES
layout(std140, binding = kSecondProbeBlock) uniform SecondProbeBlock { ProbeConstants secondProbeConstants; };
#endif
#endif

#ifdef DISTANCE_IMPOSTOR
layout(binding = kProbeDepthUnit) uniform samplerCube probeDepths;
#ifdef BLENDED_PROBES
layout(binding = kSecondProbeDepthUnit) uniform samplerCube secondProbeDepths;
#endif
vec3 lookupDirection(ProbeConstants p, samplerCube depths, vec3 from, vec3 d) {
  return impostorHit(depths, p.position.w, from - vec3(p.position), d);
}
#endif
#ifdef SPHERE_PROXY
#ifndef SPHERE_RADIUS
#define SPHERE_RADIUS p.boxLower.w
#endif
vec3 lookupDirection(ProbeConstants p, vec3 from, vec3 d) {
  return sphereProxyDirection(from - vec3(p.position), d, SPHERE_RADIUS);
}
#endif
#ifdef BOX_PROXY
vec3 lookupDirection(ProbeConstants p, vec3 from, vec3 d) {
  return boxProxyDirection(from, d, vec3(p.boxLower), vec3(p.boxUpper), vec3(p.position));
}
#endif

#ifdef SINGLE_VIEW
// Surfaces without tangents take the view's right as theirs, those without attributes the middle of their texture.
vec3 lookupDirection(ProbeConstants p, vec3 from, vec3 d) {
  vec3 normal = gl_FrontFacing ? safeNormalize(worldNormal) : -safeNormalize(worldNormal);
  vec4 tangent = vec4(vec3(p.right), 1.0f);
  vec2 coordinates = vec2(0.5f);
#ifdef ATTRIBUTES
  if (worldTangent.w != 0.0f) tangent = worldTangent;
  coordinates = vec2(uv.x, uv.y);
#endif
  vec3 right = safeNormalize(vec3(tangent) - dot(vec3(tangent), normal) * normal);
  vec3 up = cross(normal, right) * tangent.w;
  return vec3(singleViewCoordinates(coordinates, vec2(dot(d, right), -dot(d, up))), 0.0f);
}
#endif

// Of the surface's probe, and of the second one of BLENDED_PROBES.
#if defined(DISTANCE_IMPOSTOR)
#define FIRST_DIRECTION(from, d) lookupDirection(probeConstants, probeDepths, from, d)
#define SECOND_DIRECTION(from, d) lookupDirection(secondProbeConstants, secondProbeDepths, from, d)
#elif defined(LOCAL_LOOKUP)
#define FIRST_DIRECTION(from, d) lookupDirection(probeConstants, from, d)
#define SECOND_DIRECTION(from, d) lookupDirection(secondProbeConstants, from, d)
#else
#define FIRST_DIRECTION(from, d) d
#define SECOND_DIRECTION(from, d) d
#endif
