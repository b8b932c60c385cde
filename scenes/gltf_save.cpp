#include "scenes/gltf_save.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "scenes/files.h"
#include "scenes/gltf/document.h"
#include "scenes/gltf/extras.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

using nlohmann::json;

template <class Vector>
json arrayOf(const Vector& v, int components) {
  json array = json::array();
  for (int i = 0; i < components; ++i) array.push_back(v[i]);
  return array;
}

// c = factor * scale with factor in [0,1]: scale is a power of two, so that both operations are exact.
struct ScaledColor {
  glm::vec3 factor;
  float scale;
};
ScaledColor scaledColor(const glm::vec3& c) {
  const float largest = std::max({c.x, c.y, c.z});
  const float scale = largest > 1.0f ? std::exp2(std::ceil(std::log2(largest))) : 1.0f;
  return {c / scale, scale};
}

// Writes one scene. Members of the JSON are appended as they are needed, each shared thing once.
class Writer {
 public:
  explicit Writer(const Scene& scene) : scene_(scene) {}

  std::string write() {
    root_["asset"] = {{"version", "2.0"}, {"generator", "probebench"}};
    addMaterials();
    addNodes();
    addSkins();
    addInstances();
    addCameras();
    addLights();
    addTracks();
    json extras = gltf::sceneExtras(scene_, [this](std::string_view bytes) { return addBufferView(bytes); });
    root_["scenes"] = json::array({{{"name", scene_.name}, {"nodes", roots()}, {"extras", std::move(extras)}}});
    root_["scene"] = 0;
    if (!binary_.empty()) root_["buffers"] = json::array({{{"byteLength", binary_.size()}}});
    if (!extensions_.empty()) root_["extensionsUsed"] = extensions_;
    return gltf::packGlb(root_, binary_);
  }

 private:
  // Appends to one of the root's arrays; returns the new index.
  int append(const char* section, json value) {
    json& array = root_[section];
    array.push_back(std::move(value));
    return static_cast<int>(array.size()) - 1;
  }

  json& nodeAt(int index) { return root_["nodes"][static_cast<std::size_t>(index)]; }

  json& extension(json& owner, const char* name) {
    extensions_.insert(name);
    json& members = owner["extensions"][name];
    if (members.is_null()) members = json::object();
    return members;
  }

  int addBufferView(std::string_view bytes) {
    // Every type that glTF stores is aligned at multiples of 4.
    binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
    binary_ += bytes;
    return append("bufferViews", std::move(view));
  }

  template <class T>
  json accessorOf(const std::vector<T>& values, const char* type, int componentType) {
    const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return {{"bufferView", addBufferView(bytes)},
            {"componentType", componentType},
            {"count", values.size()},
            {"type", type}};
  }

  int addAccessor(const std::vector<float>& v) { return append("accessors", accessorOf(v, "SCALAR", kFloat)); }
  int addAccessor(const std::vector<glm::vec2>& v) { return append("accessors", accessorOf(v, "VEC2", kFloat)); }
  int addAccessor(const std::vector<glm::vec3>& v) { return append("accessors", accessorOf(v, "VEC3", kFloat)); }
  int addAccessor(const std::vector<glm::vec4>& v) { return append("accessors", accessorOf(v, "VEC4", kFloat)); }
  int addAccessor(const std::vector<glm::mat4>& v) { return append("accessors", accessorOf(v, "MAT4", kFloat)); }
  int addAccessor(const std::vector<glm::u16vec4>& v) {
    return append("accessors", accessorOf(v, "VEC4", kUnsignedShort));
  }
  int addAccessor(const std::vector<std::uint32_t>& v) {
    return append("accessors", accessorOf(v, "SCALAR", kUnsignedInt));
  }

  // glTF wants the bounds of positions and of key times.
  int withBounds(int accessor, const json& lower, const json& upper) {
    json& target = root_["accessors"][static_cast<std::size_t>(accessor)];
    target["min"] = lower;
    target["max"] = upper;
    return accessor;
  }

  int addSampler(const glm::vec4& settings) {
    static constexpr std::array kWraps = {10497, 33648, 33071};                   // in the order of kWrap*
    static constexpr std::array kFilters = {9728, 9729, 9984, 9985, 9986, 9987};  // in the order of kFilter*
    const auto wrap = [](float w) { return kWraps.at(static_cast<std::size_t>(w)); };
    const auto filter = [](float f) { return kFilters.at(static_cast<std::size_t>(f)); };
    json sampler = {{"wrapS", wrap(settings.x)},
                    {"wrapT", wrap(settings.y)},
                    {"magFilter", filter(settings.z)},
                    {"minFilter", filter(settings.w)}};
    const json& existing = root_["samplers"];
    const auto found = std::ranges::find(existing, sampler);
    if (found != existing.end()) return static_cast<int>(found - existing.begin());
    return append("samplers", std::move(sampler));
  }

