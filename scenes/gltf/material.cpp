#include "scenes/gltf/material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "scenes/error.h"
#include "scenes/gltf/extras.h"
#include "scenes/gltf/validate.h"
#include "scenes/image_io.h"

namespace pb::gltf {
namespace {

using nlohmann::json;

// Of glass and clear plastics it is 1.3 to 2, of diamond 2.4, and of germanium, the highest, 4 in the infrared.
constexpr float kLargestIor = 5.0f;

// 20 over the Abbe number, which is 17 for the most dispersive glasses: this is an Abbe number of 2.
constexpr float kLargestDispersion = 10.0f;

enum class Content { color, data };  // colours are sRGB in integer formats, data is linear

// Members of a material's extension, with the defaults of the extension's specification.
class Extension {
 public:
  Extension(const json& owner, const char* name) {
    const auto extensions = owner.find("extensions");
    if (extensions == owner.end() || !extensions->contains(name)) return;
    members_ = &(*extensions)[name];
  }

  bool present() const { return members_ != nullptr; }
  bool has(const char* key) const { return present() && members_->contains(key); }
  const json& operator[](const char* key) const { return (*members_)[key]; }

  float number(const char* key, float otherwise) const { return has(key) ? (*members_)[key].get<float>() : otherwise; }

  glm::vec3 color(const char* key, glm::vec3 otherwise) const {
    if (!has(key)) return otherwise;
    const json& v = (*members_)[key];
    return {v[0].get<float>(), v[1].get<float>(), v[2].get<float>()};
  }

 private:
  const json* members_ = nullptr;
};

float wrapOf(int mode) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return shading::kWrapRepeat;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return shading::kWrapMirror;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return shading::kWrapClamp;
    default:
      throwInputError("texture wrap modes are 10497, 33071 and 33648, got {}", mode);
  }
}

// -1 is absence; the file leaves the choice to us then.
float filterOf(int filter, float otherwise) {
  switch (filter) {
    case -1:
      return otherwise;
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
      return shading::kFilterNearest;
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
      return shading::kFilterLinear;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
      return shading::kFilterNearestMipNearest;
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
      return shading::kFilterLinearMipNearest;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
      return shading::kFilterNearestMipLinear;
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
      return shading::kFilterLinearMipLinear;
    default:
      throwInputError("texture filters are 9728, 9729 and 9984 to 9987, got {}", filter);
  }
}

glm::vec4 samplerSettings(const tinygltf::Model& model, const tinygltf::Texture& texture) {
  const tinygltf::Sampler sampler =
      texture.sampler >= 0 ? model.samplers.at(static_cast<std::size_t>(texture.sampler)) : tinygltf::Sampler();
  const float magnification = filterOf(sampler.magFilter, shading::kFilterLinear);
  return {wrapOf(sampler.wrapS), wrapOf(sampler.wrapT),
          magnification == shading::kFilterNearest ? shading::kFilterNearest : shading::kFilterLinear,
          filterOf(sampler.minFilter, shading::kFilterLinearMipLinear)};
}

float finiteNumber(const json& value, const char* what) {
  if (!value.is_number() || !std::isfinite(value.get<float>()))
    throwInputError("KHR_texture_transform wants finite numbers, got {} {}", what, value.dump());
  return value.get<float>();
}

glm::vec2 finitePair(const json& value, const char* what) {
  if (!value.is_array() || value.size() != 2)
    throwInputError("KHR_texture_transform wants a pair of numbers, got {} {}", what, value.dump());
  return {finiteNumber(value[0], what), finiteNumber(value[1], what)};
}

// Offset * rotation * scale; a positive rotation turns texture coordinates counter-clockwise as seen with v pointing
// down, so that its sine stands with the opposite sign of the usual matrix.
void applyTextureTransform(const Extension& transform, shading::TextureSlot& slot, int& uvSet) {
  if (!transform.present()) return;
  const glm::vec2 offset = transform.has("offset") ? finitePair(transform["offset"], "offset") : glm::vec2(0.0f);
  const glm::vec2 scale = transform.has("scale") ? finitePair(transform["scale"], "scale") : glm::vec2(1.0f);
  const float angle = transform.has("rotation") ? finiteNumber(transform["rotation"], "rotation") : 0.0f;
  const float c = std::cos(angle), s = std::sin(angle);
  // A difference, because a sign would make a negative zero where there is no rotation.
  slot.matrix = {c * scale.x, 0.0f - s * scale.x, s * scale.y, c * scale.y};
  slot.offset = {offset, 0.0f, 0.0f};
  if (transform.has("texCoord")) uvSet = static_cast<int>(finiteNumber(transform["texCoord"], "texCoord"));
}

