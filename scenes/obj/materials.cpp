#include "scenes/obj/materials.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/image_io.h"

namespace pb::obj {
namespace {

constexpr float kLargestIor = 5.0f;  // as of glTF's materials

// How light goes on, by the illumination model (Wavefront's "Object Files" appendix B1) or by Pm and Pr.
struct Optics {
  bool transmits, refracts, isMetal;
};
Optics opticsOf(const MtlMaterial& m) {
  const int illum = m.values.illum;
  const bool isPbr = m.has("Pm") || m.has("Pr");
  return {.transmits = illum == 4 || illum == 6 || illum == 7 || illum == 9,
          .refracts = illum == 6 || illum == 7,
          .isMetal = !isPbr && (illum == 3 || illum == 5 || illum == 8)};
}

Material twoSided(Material material) {
  material.doubleSided = true;
  return material;
}

glm::vec3 vector(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

// Blender's exporter and importer take Ns for 1000 (1 - roughness)^2.
float roughnessOf(const MtlMaterial& m, float otherwise) {
  if (m.has("Pr")) return glm::clamp(m.values.roughness, 0.0f, 1.0f);
  if (m.has("Ns")) return 1.0f - std::sqrt(glm::clamp(m.values.shininess / 1000.0f, 0.0f, 1.0f));
  return otherwise;
}

// A Ks of 0.5 is what Blender writes for a dielectric of index 1.5.
float coatOf(const MtlMaterial& m) {
  const bool hasHighlights = !m.has("illum") || m.values.illum >= 2;
  const glm::vec3 ks = vector(m.values.specular);
  return hasHighlights ? glm::clamp(2.0f * (ks.x + ks.y + ks.z) / 3.0f, 0.0f, 1.0f) : 0.0f;
}

void setKind(Material& material) {
  shading::MaterialConstants& c = material.constants;
  if (c.factors.x == 1.0f && shading::ggxAlpha(c.factors.y) == 0.0f)
    c.kind.x = shading::kSurfaceMirror;
  else if (c.factors.x > 0.0f || c.specular.w > 0.0f)
    c.kind.x = shading::kSurfaceGlossy;
  material.isSpecularDominant = c.factors.x > 0.5f && c.factors.y < kSmoothRoughness;
}

void addCoverage(const MtlMaterial& m, Material& material) {
  const bool isTextured = !m.values.alpha_texname.empty() && m.values.alpha_texname == m.values.diffuse_texname;
  material.constants.baseColor.w = glm::clamp(m.values.dissolve, 0.0f, 1.0f);
  if (isTextured || material.constants.baseColor.w < 1.0f) material.constants.alpha.x = shading::kAlphaBlend;
}

}  // namespace

Materials::Materials(MtlMaterials source, std::filesystem::path folder, Scene& scene)
    : source_(std::move(source)), folder_(std::move(folder)), scene_(scene) {}

int Materials::indexOf(const std::string& name, const Bounds& bounds) {
  const auto [found, isNew] = indices_.try_emplace(name, static_cast<int>(scene_.materials.size()));
  if (!isNew) return found->second;
  scene_.materials.push_back(make(name, bounds));
  return found->second;
}

Material Materials::make(const std::string& name, const Bounds& bounds) {
  const auto found = source_.find(name);
  if (found == source_.end()) {
    if (!name.empty()) warn(name, "is in none of the file's libraries, grey stands for it");
    return twoSided(makeDiffuseMaterial(name.empty() ? "default" : name, glm::vec3(0.8f)));
  }
  const MtlMaterial& m = found->second;
  Material material = opticsOf(m).transmits ? makeGlass(name, m, bounds) : makeOpaque(name, m);
  material.constants.emission = glm::vec4(glm::max(vector(m.values.emission), glm::vec3(0.0f)), 1.0f);
  warnOfIgnored(name, m);
  return material;
}

glm::vec3 Materials::reflectance(const std::string& name, const char* statement, const float (&v)[3]) {
  const glm::vec3 value = vector(v), cut = glm::clamp(value, glm::vec3(0.0f), glm::vec3(1.0f));
  if (cut != value) warn(name, fmt::format("{} is from 0 to 1, what exceeds that is cut", statement));
  return cut;
}

Material Materials::makeGlass(const std::string& name, const MtlMaterial& m, const Bounds& bounds) {
  const bool refracts = opticsOf(m).refracts;
  const float ior = m.has("Ni") && m.values.ior > 1.0f ? std::min(m.values.ior, kLargestIor) : 1.5f;
  const glm::vec3 size = bounds.extent();
  Material material = makeGlassMaterial(name, ior, refracts ? std::min({size.x, size.y, size.z}) : 0.0f);
  material.constants.factors.y = roughnessOf(m, 0.0f);
  if (m.has("Tf")) material.constants.baseColor = glm::vec4(reflectance(name, "Tf", m.values.transmittance), 1.0f);
  material.doubleSided = !refracts;
  return material;
}

Material Materials::makeOpaque(const std::string& name, const MtlMaterial& m) {
  Material material = twoSided(makeDiffuseMaterial(name, baseColor(name, m)));
  shading::MaterialConstants& c = material.constants;
  const bool isPbr = m.has("Pm") || m.has("Pr"), isMetal = opticsOf(m).isMetal;
  c.factors.x = isMetal ? 1.0f : isPbr ? glm::clamp(m.values.metallic, 0.0f, 1.0f) : 0.0f;
  c.factors.y = roughnessOf(m, isMetal ? 0.0f : 0.5f);
  c.specular.w = isPbr ? 1.0f : coatOf(m);
  setKind(material);
  if (!m.values.diffuse_texname.empty()) addTexture(m.values, material);
  addCoverage(m, material);
  return material;
}

glm::vec3 Materials::baseColor(const std::string& name, const MtlMaterial& m) {
  const glm::vec3 ks = reflectance(name, "Ks", m.values.specular);
  if (opticsOf(m).isMetal && ks != glm::vec3(0.0f)) return ks;
  if (m.has("Kd")) return reflectance(name, "Kd", m.values.diffuse);
  return glm::vec3(m.values.diffuse_texname.empty() ? 0.8f : 1.0f);
}

// Texture coordinates were turned upside down: scale and offset, too.
void Materials::addTexture(const tinyobj::material_t& values, Material& material) {
  const tinyobj::texture_option_t& options = values.diffuse_texopt;
  const glm::vec2 scale(options.scale[0], options.scale[1]);
  shading::TextureSlot& slot = material.constants.baseColorSlot;
  slot.matrix = {scale.x, 0.0f, 0.0f, scale.y};
  slot.offset = {options.origin_offset[0], 1.0f - scale.y - options.origin_offset[1], 0.0f, 1.0f};
  const float wrap = options.clamp ? shading::kWrapClamp : shading::kWrapRepeat;
  slot.sampler_ = {wrap, wrap, shading::kFilterLinear, shading::kFilterLinearMipLinear};
  material.baseColorTexture = textureOf(values.diffuse_texname);
}

int Materials::textureOf(std::string file) {
  std::ranges::replace(file, '\\', '/');
  const auto [found, isNew] = textures_.try_emplace(file, static_cast<int>(scene_.textures.size()));
  if (!isNew) return found->second;
  LoadedImage image = readImage((folder_ / file).string());
  if (image.encoding == Encoding::srgb)
    for (glm::vec4& p : image.pixels) p = {linearFromSrgb(p.x), linearFromSrgb(p.y), linearFromSrgb(p.z), p.w};
  scene_.textures.push_back(makeTexture(file, std::move(image.pixels)));
  return found->second;
}

void Materials::warnOfIgnored(const std::string& name, const MtlMaterial& m) {
  for (const char* statement : {"map_Ks", "map_Ns", "map_Ke", "map_Pr", "map_Pm", "map_Bump", "map_bump", "bump",
                                "norm", "disp", "refl", "Pc", "Ps", "aniso"})
    if (m.has(statement)) warn(name, fmt::format("{} is ignored", statement));
  if (m.has("map_d") && m.values.alpha_texname != m.values.diffuse_texname)
    warn(name, "map_d is ignored: it is not the image of map_Kd");
}

void Materials::warn(const std::string& material, const std::string& what) {
  scene_.warnings.push_back(fmt::format("material '{}': {}", material, what));
}

}  // namespace pb::obj
