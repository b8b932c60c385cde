#include "scenes/gltf_load.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <new>
#include <set>
#include <utility>

#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/gltf/accessor.h"
#include "scenes/gltf/document.h"
#include "scenes/gltf/extras.h"
#include "scenes/gltf/material.h"
#include "scenes/gltf/mesh.h"
#include "scenes/gltf/validate.h"

namespace pb {
namespace {

using nlohmann::json;

glm::vec3 vec3Of(const std::vector<double>& v) { return glm::vec3(glm::make_vec3(v.data())); }

glm::vec4 unitQuaternion(glm::vec4 xyzw, const std::string& place) {
  const float length = glm::length(xyzw);
  if (!(length > 1e-6f)) throwInputError("{}: a rotation wants a quaternion of length 1, got one of {}", place, length);
  // Dividing what is unit already would change its last bits.
  return std::abs(length - 1.0f) < 1e-6f ? xyzw : xyzw / length;
}

glm::mat4 affineMatrix(const std::vector<double>& values, const std::string& place) {
  const glm::mat4 matrix(glm::make_mat4(values.data()));
  if (matrix[0].w != 0.0f || matrix[1].w != 0.0f || matrix[2].w != 0.0f || matrix[3].w != 1.0f)
    throwInputError("{}: a node's matrix is affine, got the last row {} {} {} {}", place, matrix[0].w, matrix[1].w,
                    matrix[2].w, matrix[3].w);
  return matrix;
}

const json& memberOrNull(const json& object, const char* key) {
  static const json kNull;
  const auto found = object.find(key);
  return found != object.end() ? *found : kNull;
}

// Builds a Scene from one document. The members are called once, in the order of load().
class SceneBuilder {
 public:
  explicit SceneBuilder(const gltf::Document& document) : document_(document), model_(document.model) {}

  Scene load(const std::optional<Environment>& environment) {
    chooseNodes();
    gltf::readMaterials(document_, scene_);
    for (std::size_t n = 0; n < model_.nodes.size(); ++n)
      if (nodeIndices_[n] >= 0) addContents(n);
    if (scene_.instances.empty()) throwInputError("the scene draws no triangle");
    for (const tinygltf::Animation& animation : model_.animations) addAnimation(animation);
    warnAboutExtensions();
    setEnvironment(environment);
    return std::move(scene_);
  }

 private:
  std::string placeOfNode(std::size_t n) const { return "node " + gltf::label(model_.nodes[n].name, n); }
  void warn(const std::string& sentence) { scene_.warnings.push_back(sentence); }

  // The scene that the file names, its first, or all nodes where it has none; -1 for none.
  int sceneIndex() const {
    if (model_.scenes.empty()) return -1;
    return std::max(model_.defaultScene, 0);
  }

  std::vector<int> parents() const {
    std::vector<int> result(model_.nodes.size(), -1);
    for (std::size_t n = 0; n < model_.nodes.size(); ++n)
      for (const int child : model_.nodes[n].children) result[static_cast<std::size_t>(child)] = static_cast<int>(n);
    return result;
  }

  // Scenes list roots; some exporters also list descendants, which then only repeat what their root says.
  std::vector<bool> nodesOfScene(const std::vector<int>& parent) const {
    const int scene = sceneIndex();
    if (scene < 0) return std::vector<bool>(model_.nodes.size(), true);
    std::vector<bool> chosen(model_.nodes.size(), false);
    std::vector<int> pending = model_.scenes[static_cast<std::size_t>(scene)].nodes;
    for (int& n : pending)
      while (parent[static_cast<std::size_t>(n)] >= 0) n = parent[static_cast<std::size_t>(n)];
    while (!pending.empty()) {
      const auto n = static_cast<std::size_t>(pending.back());
      pending.pop_back();
      if (chosen[n]) continue;
      chosen[n] = true;
      pending.insert(pending.end(), model_.nodes[n].children.begin(), model_.nodes[n].children.end());
    }
    return chosen;
  }

  // Adds the nodes of the scene, each after its ancestors.
  void chooseNodes() {
    const std::vector<int> parent = parents();
    const std::vector<bool> chosen = nodesOfScene(parent);
    nodeIndices_.assign(model_.nodes.size(), -1);
    for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
      std::vector<int> missing;
      for (int a = static_cast<int>(n); a >= 0 && chosen[n] && nodeIndices_[static_cast<std::size_t>(a)] < 0;
           a = parent[static_cast<std::size_t>(a)])
        missing.push_back(a);
      for (; !missing.empty(); missing.pop_back()) {
        const auto m = static_cast<std::size_t>(missing.back());
        addNode(m, parent[m] >= 0 ? nodeIndices_[static_cast<std::size_t>(parent[m])] : -1);
      }
    }
  }

