// Materials: constants, what a hit point looks like after its textures, and how much of each light it sends on.

const float kSurfaceDiffuse = 0.0f;  // Lambert's law, no specular reflection at all
const float kSurfaceMirror = 1.0f;   // smooth metal: reflects one direction
const float kSurfaceGlass = 2.0f;    // dielectric that transmits: reflects and refracts
const float kSurfaceUnlit = 3.0f;    // KHR_materials_unlit: base colour is radiance
const float kSurfaceGlossy = 4.0f;   // glTF's metallic-roughness model: metal, or a dielectric coat on a diffuse base

const float kAlphaOpaque = 0.0f;
const float kAlphaMask = 1.0f;
const float kAlphaBlend = 2.0f;

struct TextureSlot {
  vec4 matrix;   // KHR_texture_transform: columns (x,y) and (z,w)
  vec4 offset;   // xy offset, z UV set, w: 1 if there is a texture
  vec4 sampler_;  // see texture.glsl
};

struct MaterialConstants {
  vec4 baseColor;     // rgb, a
  vec4 emission;      // rgb radiance in W/(sr m^2); w: normal map scale
  vec4 factors;       // metallic, perceptual roughness, occlusion strength, transmission
  vec4 kind;          // x kSurface*, y index of refraction, z thickness in metres (0: thin-walled), w dispersion (20 / Abbe number)
  vec4 specular;      // KHR_materials_specular: rgb factor of F0, w factor of F0 and F90 (dielectrics only)
  vec4 absorption;    // rgb coefficients inside, 1/m
  vec4 conductorEta;  // rgb real part of a metal's index of refraction; w: 1 if known, else F0 is the base colour
  vec4 conductorK;    // rgb imaginary part
  vec4 alpha;         // x kAlpha*, y cutoff of kAlphaMask
  TextureSlot baseColorSlot;
  TextureSlot metallicRoughnessSlot;
  TextureSlot normalSlot;
  TextureSlot emissionSlot;
  TextureSlot occlusionSlot;
};

struct Surface {
  vec3 position;  // world
  vec3 normal;    // world, unit, shading normal on the viewer's side
  vec3 baseColor;
  float opacity;  // coverage: what share of the surface is there
  vec3 emission;
  float metallic;
  float roughness;  // perceptual
  float alpha;      // of GGX: roughness squared, 0 for perfectly smooth surfaces
  float occlusion;
  float transmission;
  float ior;
  float thickness;  // metres
  float dispersion;
  vec3 specularColor;
  float specularFactor;
  vec3 absorption;
  vec4 conductorEta;
  vec3 conductorK;
  float kind;
};

// GGX alpha of a perceptual roughness; 0 for what is treated as perfectly smooth.
PB_FUNC float ggxAlpha(float roughness) {
  float alpha = roughness * roughness;
  return alpha < kSmoothAlpha ? 0.0f : alpha;
}

// Texels as sampled, white where there is no texture; vertexColor white where the mesh has none.
PB_FUNC Surface makeSurface(MaterialConstants m, vec3 position, vec3 normal, vec4 vertexColor, vec4 baseColorTexel,
                            vec4 metallicRoughnessTexel, vec4 emissionTexel, vec4 occlusionTexel) {
  Surface s;
  s.position = position;
  s.normal = normal;
  // Surfaces that reflect more than arrives would make light without end.
  s.baseColor = vec3(m.baseColor) * vec3(baseColorTexel) * vec3(vertexColor);
  if (m.kind.x != kSurfaceUnlit) s.baseColor = min(s.baseColor, vec3(1.0f));
  s.opacity = clamp(m.baseColor.w * baseColorTexel.w * vertexColor.w, 0.0f, 1.0f);
  if (m.alpha.x == kAlphaMask) s.opacity = s.opacity >= m.alpha.y ? 1.0f : 0.0f;
  if (m.alpha.x == kAlphaOpaque) s.opacity = 1.0f;
  s.emission = vec3(m.emission) * vec3(emissionTexel);
  s.metallic = clamp(m.factors.x * metallicRoughnessTexel.z, 0.0f, 1.0f);
  s.roughness = clamp(m.factors.y * metallicRoughnessTexel.y, 0.0f, 1.0f);
  s.alpha = ggxAlpha(s.roughness);
  s.occlusion = 1.0f + m.factors.z * (occlusionTexel.x - 1.0f);
  s.transmission = m.factors.w;
  s.ior = m.kind.y;
  s.thickness = m.kind.z;
  s.dispersion = m.kind.w;
  s.specularColor = vec3(m.specular);
  s.specularFactor = m.specular.w;
  s.absorption = vec3(m.absorption);
  s.conductorEta = m.conductorEta;
  s.conductorK = vec3(m.conductorK);
  s.kind = m.kind.x;
  return s;
}

