// What is seen through a transmitting surface.
//
// Variants by defines, at most one: REFRACTION_THIN_WALL for surfaces without a volume behind them, else
// REFRACTION_TWO_INTERFACE, REFRACTION_CUBEMAP_BACKFACE or REFRACTION_THICK_SLAB, or none for one interface.

struct RefractedRay {
  vec3 origin;         // where it leaves
  vec3 direction;      // unit, to look up; zero where nothing is transmitted (beyond the critical angle)
  vec3 tint;           // of interfaces after the first
  float lengthMetres;  // of the way inside
};

// What the material says. A viewer inside sees through at most that much of what lies before the surface.
float assumedLengthInside(Surface s) {
  float assumed = s.thickness * instance.volume.x;
  if (gl_FrontFacing) return assumed;
#ifdef REFRACTION_CUBEMAP_BACKFACE
  return 0.0f;  // what its owner's capture shows is absorbed at the front face
#else
  return min(assumed, length(vec3(pass.view.origin) - s.position));
#endif
}

#ifdef REFRACTION_TWO_INTERFACE
layout(location = 6) in float inwardDistance;
layout(binding = kBackFaceUnit) uniform sampler2D backFaces;

// The way inside along `refracted`: between the distance to the back face on the viewer's ray, exact for a ray that isn't
// bent, and that along the inward normal, exact for one that is bent into it (Wyman 2005, eq. 2: by the ratio of the
// refracted to the incident angle).
float estimatedLengthInside(Surface s, vec3 toViewer, float ior) {
  float sine = min(length(cross(toViewer, s.normal)), 1.0f);
  float incident = atan(sine, dot(toViewer, s.normal));
  float refracted = asin(min(sine / ior, 1.0f));
  // The limit for small angles, which divide badly.
  float share = incident > 1e-3f ? clamp(refracted / incident, 0.0f, 1.0f) : min(1.0f / ior, 1.0f);
  float behind = texelFetch(backFaces, ivec2(vec2(gl_FragCoord)), 0).w;
  float alongView = behind - length(vec3(pass.view.origin) - s.position);
  return mix(inwardDistance, behind > 0.0f ? max(alongView, 0.0f) : inwardDistance, share);
}

// The inward normal of the back face that the pass shows at p; zero if it shows none there.
vec3 backNormalAt(vec3 p) {
  vec4 clip = clipFromWorldPosition(pass.view, p);
  if (clip.w <= 0.0f) return vec3(0.0f);
  vec2 st = vec2(clip) / clip.w;
  return safeNormalize(vec3(textureLod(backFaces, 0.5f * st + vec2(0.5f), 0.0f)));
}

// Where a ray inside goes on behind a surface of inward normal n. Beyond the critical angle: as it is reflected there,
// and then straight out.
vec3 directionBehind(vec3 d, vec3 n, float ior) {
  // The estimated point lies on a part of the surface that the ray can't leave by, or beside the object.
  if (dot(d, n) >= 0.0f) return d;
  vec3 refracted = refractedDirection(d, n, 1.0f / ior);
  return dot(refracted, refracted) > 0.0f ? refracted : reflectedDirection(d, n);
}

RefractedRay throughBothInterfaces(Surface s, vec3 toViewer, vec3 inside, float ior) {
  RefractedRay ray;
  ray.lengthMetres = estimatedLengthInside(s, toViewer, ior);
  ray.origin = s.position + ray.lengthMetres * inside;
  ray.direction = directionBehind(inside, backNormalAt(ray.origin), ior);
  // What the second interface reflects inwards leaves elsewhere, and is assumed to show the same radiance.
  ray.tint = s.transmission * s.baseColor;
  return ray;
}
#endif

// The one ray that stands for all light that the surface of that index of refraction transmits to the viewer.
RefractedRay refractedRay(Surface s, vec3 toViewer, float ior) {
  RefractedRay ray;
  ray.origin = s.position;
  ray.tint = vec3(1.0f);
  ray.lengthMetres = 0.0f;
#ifdef REFRACTION_THIN_WALL
  ray.direction = -toViewer;
#else
  ray.direction = refractedDirection(-toViewer, s.normal, gl_FrontFacing ? ior : 1.0f / ior);
  ray.lengthMetres = assumedLengthInside(s);
#if defined(REFRACTION_TWO_INTERFACE)
  if (gl_FrontFacing) ray = throughBothInterfaces(s, toViewer, ray.direction, ior);
#elif defined(REFRACTION_THICK_SLAB)
  vec3 exit = s.position + slabExitOffset(-toViewer, s.normal, ior, ray.lengthMetres);
  if (gl_FrontFacing) {
    ray.origin = exit;
    ray.direction = safeNormalize(exit - vec3(pass.view.origin));
  }
#endif
#endif
  return ray;
}

vec3 radianceOf(Surface s, RefractedRay ray, float ior) {
  return ray.tint * transmittance(s.absorption, ray.lengthMetres) *
         lobeRadiance(ray.origin, ray.direction, transmittedAlpha(s.alpha, ior, isThinWalled(s)));
}

// Radiance that arrives through the surface if its index of refraction is `ior`.
vec3 radianceThrough(Surface s, vec3 toViewer, float ior) {
  RefractedRay ray = refractedRay(s, toViewer, ior);
  if (dot(ray.direction, ray.direction) == 0.0f) return vec3(0.0f);
  return radianceOf(s, ray, ior);
}