  void addNode(std::size_t n, int parent) {
    const tinygltf::Node& source = model_.nodes[n];
    Node node;
    node.name = source.name.empty() ? fmt::format("node {}", n) : source.name;
    node.parent = parent;
    if (!source.matrix.empty()) node.matrix = affineMatrix(source.matrix, placeOfNode(n));
    if (!source.translation.empty()) node.translation = vec3Of(source.translation);
    if (!source.scale.empty()) node.scale = vec3Of(source.scale);
    if (!source.rotation.empty()) {
      const glm::vec4 q = unitQuaternion(glm::vec4(glm::make_vec4(source.rotation.data())), placeOfNode(n));
      node.rotation = {q.w, q.x, q.y, q.z};
    }
    node.probe = gltf::readProbeExtras(memberOrNull(document_.json["nodes"][n], "extras"),
                                       fmt::format("nodes/{}/extras/probe", n));
    nodeIndices_[n] = static_cast<int>(scene_.nodes.size());
    scene_.nodes.push_back(std::move(node));
  }

  void addContents(std::size_t n) {
    const tinygltf::Node& node = model_.nodes[n];
    if (node.skin >= 0) warn(placeOfNode(n) + ": its skin is ignored, the mesh keeps its bind pose");
    for (const auto& [name, value] : node.extensions)
      if (!gltf::isSupportedExtension(name)) warn(fmt::format("{}: extension {} is ignored", placeOfNode(n), name));
    if (node.mesh >= 0) addInstances(n, node.mesh);
    if (node.camera >= 0) addCamera(n, model_.cameras[static_cast<std::size_t>(node.camera)]);
    const auto extension = node.extensions.find("KHR_lights_punctual");
    if (extension != node.extensions.end())
      addLight(n, model_.lights.at(static_cast<std::size_t>(extension->second.Get("light").GetNumberAsInt())));
  }

  bool needsTangents(int material) const {
    return scene_.materials[static_cast<std::size_t>(material)].normalTexture >= 0;
  }

  // A mesh is made once for all primitives with the same data, also when they differ in material.
  std::shared_ptr<const Mesh> mesh(int meshIndex, int primitive, int material) {
    json data =
        document_
            .json["meshes"][static_cast<std::size_t>(meshIndex)]["primitives"][static_cast<std::size_t>(primitive)];
    data.erase("material");
    const bool tangents = needsTangents(material);
    const auto [found, isNew] = meshes_.try_emplace({std::move(data), tangents});
    if (isNew) found->second = gltf::readPrimitive(document_, meshIndex, primitive, tangents, scene_.warnings);
    return found->second;
  }

  void addInstances(std::size_t n, int meshIndex) {
    const std::vector<tinygltf::Primitive>& primitives = model_.meshes[static_cast<std::size_t>(meshIndex)].primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      Instance instance;
      instance.node = nodeIndices_[n];
      instance.name = scene_.nodes[static_cast<std::size_t>(instance.node)].name;
      if (primitives.size() > 1) instance.name += fmt::format("/{}", p);
      instance.material = gltf::materialIndex(document_, primitives[p]);
      instance.mesh = mesh(meshIndex, static_cast<int>(p), instance.material);
      if (instance.mesh != nullptr) scene_.instances.push_back(std::move(instance));
    }
  }

  void addCamera(std::size_t n, const tinygltf::Camera& source) {
    if (source.type != "perspective")
      return warn(fmt::format("{}: {} cameras are ignored", placeOfNode(n), source.type));
    if (!(source.perspective.yfov > 0.0))
      throwInputError("{}: a perspective camera wants a member 'perspective'", placeOfNode(n));
    Camera camera;
    camera.node = nodeIndices_[n];
    camera.name = scene_.nodes[static_cast<std::size_t>(camera.node)].name;
    camera.verticalFov = static_cast<float>(source.perspective.yfov);
    camera.zNear = static_cast<float>(source.perspective.znear);
    scene_.cameras.push_back(std::move(camera));
  }

  void addLight(std::size_t n, const tinygltf::Light& source) {
    static const std::map<std::string, float> kKinds = {
        {"directional", shading::kLightDirectional}, {"point", shading::kLightPoint}, {"spot", shading::kLightSpot}};
    const auto kind = kKinds.find(source.type);
    if (kind == kKinds.end())
      throwInputError("{}: lights are directional, point or spot, got '{}'", placeOfNode(n), source.type);
    PunctualLight light;
    light.node = nodeIndices_[n];
    light.kind = kind->second;
    const glm::vec3 color = source.color.empty() ? glm::vec3(1.0f) : vec3Of(source.color);
    light.intensity = static_cast<float>(source.intensity) * color;
    light.range = static_cast<float>(source.range);
    light.innerConeAngle = static_cast<float>(source.spot.innerConeAngle);
    light.outerConeAngle = static_cast<float>(source.spot.outerConeAngle);
    if (source.type == "spot" && !(light.innerConeAngle < light.outerConeAngle))
      throwInputError("{}: a spot light's inner cone angle is below its outer one, got {} and {}", placeOfNode(n),
                      light.innerConeAngle, light.outerConeAngle);
    scene_.lights.push_back(light);
  }