  int addImage(int texture, bool srgb) {
    const auto [found, isNew] = images_.try_emplace({texture, srgb});
    if (!isNew) return found->second;
    const Texture& source = scene_.textures[static_cast<std::size_t>(texture)];
    ImageRgba encoded = source.levels.front();
    if (srgb)
      for (glm::vec4& p : encoded) p = {srgbFromLinear(p.x), srgbFromLinear(p.y), srgbFromLinear(p.z), p.w};
    json image = {{"name", source.name},
                  {"mimeType", "image/png"},
                  {"bufferView", addBufferView(encodePng(encoded, fitsEightBits(encoded) ? 8 : 16))}};
    return found->second = append("images", std::move(image));
  }

  // True for what was read from 8 bits: the sRGB curve and back is off by less than 1/50 of a step.
  static bool fitsEightBits(const ImageRgba& encoded) {
    return std::ranges::all_of(encoded, [](const glm::vec4& p) {
      const glm::vec4 steps = 255.0f * p;
      return glm::all(glm::lessThan(glm::abs(steps - glm::round(steps)), glm::vec4(0.02f)));
    });
  }

  json textureInfo(int texture, bool srgb, const shading::TextureSlot& slot) {
    json info = {
        {"index", append("textures", {{"source", addImage(texture, srgb)}, {"sampler", addSampler(slot.sampler_)}})}};
    if (slot.offset.z > 0.5f) info["texCoord"] = 1;
    addTextureTransform(info, slot);
    return info;
  }

  // The inverse of the loader's matrix: offset * rotation * scale.
  void addTextureTransform(json& info, const shading::TextureSlot& slot) {
    const glm::vec4& m = slot.matrix;
    if (m == glm::vec4(1.0f, 0.0f, 0.0f, 1.0f) && glm::vec2(slot.offset) == glm::vec2(0.0f)) return;
    json& transform = extension(info, "KHR_texture_transform");
    transform["offset"] = {slot.offset.x, slot.offset.y};
    // A mirrored matrix has a negative scale of v.
    const float scaleV = std::copysign(std::hypot(m.z, m.w), m.x * m.w - m.y * m.z);
    transform["scale"] = {std::hypot(m.x, m.y), scaleV};
    if (m.y != 0.0f || m.x < 0.0f) transform["rotation"] = std::atan2(-m.y, m.x);
  }

  void addMaterials() {
    for (const Material& material : scene_.materials) append("materials", materialOf(material));
  }

  json materialOf(const Material& material) {
    const shading::MaterialConstants& c = material.constants;
    json result = {{"name", material.name}, {"doubleSided", material.doubleSided}};
    json& pbr = result["pbrMetallicRoughness"];
    pbr = {{"baseColorFactor", arrayOf(c.baseColor, 4)},
           {"metallicFactor", c.factors.x},
           {"roughnessFactor", c.factors.y}};
    if (material.baseColorTexture >= 0)
      pbr["baseColorTexture"] = textureInfo(material.baseColorTexture, true, c.baseColorSlot);
    if (material.metallicRoughnessTexture >= 0)
      pbr["metallicRoughnessTexture"] = textureInfo(material.metallicRoughnessTexture, false, c.metallicRoughnessSlot);
    if (material.normalTexture >= 0) {
      result["normalTexture"] = textureInfo(material.normalTexture, false, c.normalSlot);
      result["normalTexture"]["scale"] = c.emission.w;
    }
    if (material.occlusionTexture >= 0) {
      result["occlusionTexture"] = textureInfo(material.occlusionTexture, false, c.occlusionSlot);
      result["occlusionTexture"]["strength"] = c.factors.z;
    }
    if (material.emissionTexture >= 0)
      result["emissiveTexture"] = textureInfo(material.emissionTexture, true, c.emissionSlot);
    const ScaledColor emission = scaledColor(glm::vec3(c.emission));
    result["emissiveFactor"] = arrayOf(emission.factor, 3);
    if (emission.scale != 1.0f)
      extension(result, "KHR_materials_emissive_strength")["emissiveStrength"] = emission.scale;
    addAlphaMode(c.alpha, result);
    addMaterialExtensions(material, result);
    if (json extras = gltf::materialExtras(material); !extras.is_null()) result["extras"] = std::move(extras);
    return result;
  }

  static void addAlphaMode(const glm::vec4& alpha, json& result) {
    static constexpr std::array kModes = {"OPAQUE", "MASK", "BLEND"};  // in the order of kAlpha*
    result["alphaMode"] = kModes.at(static_cast<std::size_t>(alpha.x));
    if (alpha.x == shading::kAlphaMask) result["alphaCutoff"] = alpha.y;
  }

