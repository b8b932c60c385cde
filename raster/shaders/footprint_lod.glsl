// Which level of a cube map holds what a sample of the picture sees in it: Technique::mips.

// Edge of the sample's footprint in texels of level 0: the larger of the derivatives along the window's axes of the
// coordinates on the face (OpenGL 4.5 core, sections 8.13 and 8.14.1, with the Euclidean length).
float footprintTexels(vec3 d, float resolution) {
  vec3 a = abs(d);
  float major = max(a.x, max(a.y, a.z));
  vec3 axis = a.z == major ? vec3(0.0f, 0.0f, sign(d.z)) : vec3(0.0f);
  if (a.y == major) axis = vec3(0.0f, sign(d.y), 0.0f);
  if (a.x == major) axis = vec3(sign(d.x), 0.0f, 0.0f);
  vec3 dx = dFdx(d);
  vec3 dy = dFdy(d);
  vec3 onFace = d / major;
  float larger = max(length(dx - dot(dx, axis) * onFace), length(dy - dot(dy, axis) * onFace)) / major;
  return 0.5f * resolution * larger;
}

float footprintLod(samplerCube map, vec3 d) {
  float resolution = float(textureSize(map, 0).x);
  float texels = clamp(footprintTexels(d, resolution), 1.0f, resolution);
#ifdef MIPS_GGX
  // Lobes of the level whose box of the same solid angle would be as wide (boxLod), less those of a single texel.
  float last = float(textureQueryLevels(map) - 1);
  float lobe = 0.40824829f / resolution;  // 1 / sqrt(6)
  return max(ggxLod(sqrt(min(lobe * texels, 1.0f)), last) - ggxLod(sqrt(lobe), last), 0.0f);
#else
  return log2(texels);
#endif
}