// Tangent-space normal map: texel in [0,1], tangent.w the bitangent's sign (glTF 2.0, 3.7.2.1 and 3.9.3).
PB_FUNC vec3 mappedNormal(vec3 normal, vec4 tangent, vec4 texel, float scale) {
  vec3 t = 2.0f * vec3(texel) - vec3(1.0f);
  vec3 bitangent = cross(normal, vec3(tangent)) * tangent.w;
  return safeNormalize(scale * t.x * vec3(tangent) + scale * t.y * bitangent + t.z * normal);
}

// A transmitting surface without a volume behind it: light goes straight on (KHR_materials_transmission).
PB_FUNC bool isThinWalled(Surface s) { return s.kind == kSurfaceGlass && s.thickness <= 0.0f; }

// Whether the surface has a specular lobe.
PB_FUNC bool isSpecular(Surface s) {
  return s.kind == kSurfaceMirror || s.kind == kSurfaceGlass || s.kind == kSurfaceGlossy;
}

// Reflectance of the diffuse base, under its coat.
PB_FUNC vec3 diffuseAlbedo(Surface s) {
  if (s.kind == kSurfaceMirror || s.kind == kSurfaceGlossy) return (1.0f - s.metallic) * s.baseColor;
  if (s.kind == kSurfaceGlass) return (1.0f - s.transmission) * s.baseColor;
  return s.baseColor;
}

// Reflectance of the dielectric at normal incidence (glTF 2.0, KHR_materials_specular) and at grazing incidence.
PB_FUNC vec3 coatF0(Surface s) {
  return s.specularFactor * min(dielectricF0(s.ior) * s.specularColor, vec3(1.0f));
}
PB_FUNC float coatF90(Surface s) { return s.specularFactor; }

// F0 and F90 of the whole specular lobe, for split sums.
PB_FUNC vec3 specularF0(Surface s) {
  vec3 metal = s.conductorEta.w > 0.5f ? F_Conductor(1.0f, vec3(s.conductorEta), s.conductorK) : s.baseColor;
  return mix(coatF0(s), metal, s.metallic);
}
PB_FUNC float specularF90(Surface s) { return mix(coatF90(s), 1.0f, s.metallic); }

// Of a metal; VoH is the cosine to the microfacet. A metal of unknown indices is defined by Schlick's law. A ratio mixes what
// is reflected with what is refracted: metals, which refract nothing, keep their exact law, or else even a perfect mirror
// would be dark from the front.
PB_FUNC vec3 metalReflectance(Surface s, float VoH, vec4 law) {
  bool known = s.conductorEta.w > 0.5f;
  if (known && law.x != kFresnelSchlick) return F_Conductor(VoH, vec3(s.conductorEta), s.conductorK);
  return F_Schlick(known ? F_Conductor(1.0f, vec3(s.conductorEta), s.conductorK) : s.baseColor, VoH);
}

// Of a dielectric coat: between F0 and F90 as the law goes from normal to grazing incidence.
PB_FUNC vec3 coatReflectance(Surface s, float VoH, vec4 law) {
  if (law.x == kFresnelRatio) return vec3(s.specularFactor * F_Ratio(VoH, law.y, law.z, law.w));
  float f0 = dielectricF0(s.ior);
  float rise = pow5(clamp(1.0f - VoH, 0.0f, 1.0f));
  if (law.x == kFresnelExact && f0 < 1.0f) rise = (F_Dielectric(VoH, s.ior) - f0) / (1.0f - f0);
  return mix(coatF0(s), vec3(coatF90(s)), rise);
}