  void addMaterialExtensions(const Material& material, json& result) {
    const shading::MaterialConstants& c = material.constants;
    if (c.kind.x == shading::kSurfaceUnlit) extension(result, "KHR_materials_unlit");
    if (c.kind.y != 1.5f) extension(result, "KHR_materials_ior")["ior"] = c.kind.y;
    if (c.factors.w > 0.0f) extension(result, "KHR_materials_transmission")["transmissionFactor"] = c.factors.w;
    if (c.kind.w > 0.0f) extension(result, "KHR_materials_dispersion")["dispersion"] = c.kind.w;
    if (c.specular != glm::vec4(1.0f))
      extension(result, "KHR_materials_specular") = {{"specularFactor", c.specular.w},
                                                     {"specularColorFactor", arrayOf(glm::vec3(c.specular), 3)}};
    if (c.kind.z > 0.0f || std::isfinite(material.attenuationDistance)) {
      json& volume = extension(result, "KHR_materials_volume");
      volume = {{"thicknessFactor", c.kind.z}, {"attenuationColor", arrayOf(material.attenuationColor, 3)}};
      if (std::isfinite(material.attenuationDistance)) volume["attenuationDistance"] = material.attenuationDistance;
    }
  }

  void addNodes() {
    for (std::size_t n = 0; n < scene_.nodes.size(); ++n) {
      const int index = append("nodes", nodeOf(scene_.nodes[n]));
      if (scene_.nodes[n].parent >= 0) nodeAt(scene_.nodes[n].parent)["children"].push_back(index);
    }
  }

  static json nodeOf(const Node& node) {
    json result = {{"name", node.name}};
    if (node.matrix) {
      result["matrix"] = arrayOf(glm::value_ptr(*node.matrix), 16);
    } else {
      const glm::quat& q = node.rotation;
      result["translation"] = arrayOf(node.translation, 3);
      result["rotation"] = {q.x, q.y, q.z, q.w};
      result["scale"] = arrayOf(node.scale, 3);
    }
    if (!node.morphWeights.empty()) result["weights"] = node.morphWeights;
    if (node.skin >= 0) result["skin"] = node.skin;
    if (json extras = gltf::nodeExtras(node); !extras.is_null()) result["extras"] = std::move(extras);
    return result;
  }

  json roots() const {
    json result = json::array();
    for (std::size_t n = 0; n < scene_.nodes.size(); ++n)
      if (scene_.nodes[n].parent < 0) result.push_back(n);
    return result;
  }

  json attributesOf(const std::shared_ptr<const Mesh>& mesh) {
    const auto [found, isNew] = attributes_.try_emplace(mesh.get());
    if (!isNew) return found->second;
    json attributes = {{"POSITION", withBounds(addAccessor(mesh->positions), arrayOf(mesh->bounds.lower, 3),
                                               arrayOf(mesh->bounds.upper, 3))}};
    // Flat normals follow a deformation in another way than given ones: none are written, so that they are computed.
    const bool mayDeform = !mesh->targets.empty() || !mesh->joints.empty();
    const bool hasNormals = !(mayDeform && mesh->hasFlatNormals);
    if (hasNormals) attributes["NORMAL"] = addAccessor(mesh->normals);
    if (hasNormals && !mesh->tangents.empty()) attributes["TANGENT"] = addAccessor(mesh->tangents);
    if (!mesh->uvs[0].empty()) attributes["TEXCOORD_0"] = addAccessor(mesh->uvs[0]);
    if (!mesh->uvs[1].empty()) attributes["TEXCOORD_1"] = addAccessor(mesh->uvs[1]);
    if (!mesh->colors.empty()) attributes["COLOR_0"] = addAccessor(mesh->colors);
    if (!mesh->joints.empty()) {
      attributes["JOINTS_0"] = addAccessor(mesh->joints);
      attributes["WEIGHTS_0"] = addAccessor(mesh->jointWeights);
    }
    for (const MorphTarget& target : mesh->targets) targets_[mesh.get()].push_back(targetOf(target));
    indices_[mesh.get()] = addAccessor(mesh->indices);
    return found->second = attributes;
  }

  int addDeltas(const std::vector<glm::vec3>& deltas) {
    Bounds bounds;
    for (const glm::vec3& d : deltas) bounds.include(d);
    return withBounds(addAccessor(deltas), arrayOf(bounds.lower, 3), arrayOf(bounds.upper, 3));
  }

  json targetOf(const MorphTarget& target) {
    json result = json::object();
    if (!target.positions.empty()) result["POSITION"] = addDeltas(target.positions);
    if (!target.normals.empty()) result["NORMAL"] = addDeltas(target.normals);
    if (!target.tangents.empty()) result["TANGENT"] = addDeltas(target.tangents);
    return result;
  }

