#include "raster/plain_material.h"

namespace pb {
namespace {

// A texture's last level is one texel, its mean.
glm::vec4 meanTexel(const std::vector<Texture>& textures, int texture) {
  return texture < 0 ? glm::vec4(1.0f) : textures[static_cast<std::size_t>(texture)].levels.back()(0, 0);
}

}  // namespace

SurfaceVariant plainVariant(const SurfaceVariant& variant, const Mesh& mesh) {
  SurfaceVariant plain = variant;
  plain.textures = {};
  if (variant.coverage != shading::kAlphaOpaque) plain.textures.front() = variant.textures.front();
  plain.attributes = !mesh.colors.empty() || plain.textures.front().has_value();
  return plain;
}

shading::MaterialConstants plainConstants(const Scene& scene, const std::vector<Texture>& screens,
                                          const Material& material) {
  shading::MaterialConstants constants = material.constants;
  if (constants.alpha.x == shading::kAlphaOpaque)
    constants.baseColor *= meanTexel(scene.textures, material.baseColorTexture);
  const glm::vec4 metallicRoughness = meanTexel(scene.textures, material.metallicRoughnessTexture);
  constants.factors.x *= metallicRoughness.z;
  constants.factors.y *= metallicRoughness.y;
  const glm::vec4 emission =
      material.screen < 0 ? meanTexel(scene.textures, material.emissionTexture) : meanTexel(screens, material.screen);
  constants.emission *= glm::vec4(glm::vec3(emission), 1.0f);  // w scales normal maps
  return constants;
}

}  // namespace pb
