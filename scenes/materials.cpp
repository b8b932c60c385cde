// Textures and the materials that built-in scenes are made of.
#include <algorithm>
#include <glm/exponential.hpp>
#include <utility>

#include "scenes/scene.h"

namespace pb {
namespace {

// Box filter; odd sizes are covered by weighting the source texels by their overlap with the target texel.
ImageRgba halved(const ImageRgba& source) {
  ImageRgba target(std::max(1, source.width() / 2), std::max(1, source.height() / 2));
  const double stepX = static_cast<double>(source.width()) / target.width();
  const double stepY = static_cast<double>(source.height()) / target.height();
  for (int y = 0; y < target.height(); ++y)
    for (int x = 0; x < target.width(); ++x) {
      const double x0 = x * stepX, x1 = x0 + stepX, y0 = y * stepY, y1 = y0 + stepY;
      glm::dvec4 sum(0.0);
      for (int sy = static_cast<int>(y0); sy < source.height() && sy < y1; ++sy)
        for (int sx = static_cast<int>(x0); sx < source.width() && sx < x1; ++sx) {
          const double overlap =
              (std::min(x1, sx + 1.0) - std::max(x0, double(sx))) * (std::min(y1, sy + 1.0) - std::max(y0, double(sy)));
          sum += overlap * glm::dvec4(source(sx, sy));
        }
      target(x, y) = glm::vec4(sum / (stepX * stepY));
    }
  return target;
}

shading::TextureSlot emptySlot() {
  shading::TextureSlot slot;
  slot.matrix = {1.0f, 0.0f, 0.0f, 1.0f};
  slot.offset = glm::vec4(0.0f);
  slot.sampler_ = {shading::kWrapRepeat, shading::kWrapRepeat, shading::kFilterLinear, shading::kFilterLinearMipLinear};
  return slot;
}

}  // namespace

Texture makeTexture(std::string name, ImageRgba level0) {
  Texture texture;
  texture.name = std::move(name);
  texture.levels.push_back(std::move(level0));
  while (texture.levels.back().width() > 1 || texture.levels.back().height() > 1)
    texture.levels.push_back(halved(texture.levels.back()));
  return texture;
}

Material makeDiffuseMaterial(std::string name, glm::vec3 albedo) {
  Material material;
  material.name = std::move(name);
  shading::MaterialConstants& c = material.constants;
  c.baseColor = glm::vec4(albedo, 1.0f);
  c.emission = {0.0f, 0.0f, 0.0f, 1.0f};
  c.factors = {0.0f, 1.0f, 1.0f, 0.0f};
  c.kind = {shading::kSurfaceDiffuse, 1.5f, 0.0f, 0.0f};
  c.specular = {1.0f, 1.0f, 1.0f, 0.0f};
  c.absorption = c.conductorEta = c.conductorK = glm::vec4(0.0f);
  c.alpha = {shading::kAlphaOpaque, 0.5f, 0.0f, 0.0f};
  c.baseColorSlot = c.metallicRoughnessSlot = c.normalSlot = c.emissionSlot = c.occlusionSlot = emptySlot();
  return material;
}

Material makeMirrorMaterial(std::string name, glm::vec3 f0) {
  Material material = makeDiffuseMaterial(std::move(name), f0);
  material.constants.factors.x = 1.0f;
  material.constants.factors.y = 0.0f;
  material.constants.kind.x = shading::kSurfaceMirror;
  material.isSpecularDominant = true;
  return material;
}

Material makeMetalMaterial(std::string name, glm::vec3 eta, glm::vec3 k, float roughness) {
  Material material = makeMirrorMaterial(std::move(name), shading::F_Conductor(1.0f, eta, k));
  shading::MaterialConstants& c = material.constants;
  c.conductorEta = glm::vec4(eta, 1.0f);
  c.conductorK = glm::vec4(k, 0.0f);
  c.factors.y = roughness;
  if (shading::ggxAlpha(roughness) > 0.0f) c.kind.x = shading::kSurfaceGlossy;
  material.isSpecularDominant = roughness < kSmoothRoughness;
  return material;
}

Material makeGlassMaterial(std::string name, float ior, float thickness) {
  Material material = makeDiffuseMaterial(std::move(name), glm::vec3(1.0f));
  shading::MaterialConstants& c = material.constants;
  c.kind = {shading::kSurfaceGlass, ior, thickness, 0.0f};
  c.factors = {0.0f, 0.0f, 1.0f, 1.0f};
  c.specular.w = 1.0f;
  material.isSpecularDominant = true;
  return material;
}

void setAttenuation(Material& material, glm::vec3 color, float distance) {
  material.attenuationColor = color;
  material.attenuationDistance = distance;
  // Beer-Lambert: exp(-absorption distance) = color.
  // A difference, because a sign would make a negative zero of white.
  const glm::vec3 absorption = (0.0f - glm::log(glm::max(color, glm::vec3(1e-6f)))) / distance;
  material.constants.absorption = glm::vec4(absorption, 0.0f);
}

bool hasSpecularLobe(const Material& material) {
  const float kind = material.constants.kind.x;
  return kind == shading::kSurfaceMirror || kind == shading::kSurfaceGlass || kind == shading::kSurfaceGlossy;
}

}  // namespace pb
