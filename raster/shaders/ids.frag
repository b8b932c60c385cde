#version 450 core
// What a sample shows, as pb::SampleId: instance, smoothing group, base colour texel. Surfaces with any coverage count.
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/surface_fetch.glsl"

layout(std430, binding = kSmoothingGroupBlock) readonly buffer SmoothingGroupBlock { uint smoothingGroups[]; };

layout(location = 0) out uvec4 id;

void main() {
#if defined(ALPHA_MASK) || defined(ALPHA_BLEND)
  if (readSurface(makeFragment()).opacity == 0.0f) discard;
#endif
  id = uvec4(uint(instance.values.z), smoothingGroups[gl_PrimitiveID] + 1u, 0u, 0u);
#ifdef BASE_COLOR_TEXTURE
  TextureSlot slot = material.baseColorSlot;
  float lod = slotLod(baseColorTexture, slot, makeFragment());
  id.z = uint(nearestTexelId(baseColorTexture, slotCoordinates(slot), lod, BASE_COLOR_TEXTURE));
#endif
}
