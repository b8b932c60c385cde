// What is seen through a transmitting surface.

// weight: of specularWeights(); the surface's normal is on the viewer's side.
vec3 refractedRadiance(Surface s, vec3 toViewer, vec3 weight) {
  float relativeIor = isThinWalled(s) ? 1.0f : (gl_FrontFacing ? s.ior : 1.0f / s.ior);
  vec3 refracted = refractedDirection(-toViewer, s.normal, relativeIor);
  // Zero beyond the critical angle: no direction to look up.
  if (dot(refracted, refracted) == 0.0f) return vec3(0.0f);
  return weight * radianceAlong(refracted);
}