// Textures by image and content, so that each is decoded once.
class TextureReader {
 public:
  TextureReader(const Document& document, std::vector<Texture>& textures) : document_(document), textures_(textures) {}

  int indexOf(const tinygltf::Texture& texture, int textureIndex, Content content) {
    if (texture.source < 0) throwInputError("textures/{} has no image in a supported format", textureIndex);
    const auto [found, isNew] = indices_.try_emplace({texture.source, content}, static_cast<int>(textures_.size()));
    if (isNew) textures_.push_back(decode(texture.source, content));
    return found->second;
  }

 private:
  Texture decode(int image, Content content) const {
    const json& description = document_.json["images"][static_cast<std::size_t>(image)];
    const std::string name = description.value("name", description.value("uri", fmt::format("image {}", image)));
    const std::string bytes = imageBytes(document_, image);
    LoadedImage loaded = readImage(std::as_bytes(std::span(bytes)), fmt::format("images/{}", image));
    if (content == Content::color && loaded.encoding == Encoding::srgb)
      for (glm::vec4& p : loaded.pixels) p = {linearFromSrgb(p.x), linearFromSrgb(p.y), linearFromSrgb(p.z), p.w};
    return makeTexture(name.starts_with("data:") ? fmt::format("image {}", image) : name, std::move(loaded.pixels));
  }

  const Document& document_;
  std::vector<Texture>& textures_;
  std::map<std::pair<int, Content>, int> indices_;
};

// One material at a time, with the place for its messages.
class MaterialReader {
 public:
  MaterialReader(const Document& document, std::size_t index, const std::string& place, TextureReader& textures,
                 Scene& scene)
      : document_(document),
        source_(document.model.materials[index]),
        json_(document.json["materials"][index]),
        textures_(textures),
        scene_(scene),
        place_(place) {
    material_ =
        makeDiffuseMaterial(source_.name.empty() ? fmt::format("material {}", index) : source_.name, glm::vec3(1.0f));
  }

  Material read() {
    readFactors();
    readAlpha();
    readTextures();
    readExtensions();
    if (json_.contains("extras")) readMaterialExtras(json_["extras"], place_, material_, scene_.warnings);
    classify();
    warnIgnored();
    return material_;
  }

 private:
  void warn(const std::string& what) { scene_.warnings.push_back(place_ + ": " + what); }

  void readFactors() {
    const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
    shading::MaterialConstants& c = material_.constants;
    for (int i = 0; i < 4; ++i) c.baseColor[i] = static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
    if (glm::any(glm::greaterThan(c.baseColor, glm::vec4(1.0f)))) {
      // Surfaces that reflect more than they receive would make light without end under global illumination.
      warn(fmt::format("base colours are at most 1, ({:.4g}, {:.4g}, {:.4g}, {:.4g}) is cut to that", c.baseColor.x,
                       c.baseColor.y, c.baseColor.z, c.baseColor.w));
      c.baseColor = glm::min(c.baseColor, glm::vec4(1.0f));
    }
    for (int i = 0; i < 3; ++i) c.emission[i] = static_cast<float>(source_.emissiveFactor[static_cast<std::size_t>(i)]);
    c.emission.w = static_cast<float>(source_.normalTexture.scale);
    c.factors = {pbr.metallicFactor, pbr.roughnessFactor, source_.occlusionTexture.strength, 0.0};
    material_.doubleSided = source_.doubleSided;
  }