  void addAnimation(const tinygltf::Animation& animation) {
    const std::string place = "animation " + gltf::label(animation.name, animationCount_++);
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      try {
        addChannel(animation, channel, place);
      } catch (const Error& e) {
        throw Error(e.kind(), place + ": " + e.what());
      }
    }
  }

  void addChannel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel,
                  const std::string& place) {
    static const std::map<std::string, TrackTarget> kTargets = {
        {"translation", TrackTarget::translation}, {"rotation", TrackTarget::rotation}, {"scale", TrackTarget::scale}};
    const auto n = static_cast<std::size_t>(channel.target_node);
    if (nodeIndices_[n] < 0) return;
    const auto target = kTargets.find(channel.target_path);
    if (target == kTargets.end())
      return warn(fmt::format("{}: {} of {} is not animated", place, channel.target_path, placeOfNode(n)));
    if (!model_.nodes[n].matrix.empty()) throwInputError("an animated node has no matrix, {} has one", placeOfNode(n));
    if (!animated_.insert({n, target->second}).second)
      return warn(
          fmt::format("{}: {} of {} is ignored, it is animated twice", place, channel.target_path, placeOfNode(n)));
    scene_.tracks.push_back(
        readTrack(animation.samplers[static_cast<std::size_t>(channel.sampler)], target->second, n));
  }

  Track readTrack(const tinygltf::AnimationSampler& sampler, TrackTarget target, std::size_t n) const {
    static const std::map<std::string, Interpolation> kInterpolations = {
        {"STEP", Interpolation::step}, {"LINEAR", Interpolation::linear}, {"CUBICSPLINE", Interpolation::cubicSpline}};
    const auto interpolation = kInterpolations.find(sampler.interpolation);
    if (interpolation == kInterpolations.end())
      throwInputError("interpolations are STEP, LINEAR and CUBICSPLINE, got '{}'", sampler.interpolation);
    Track track;
    track.node = nodeIndices_[n];
    track.target = target;
    track.interpolation = interpolation->second;
    const gltf::FloatAccessor times = gltf::readFloats(document_, sampler.input);
    for (const glm::vec4& t : times.elements) track.timesSeconds.push_back(t.x);
    const gltf::FloatAccessor values = gltf::readFloats(document_, sampler.output);
    const int wanted = target == TrackTarget::rotation ? 4 : 3;
    if (times.components != 1 || values.components != wanted)
      throwInputError("{} wants key times of 1 and values of {} components, got {} and {}", placeOfNode(n), wanted,
                      times.components, values.components);
    track.values = values.elements;
    if (target == TrackTarget::rotation) checkRotationKeys(track, n);
    return track;
  }

  // A rotation that is not a unit quaternion can't be interpolated on the sphere; tangents of splines may be anything.
  void checkRotationKeys(const Track& track, std::size_t n) const {
    const bool spline = track.interpolation == Interpolation::cubicSpline;
    for (std::size_t i = spline ? 1 : 0; i < track.values.size(); i += spline ? 3 : 1)
      unitQuaternion(track.values[i], placeOfNode(n));
  }

  void warnAboutExtensions() {
    for (const std::string& name : model_.extensionsUsed) {
      const auto isNamed = [&](const std::string& warning) { return warning.find(name) != std::string::npos; };
      if (!gltf::isSupportedExtension(name) && std::ranges::none_of(scene_.warnings, isNamed))
        warn("extension " + name + " is ignored");
    }
  }

  void setEnvironment(const std::optional<Environment>& environment) {
    const int index = sceneIndex();
    const json extras =
        index < 0 ? json() : memberOrNull(document_.json["scenes"][static_cast<std::size_t>(index)], "extras");
    const bool hasEnvironment = gltf::readSceneExtras(document_, extras, scene_);
    if (environment) {
      scene_.environment = *environment;
    } else if (hasEnvironment) {
      return;
    } else if (scene_.lights.empty()) {
      scene_.environment = makeProceduralSky();
      scene_.notes.emplace_back("no light and no environment in the file: added the procedural sky");
    } else {
      scene_.environment = makeConstantEnvironment(glm::vec3(0.0f));
      scene_.notes.emplace_back("lights but no environment in the file: the surroundings are black");
    }
  }

  const gltf::Document& document_;
  const tinygltf::Model& model_;
  Scene scene_;
  std::vector<int> nodeIndices_;                                         // in scene_, -1 for nodes outside of the scene
  std::map<std::pair<json, bool>, std::shared_ptr<const Mesh>> meshes_;  // by data and need of tangents
  std::set<std::pair<std::size_t, TrackTarget>> animated_;
  std::size_t animationCount_ = 0;
};

}  // namespace

Scene loadGltf(const std::string& path, const std::optional<Environment>& environment) {
  const std::string bytes = readFile(path);
  try {
    const gltf::Document document = gltf::parseDocument(bytes, std::filesystem::absolute(path).parent_path().string());
    Scene scene = SceneBuilder(document).load(environment);
    scene.name = std::filesystem::path(path).stem().string();
    finishScene(scene);
    return scene;
  } catch (const Error& e) {
    throw Error(e.kind(), path + ": " + e.what());
  } catch (const std::bad_alloc&) {
    throwInputError("{}: the scene doesn't fit into memory", path);
  } catch (const std::exception& e) {
    throwInputError("{}: the file is damaged: {}", path, e.what());
  }
}

}  // namespace pb
