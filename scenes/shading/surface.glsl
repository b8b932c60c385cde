// Materials: constants, what a hit point looks like after its textures, and how much of each light it sends on.

const float kSurfaceDiffuse = 0.0f;  // no specular lookup; rough metals show their base colour as albedo
const float kSurfaceMirror = 1.0f;   // smooth metal: reflects one direction
const float kSurfaceGlass = 2.0f;    // smooth dielectric: reflects one direction and refracts one
const float kSurfaceUnlit = 3.0f;    // KHR_materials_unlit: base colour is radiance

struct TextureSlot {
  vec4 matrix;   // KHR_texture_transform: columns (x,y) and (z,w)
  vec4 offset;   // xy offset, z UV set, w: 1 if there is a texture
  vec4 sampler_;  // see texture.glsl
};

struct MaterialConstants {
  vec4 baseColor;  // rgb, a
  vec4 emission;   // rgb radiance in W/(sr m^2); w: normal map scale
  vec4 factors;    // metallic, perceptual roughness, occlusion strength, transmission
  vec4 kind;       // x kSurface*, y index of refraction
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
  vec3 emission;
  float metallic;
  float occlusion;
  float transmission;
  float ior;
  float kind;
};

// Texels as sampled, white where there is no texture; vertexColor white where the mesh has none.
PB_FUNC Surface makeSurface(MaterialConstants m, vec3 position, vec3 normal, vec4 vertexColor, vec4 baseColorTexel,
                            vec4 metallicRoughnessTexel, vec4 emissionTexel, vec4 occlusionTexel) {
  Surface s;
  s.position = position;
  s.normal = normal;
  s.baseColor = vec3(m.baseColor) * vec3(baseColorTexel) * vec3(vertexColor);
  s.emission = vec3(m.emission) * vec3(emissionTexel);
  s.metallic = clamp(m.factors.x * metallicRoughnessTexel.z, 0.0f, 1.0f);
  s.occlusion = 1.0f + m.factors.z * (occlusionTexel.x - 1.0f);
  s.transmission = m.factors.w;
  s.ior = m.kind.y;
  s.kind = m.kind.x;
  return s;
}

// Tangent-space normal map: texel in [0,1], tangent.w the bitangent's sign (glTF 2.0, 3.7.2.1 and 3.9.3).
PB_FUNC vec3 mappedNormal(vec3 normal, vec4 tangent, vec4 texel, float scale) {
  vec3 t = 2.0f * vec3(texel) - vec3(1.0f);
  vec3 bitangent = cross(normal, vec3(tangent)) * tangent.w;
  return safeNormalize(scale * t.x * vec3(tangent) + scale * t.y * bitangent + t.z * normal);
}

// Reflectance of the diffuse part; the mirror part of a kSurfaceMirror and the clear part of a kSurfaceGlass are left out.
PB_FUNC vec3 diffuseAlbedo(Surface s) {
  if (s.kind == kSurfaceMirror) return (1.0f - s.metallic) * s.baseColor;
  if (s.kind == kSurfaceGlass) return (1.0f - s.transmission) * s.baseColor;
  return s.baseColor;
}

// Radiance towards the viewer without what is reflected or refracted specularly.
// irradiance: sum over the lights (W/m^2); ambient: irradiance of the environment divided by pi.
PB_FUNC vec3 localRadiance(Surface s, vec3 irradiance, vec3 ambient) {
  if (s.kind == kSurfaceUnlit) return s.baseColor;
  return s.emission + diffuseAlbedo(s) * (irradiance / kPi + s.occlusion * ambient);
}

// Factors of the radiance looked up in the reflected and in the refracted direction. cosine = dot(normal, to viewer) >= 0.
struct SpecularWeights {
  vec3 reflection;
  vec3 refraction;
};

// relativeIor = n_transmitted / n_incident (only read for glass).
PB_FUNC SpecularWeights specularWeights(Surface s, float cosine, float relativeIor) {
  SpecularWeights w;
  w.reflection = vec3(0.0f);
  w.refraction = vec3(0.0f);
  if (s.kind == kSurfaceMirror) w.reflection = s.metallic * F_Schlick(s.baseColor, cosine);
  if (s.kind == kSurfaceGlass) {
    float f = F_Dielectric(cosine, relativeIor);
    w.reflection = vec3(s.transmission * f);
    w.refraction = s.transmission * (1.0f - f) * s.baseColor;
  }
  return w;
}