  void readAlpha() {
    static const std::map<std::string, float> kModes = {
        {"OPAQUE", shading::kAlphaOpaque}, {"MASK", shading::kAlphaMask}, {"BLEND", shading::kAlphaBlend}};
    const auto mode = kModes.find(source_.alphaMode);
    if (mode == kModes.end()) throwInputError("alpha modes are OPAQUE, MASK and BLEND, got '{}'", source_.alphaMode);
    material_.constants.alpha = {mode->second, static_cast<float>(source_.alphaCutoff), 0.0f, 0.0f};
  }

  // Returns the texture's index in the scene, -1 for none, and completes the slot.
  int readSlot(int texture, int uvSet, const json& info, Content content, shading::TextureSlot& slot) {
    if (texture < 0) return -1;
    const tinygltf::Texture& source = document_.model.textures.at(static_cast<std::size_t>(texture));
    applyTextureTransform(Extension(info, "KHR_texture_transform"), slot, uvSet);
    if (uvSet < 0 || uvSet > 1) {
      warn(fmt::format("texture coordinates {} are not supported, 0 are used", uvSet));
      uvSet = 0;
    }
    slot.offset.z = static_cast<float>(uvSet);
    slot.offset.w = 1.0f;
    slot.sampler_ = samplerSettings(document_.model, source);
    return textures_.indexOf(source, texture, content);
  }

  void readTextures() {
    const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
    const json none = json::object();
    const auto infoAt = [&](const json& owner, const char* key) { return owner.value(key, none); };
    const json pbrJson = infoAt(json_, "pbrMetallicRoughness");
    const auto slot = [&](const auto& info, const json& owner, const char* key, Content content,
                          shading::TextureSlot& target) {
      return readSlot(info.index, info.texCoord, infoAt(owner, key), content, target);
    };
    shading::MaterialConstants& c = material_.constants;
    material_.baseColorTexture =
        slot(pbr.baseColorTexture, pbrJson, "baseColorTexture", Content::color, c.baseColorSlot);
    material_.metallicRoughnessTexture =
        slot(pbr.metallicRoughnessTexture, pbrJson, "metallicRoughnessTexture", Content::data, c.metallicRoughnessSlot);
    material_.normalTexture = slot(source_.normalTexture, json_, "normalTexture", Content::data, c.normalSlot);
    material_.emissionTexture = slot(source_.emissiveTexture, json_, "emissiveTexture", Content::color, c.emissionSlot);
    material_.occlusionTexture =
        slot(source_.occlusionTexture, json_, "occlusionTexture", Content::data, c.occlusionSlot);
  }

  void readExtensions() {
    shading::MaterialConstants& c = material_.constants;
    const float strength = Extension(json_, "KHR_materials_emissive_strength").number("emissiveStrength", 1.0f);
    c.emission = glm::vec4(strength * glm::vec3(c.emission), c.emission.w);
    c.factors.w = Extension(json_, "KHR_materials_transmission").number("transmissionFactor", 0.0f);
    c.kind.y = checkedIor(Extension(json_, "KHR_materials_ior").number("ior", 1.5f));
    const Extension specular(json_, "KHR_materials_specular");
    c.specular =
        glm::vec4(specular.color("specularColorFactor", glm::vec3(1.0f)), specular.number("specularFactor", 1.0f));
    const Extension volume(json_, "KHR_materials_volume");
    c.kind.z = volume.number("thicknessFactor", 0.0f);
    setAttenuation(material_, volume.color("attenuationColor", glm::vec3(1.0f)), attenuationDistance(volume));
    c.kind.w = dispersion(Extension(json_, "KHR_materials_dispersion").number("dispersion", 0.0f));
  }

  float checkedIor(float ior) {
    if (ior < 1.0f) {
      warn(fmt::format("indices of refraction below 1 are not supported, 1.5 stands for {}", ior));
      return 1.5f;
    }
    if (ior > kLargestIor) {
      warn(fmt::format("no transparent material has an index of refraction of {}, {} is used", ior, kLargestIor));
      return kLargestIor;
    }
    return ior;
  }

  float dispersion(float value) {
    if (value <= kLargestDispersion) return value;
    warn(fmt::format("no material has a dispersion of {}, {} is used", value, kLargestDispersion));
    return kLargestDispersion;
  }