  void addSkins() {
    for (const Skin& skin : scene_.skins)
      append("skins", {{"name", skin.name},
                       {"joints", skin.joints},
                       {"inverseBindMatrices", addAccessor(skin.inverseBindMatrices)}});
  }

  // The instances of a node become the primitives of its mesh.
  void addInstances() {
    std::map<int, json> primitives;
    std::map<int, std::string> names;
    for (const Instance& instance : scene_.instances) {
      json primitive = {{"attributes", attributesOf(instance.mesh)}, {"material", instance.material}};
      primitive["indices"] = indices_.at(instance.mesh.get());
      if (!instance.mesh->targets.empty()) primitive["targets"] = targets_.at(instance.mesh.get());
      primitives[instance.node].push_back(std::move(primitive));
      names.try_emplace(instance.node, instance.mesh->name);
    }
    for (auto& [node, list] : primitives)
      nodeAt(node)["mesh"] = append("meshes", {{"name", names[node]}, {"primitives", std::move(list)}});
  }

  // The node itself, or a new child of it if it holds such a thing already: glTF allows one a node.
  int nodeFor(int node, bool taken) {
    if (!taken) return node;
    const int child = append("nodes", {{"name", nodeAt(node)["name"]}});
    nodeAt(node)["children"].push_back(child);
    return child;
  }

  void addCameras() {
    for (const Camera& camera : scene_.cameras) {
      json perspective = {{"yfov", camera.verticalFov}, {"znear", camera.zNear}};
      const int index =
          append("cameras", {{"name", camera.name}, {"type", "perspective"}, {"perspective", std::move(perspective)}});
      nodeAt(nodeFor(camera.node, nodeAt(camera.node).contains("camera")))["camera"] = index;
    }
  }

  void addLights() {
    constexpr std::string_view kName = "KHR_lights_punctual";
    for (const PunctualLight& light : scene_.lights) {
      json& lights = extension(root_, kName.data())["lights"];
      lights.push_back(lightOf(light));
      const auto index = lights.size() - 1;
      const json& node = nodeAt(light.node);
      const bool taken = node.contains("extensions") && node["extensions"].contains(kName);
      extension(nodeAt(nodeFor(light.node, taken)), kName.data())["light"] = index;
    }
  }

  static json lightOf(const PunctualLight& light) {
    const ScaledColor intensity = scaledColor(light.intensity);
    json result = {{"color", arrayOf(intensity.factor, 3)}, {"intensity", intensity.scale}, {"type", "directional"}};
    if (light.kind == shading::kLightPoint) result["type"] = "point";
    if (light.kind == shading::kLightSpot) {
      result["type"] = "spot";
      result["spot"] = {{"innerConeAngle", light.innerConeAngle}, {"outerConeAngle", light.outerConeAngle}};
    }
    if (light.range > 0.0f) result["range"] = light.range;
    return result;
  }

  void addTracks() {
    if (scene_.tracks.empty()) return;
    json channels = json::array(), samplers = json::array();
    for (const Track& track : scene_.tracks) {
      static constexpr std::array kPaths = {"translation", "rotation", "scale", "weights"};
      channels.push_back(
          {{"sampler", samplers.size()},
           {"target", {{"node", track.node}, {"path", kPaths.at(static_cast<std::size_t>(track.target))}}}});
      samplers.push_back(samplerOf(track));
    }
    append("animations", {{"name", scene_.name}, {"channels", std::move(channels)}, {"samplers", std::move(samplers)}});
  }

  json samplerOf(const Track& track) {
    static constexpr std::array kNames = {"STEP", "LINEAR", "CUBICSPLINE"};
    const auto output = [&] {
      if (track.target == TrackTarget::morphWeights) return addAccessor(track.weights);
      if (track.target == TrackTarget::rotation) return addAccessor(track.values);
      return addAccessor(std::vector<glm::vec3>(track.values.begin(), track.values.end()));
    };
    return {{"input", withBounds(addAccessor(track.timesSeconds), json::array({track.timesSeconds.front()}),
                                 json::array({track.timesSeconds.back()}))},
            {"output", output()},
            {"interpolation", kNames.at(static_cast<std::size_t>(track.interpolation))}};
  }

  static constexpr int kUnsignedShort = 5123;
  static constexpr int kUnsignedInt = 5125;
  static constexpr int kFloat = 5126;

  const Scene& scene_;
  json root_;
  std::string binary_;
  std::set<std::string> extensions_;
  std::map<std::pair<int, bool>, int> images_;  // by texture and whether encoded as sRGB
  std::map<const Mesh*, json> attributes_;
  std::map<const Mesh*, int> indices_;
  std::map<const Mesh*, json> targets_;
};

}  // namespace

void saveGlb(const Scene& scene, const std::string& path) { writeFileAtomically(path, Writer(scene).write()); }

}  // namespace pb