// Reflectance of the mirror's or the glossy surface's microfacets.
PB_FUNC vec3 specularReflectance(Surface s, float VoH, vec4 law) {
  if (s.kind == kSurfaceMirror) return s.metallic * metalReflectance(s, VoH, law);
  return mix(coatReflectance(s, VoH, law), metalReflectance(s, VoH, law), s.metallic);
}

// Directional albedo of the surface's specular lobe as x F0 + y F90: the table's, exact for smooth surfaces.
PB_FUNC vec2 surfaceDfg(Surface s, sampler2D dfgTable, float NoV) {
  float rise = pow5(clamp(1.0f - NoV, 0.0f, 1.0f));
  if (s.alpha == 0.0f) return vec2(1.0f - rise, rise);
  return sampleDfg(dfgTable, NoV, s.roughness);
}

// What the coat reflects of uniform light and so keeps from the diffuse base. dfg: of surfaceDfg().
PB_FUNC vec3 coatAlbedo(Surface s, vec2 dfg) {
  if (s.kind != kSurfaceGlossy && s.kind != kSurfaceGlass) return vec3(0.0f);
  return min(dfg.x * coatF0(s) + vec3(dfg.y * coatF90(s)), vec3(1.0f));
}

// Radiance towards the viewer without what is reflected or refracted specularly.
// irradiance: sum over the lights (W/m^2); ambient: irradiance of the environment divided by pi; coat: of coatAlbedo().
PB_FUNC vec3 localRadiance(Surface s, vec3 irradiance, vec3 ambient, vec3 coat) {
  if (s.kind == kSurfaceUnlit) return s.baseColor;
  return s.emission + diffuseAlbedo(s) * (vec3(1.0f) - coat) * (irradiance / kPi + s.occlusion * ambient);
}

// Factors of the radiance looked up in the reflected and in the refracted direction of a smooth surface.
// cosine = dot(normal, to viewer) >= 0.
struct SpecularWeights {
  vec3 reflection;
  vec3 refraction;
};

// relativeIor = n_transmitted / n_incident (only read for glass). A thin wall is two parallel interfaces: all orders of
// reflection between them summed, r' = 2 r / (1 + r).
PB_FUNC SpecularWeights specularWeights(Surface s, float cosine, float relativeIor, vec4 law) {
  SpecularWeights w;
  w.reflection = vec3(0.0f);
  w.refraction = vec3(0.0f);
  if (s.kind == kSurfaceMirror || s.kind == kSurfaceGlossy) w.reflection = specularReflectance(s, cosine, law);
  if (s.kind == kSurfaceGlass) {
    bool thin = isThinWalled(s);
    float f = dielectricReflectance(law, cosine, thin ? s.ior : relativeIor);
    if (thin) f = 2.0f * f / (1.0f + f);
    w.reflection = vec3(f);
    w.refraction = s.transmission * (1.0f - f) * s.baseColor;
  }
  return w;
}

// BSDF (1/sr, no cosine) of the rough specular lobe for unit directions; 0 for smooth surfaces, and for what volumes
// transmit. A thin wall transmits the reflected lobe, mirrored (KHR_materials_transmission). relativeIor as in
// specularWeights().
PB_FUNC vec3 specularBsdf(Surface s, vec3 toViewer, vec3 toLight, float relativeIor, vec4 law, float geometry) {
  bool through = isThinWalled(s) && dot(s.normal, toLight) < 0.0f;
  vec3 l = through ? reflectedDirection(toLight, s.normal) : toLight;
  float NoV = dot(s.normal, toViewer);
  float NoL = dot(s.normal, l);
  if (s.alpha == 0.0f || !isSpecular(s) || NoV <= 0.0f || NoL <= 0.0f) return vec3(0.0f);
  vec3 h = safeNormalize(toViewer + l);
  float NoH = clamp(dot(s.normal, h), 0.0f, 1.0f);
  float VoH = clamp(dot(toViewer, h), 0.0f, 1.0f);
  float g = geometryTerm(geometry, NoL, NoV, NoH, VoH, s.alpha);
  SpecularWeights w = specularWeights(s, VoH, relativeIor, law);
  vec3 f = through ? w.refraction : w.reflection;
  return f * (D_GGX(NoH, crossSquared(s.normal, h), s.alpha) * g / max(4.0f * NoL * NoV, 1e-12f));
}
