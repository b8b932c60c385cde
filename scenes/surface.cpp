// What the points of surfaces are and send out by themselves: the functions of scenes/snapshot.h about hit points.
#include <algorithm>
#include <glm/geometric.hpp>

#include "scenes/dfg_table.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

const Texture* textureAt(const Scene& scene, int texture) {
  return texture < 0 ? nullptr : &scene.textures[static_cast<std::size_t>(texture)];
}

// Values of the slot's texture, white without one.
shading::vec4 sampleSlot(const Texture* texture, const shading::TextureSlot& slot, const SurfaceAttributes& a) {
  if (texture == nullptr) return shading::vec4(1.0f);
  const shading::sampler2D image{&texture->levels};
  const shading::vec2 uv = shading::textureCoordinates(slot.matrix, slot.offset, a.uv0, a.uv1);
  const float lod = shading::coneLod(a.coneWidth, a.cosine, a.uvPerMetre, shading::textureSize(image, 0), slot.matrix);
  return shading::sampleTexture(image, uv, lod, slot.sampler_);
}

}  // namespace

shading::Surface readSurface(const Snapshot& snapshot, const Material& material, const SurfaceAttributes& a) {
  const Scene& scene = *snapshot.scene;
  const shading::MaterialConstants& c = material.constants;
  shading::vec3 normal = a.normal;
  if (material.normalTexture >= 0 && a.tangent.w != 0.0f)
    normal = shading::mappedNormal(a.normal, a.tangent,
                                   sampleSlot(textureAt(scene, material.normalTexture), c.normalSlot, a), c.emission.w);
  return shading::makeSurface(
      c, a.position, normal, a.color, sampleSlot(textureAt(scene, material.baseColorTexture), c.baseColorSlot, a),
      sampleSlot(textureAt(scene, material.metallicRoughnessTexture), c.metallicRoughnessSlot, a),
      sampleSlot(emissionTextureOf(snapshot, material), c.emissionSlot, a),
      sampleSlot(textureAt(scene, material.occlusionTexture), c.occlusionSlot, a));
}

const Texture* emissionTextureOf(const Snapshot& snapshot, const Material& material) {
  if (material.screen >= 0) return &snapshot.screens[static_cast<std::size_t>(material.screen)];
  return textureAt(*snapshot.scene, material.emissionTexture);
}

glm::vec3 meanEmission(const Snapshot& snapshot, const Material& material) {
  const Texture* texture = emissionTextureOf(snapshot, material);
  const glm::vec3 factor(material.constants.emission);
  // A texture's last level is one texel, its mean.
  return texture == nullptr ? factor : factor * glm::vec3(texture->levels.back()(0, 0));
}

std::uint32_t baseColorTexelId(const Scene& scene, const Material& material, const SurfaceAttributes& a) {
  if (material.baseColorTexture < 0) return 0;
  const shading::TextureSlot& slot = material.constants.baseColorSlot;
  const shading::sampler2D image{&scene.textures[static_cast<std::size_t>(material.baseColorTexture)].levels};
  const shading::vec2 uv = shading::textureCoordinates(slot.matrix, slot.offset, a.uv0, a.uv1);
  const float lod = shading::coneLod(a.coneWidth, a.cosine, a.uvPerMetre, shading::textureSize(image, 0), slot.matrix);
  return static_cast<std::uint32_t>(shading::nearestTexelId(image, uv, lod, slot.sampler_));
}

glm::vec3 coatAlbedo(const shading::Surface& surface, const glm::vec3& toViewer) {
  if (surface.kind != shading::kSurfaceGlossy && surface.kind != shading::kSurfaceGlass) return glm::vec3(0.0f);
  const shading::sampler2D table{&dfgTable(shading::kGeometrySmithCorrelated).levels};
  const float NoV = std::max(glm::dot(surface.normal, toViewer), 0.0f);
  return shading::coatAlbedo(surface, shading::surfaceDfg(surface, table, NoV));
}

glm::vec3 localRadiance(const Snapshot& snapshot, const shading::Surface& surface, const glm::vec3& toViewer) {
  glm::vec3 irradiance(0.0f);
  for (const shading::Light& light : snapshot.lights)
    irradiance += shading::lightIrradianceOn(light, surface.position, surface.normal);
  for (const shading::AreaLight& light : snapshot.areaLights)
    irradiance += shading::areaLightIrradiance(light, surface.position, surface.normal);
  return shading::localRadiance(surface, irradiance,
                                shading::ambientRadiance(snapshot.environment().ambient, surface.normal),
                                coatAlbedo(surface, toViewer));
}

}  // namespace pb