  // Some exporters write 0 for no attenuation.
  float attenuationDistance(const Extension& volume) {
    constexpr float kNone = std::numeric_limits<float>::infinity();
    const float distance = volume.number("attenuationDistance", kNone);
    if (distance > 0.0f) return distance;
    warn("an attenuation distance of 0 is taken as none");
    return kNone;
  }

  // Mean of metallic (x) and roughness (y) over the texture.
  glm::vec2 meanMetallicRoughness() const {
    const glm::vec4& factors = material_.constants.factors;
    if (material_.metallicRoughnessTexture < 0) return glm::vec2(factors);
    // The last level is one texel: the mean.
    const auto& levels = scene_.textures[static_cast<std::size_t>(material_.metallicRoughnessTexture)].levels;
    const glm::vec4 mean = levels.back()(0, 0);
    return {factors.x * mean.z, factors.y * mean.y};
  }

  void classify() {
    shading::MaterialConstants& c = material_.constants;
    const glm::vec2 mean = meanMetallicRoughness();
    const bool textured = material_.metallicRoughnessTexture >= 0;
    material_.isSpecularDominant = (mean.x > 0.5f && mean.y < kSmoothRoughness) || c.factors.w > 0.5f;
    if (Extension(json_, "KHR_materials_unlit").present()) {
      c.kind.x = shading::kSurfaceUnlit;
      material_.isSpecularDominant = false;
    } else if (c.factors.w > 0.0f) {
      c.kind.x = shading::kSurfaceGlass;
    } else if (!textured && c.factors.x == 1.0f && shading::ggxAlpha(c.factors.y) == 0.0f) {
      c.kind.x = shading::kSurfaceMirror;
    } else if (c.factors.x > 0.0f || c.specular.w > 0.0f) {
      c.kind.x = shading::kSurfaceGlossy;
    }
  }

  void warnIgnored() {
    if (material_.constants.kind.x == shading::kSurfaceGlass && meanMetallicRoughness().x > 0.0f)
      warn("metallic is not rendered on a transmitting surface");
    for (const auto& [name, value] : source_.extensions)
      if (!isSupportedExtension(name)) warn("extension " + name + " is ignored");
    for (const auto& [extension, key] :
         {std::pair("KHR_materials_transmission", "transmissionTexture"),
          std::pair("KHR_materials_volume", "thicknessTexture"), std::pair("KHR_materials_specular", "specularTexture"),
          std::pair("KHR_materials_specular", "specularColorTexture")})
      if (Extension(json_, extension).has(key)) warn(fmt::format("{} is ignored", key));
  }

  const Document& document_;
  const tinygltf::Material& source_;
  const json& json_;
  TextureReader& textures_;
  Scene& scene_;
  std::string place_;
  Material material_;
};

// glTF 2.0, section 3.9.6: metallic 1 and roughness 1, so not a mirror.
Material defaultMaterial() {
  Material material = makeDiffuseMaterial("default", glm::vec3(1.0f));
  material.constants.factors.x = 1.0f;
  material.constants.kind.x = shading::kSurfaceGlossy;
  material.constants.specular.w = 1.0f;
  return material;
}

bool needsDefaultMaterial(const tinygltf::Model& model) {
  return std::ranges::any_of(model.meshes, [](const tinygltf::Mesh& mesh) {
    return std::ranges::any_of(mesh.primitives, [](const auto& primitive) { return primitive.material < 0; });
  });
}

}  // namespace

void readMaterials(const Document& document, Scene& scene) {
  TextureReader textures(document, scene.textures);
  for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
    const std::string place = "material " + label(document.model.materials[i].name, i);
    scene.materials.push_back(
        atPlace(place, [&] { return MaterialReader(document, i, place, textures, scene).read(); }));
  }
  if (!needsDefaultMaterial(document.model)) return;
  scene.materials.push_back(defaultMaterial());
  scene.warnings.emplace_back("primitives without material are rendered as glTF's default, white metal of roughness 1");
}

int materialIndex(const Document& document, const tinygltf::Primitive& primitive) {
  return primitive.material >= 0 ? primitive.material : static_cast<int>(document.model.materials.size());
}

}  // namespace pb::gltf
