// The surface at a fragment with its textures read: the twin of pb::readSurface() in scenes/snapshot.h.
//
// Variants by defines: SURFACE_KIND and EMITS (emission is not zero) as far as known; ATTRIBUTES if vertices carry more than position and normal; for each texture that the material has
// *_TEXTURE, whose value is the sampler's settings; TEXTURES_HARDWARE to filter by the driver's samplers instead of by
// scenes/shading/texture.glsl.

layout(location = 0) in vec3 worldPosition;
layout(location = 1) in vec3 worldNormal;
#ifdef ATTRIBUTES
layout(location = 2) in vec4 worldTangent;
layout(location = 3) in vec4 uv;
layout(location = 4) in vec4 color;
layout(location = 5) in float uvPerMetre;
#endif

#ifdef BASE_COLOR_TEXTURE
layout(binding = kMaterialUnit) uniform sampler2D baseColorTexture;
#endif
#ifdef METALLIC_ROUGHNESS_TEXTURE
layout(binding = kMaterialUnit + 1) uniform sampler2D metallicRoughnessTexture;
#endif
#ifdef NORMAL_TEXTURE
layout(binding = kMaterialUnit + 2) uniform sampler2D normalTexture;
#endif
#ifdef EMISSION_TEXTURE
layout(binding = kMaterialUnit + 3) uniform sampler2D emissionTexture;
#endif
#ifdef OCCLUSION_TEXTURE
layout(binding = kMaterialUnit + 4) uniform sampler2D occlusionTexture;
#endif

// The fragment as its viewer sees it.
struct Fragment {
  vec3 toViewer;   // unit
  vec3 normal;     // interpolated and normalised; the geometric side decides its sign
  float cosine;    // between the two
  float coneWidth;  // metres
};

Fragment makeFragment() {
  Fragment f;
  vec3 toViewer = vec3(pass.view.origin) - worldPosition;
  float distanceToViewer = length(toViewer);
  f.toViewer = toViewer / distanceToViewer;
  f.normal = gl_FrontFacing ? safeNormalize(worldNormal) : -safeNormalize(worldNormal);
  f.cosine = dot(f.normal, f.toViewer);
  f.coneWidth = pass.view.forward.w * distanceToViewer;
  return f;
}

#ifdef ATTRIBUTES
float slotLod(sampler2D image, TextureSlot slot, Fragment f) {
  return coneLod(f.coneWidth, f.cosine, uvPerMetre, textureSize(image, 0), slot.matrix);
}

vec2 slotCoordinates(TextureSlot slot) {
  return textureCoordinates(slot.matrix, slot.offset, vec2(uv.x, uv.y), vec2(uv.z, uv.w));
}

vec4 sampleSlot(sampler2D image, TextureSlot slot, vec4 settings, Fragment f) {
#ifdef TEXTURES_HARDWARE
  return texture(image, slotCoordinates(slot));
#else
  return sampleTexture(image, slotCoordinates(slot), slotLod(image, slot, f), settings);
#endif
}
#endif

// The material, with what the variant says known to the compiler.
MaterialConstants knownMaterial() {
  MaterialConstants m = material;
#if defined(ALPHA_MASK)
  m.alpha.x = kAlphaMask;
#elif defined(ALPHA_BLEND)
  m.alpha.x = kAlphaBlend;
#else
  m.alpha.x = kAlphaOpaque;
#endif
#ifdef SURFACE_KIND
  m.kind.x = SURFACE_KIND;
#ifndef EMITS
  m.emission = vec4(vec3(0.0f), m.emission.w);
#endif
#endif
#ifndef CONDUCTOR
  m.conductorEta = vec4(0.0f);
#endif
  return m;
}

Surface readSurface(Fragment f) {
  vec3 normal = f.normal;
  vec4 vertexColor = vec4(1.0f);
  vec4 baseColorTexel = vec4(1.0f);
  vec4 metallicRoughnessTexel = vec4(1.0f);
  vec4 emissionTexel = vec4(1.0f);
  vec4 occlusionTexel = vec4(1.0f);
#ifdef ATTRIBUTES
  vertexColor = color;
#endif
#ifdef NORMAL_TEXTURE
  vec4 normalTexel = sampleSlot(normalTexture, material.normalSlot, NORMAL_TEXTURE, f);
  vec4 tangent = vec4(safeNormalize(vec3(worldTangent)), worldTangent.w);
  if (tangent.w != 0.0f) normal = mappedNormal(f.normal, tangent, normalTexel, material.emission.w);
#endif
#ifdef BASE_COLOR_TEXTURE
  baseColorTexel = sampleSlot(baseColorTexture, material.baseColorSlot, BASE_COLOR_TEXTURE, f);
#endif
#ifdef METALLIC_ROUGHNESS_TEXTURE
  metallicRoughnessTexel = sampleSlot(metallicRoughnessTexture, material.metallicRoughnessSlot, METALLIC_ROUGHNESS_TEXTURE, f);
#endif
#ifdef EMISSION_TEXTURE
  emissionTexel = sampleSlot(emissionTexture, material.emissionSlot, EMISSION_TEXTURE, f);
#endif
#ifdef OCCLUSION_TEXTURE
  occlusionTexel = sampleSlot(occlusionTexture, material.occlusionSlot, OCCLUSION_TEXTURE, f);
#endif
  return makeSurface(knownMaterial(), worldPosition, normal, vertexColor, baseColorTexel, metallicRoughnessTexel,
                     emissionTexel, occlusionTexel);
}
