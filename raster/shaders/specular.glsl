// What a specular surface shows of its surroundings. dfg: of surfaceDfg().
vec3 specularRadiance(Surface s, vec3 toViewer, vec2 dfg) {
  float relativeIor = gl_FrontFacing ? s.ior : 1.0f / s.ior;
  SpecularWeights weights = specularWeights(s, max(dot(s.normal, toViewer), 0.0f), relativeIor, kFresnelLaw);
  vec3 sum = weights.reflection * radianceAlong(reflectedDirection(-toViewer, s.normal));
  if (s.kind == kSurfaceGlass) sum += refractedRadiance(s, toViewer, weights.refraction);
  return sum;
}
