// Writes texels of the maps' format. Formats that images don't have are written as the bits of a texel: STORE_RGB9_E5,
// STORE_SRGB8.

#ifdef STORE_RGB9_E5
// EXT_texture_shared_exponent, section 3.8.x.y: three significands of 9 bits under one exponent, biased by 15.
uint sharedExponentBits(vec3 radiance) {
  vec3 c = clamp(radiance, vec3(0.0f), vec3(65408.0f));
  float largest = max(c.x, max(c.y, c.z));
  int exponent = max(int(floatBitsToUint(largest) >> 23) - 127, -16) + 16;
  float scale = uintBitsToFloat(uint(24 - exponent + 127) << 23);  // 2^(24 - exponent)
  if (floor(largest * scale + 0.5f) == 512.0f) {
    ++exponent;
    scale *= 0.5f;
  }
  uvec3 s = uvec3(floor(c * scale + vec3(0.5f)));
  return uint(exponent) << 27 | s.z << 18 | s.y << 9 | s.x;
}
uvec4 texelBits(vec3 radiance) { return uvec4(sharedExponentBits(radiance), 0u, 0u, 0u); }
#endif

#ifdef STORE_SRGB8
#include "scenes/shading/srgb.glsl"
uvec4 texelBits(vec3 radiance) {
  vec4 encoded = vec4(srgbEncode(radiance.x), srgbEncode(radiance.y), srgbEncode(radiance.z), 1.0f);
  return uvec4(packUnorm4x8(encoded), 0u, 0u, 0u);
}
#endif

#if defined(STORE_RGB9_E5) || defined(STORE_SRGB8)
layout(binding = kFilterTargetImage) writeonly uniform uimage2DArray target;
void storeTexel(ivec3 texel, vec3 radiance) { imageStore(target, texel, texelBits(radiance)); }
#else
layout(binding = kFilterTargetImage) writeonly uniform image2DArray target;
void storeTexel(ivec3 texel, vec3 radiance) { imageStore(target, texel, vec4(radiance, 1.0f)); }
#endif
