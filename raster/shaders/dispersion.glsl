// What is seen through a transmitting surface, in all colours.
//
// Variants by defines, for materials with dispersion only: DISPERSION_PER_CHANNEL looks up one ray for each channel's index
// of refraction, DISPERSION_RGB_OFFSET one ray whose direction is offset by a fixed fraction for red and for blue.

// Of the refracted ray's part along the surface: as if the sine of its angle were that much larger for red and smaller for
// blue, whatever the material.
const float kRgbOffset = 0.01f;

#ifdef DISPERSION_RGB_OFFSET
vec3 radianceAlongOffset(Surface s, RefractedRay ray, float offset) {
  vec3 alongSurface = ray.direction - dot(ray.direction, s.normal) * s.normal;
  ray.direction = safeNormalize(ray.direction + offset * alongSurface);
  return radianceOf(s, ray, s.ior);
}
#endif

// weight: of specularWeights(); the surface's normal is on the viewer's side.
vec3 refractedRadiance(Surface s, vec3 toViewer, vec3 weight) {
#if defined(DISPERSION_PER_CHANNEL)
  return weight * vec3(radianceThrough(s, toViewer, channelIor(s.ior, s.dispersion, 0)).x,
                       radianceThrough(s, toViewer, channelIor(s.ior, s.dispersion, 1)).y,
                       radianceThrough(s, toViewer, channelIor(s.ior, s.dispersion, 2)).z);
#elif defined(DISPERSION_RGB_OFFSET)
  RefractedRay ray = refractedRay(s, toViewer, s.ior);
  if (dot(ray.direction, ray.direction) == 0.0f) return vec3(0.0f);
  return weight * vec3(radianceAlongOffset(s, ray, kRgbOffset).x, radianceOf(s, ray, s.ior).y,
                       radianceAlongOffset(s, ray, -kRgbOffset).z);
#else
  return weight * radianceThrough(s, toViewer, s.ior);
#endif
}
