#include "scenes/gltf_load.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <new>
#include <utility>

#include "scenes/closed_mesh.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/gltf/animation.h"
#include "scenes/gltf/document.h"
#include "scenes/gltf/extras.h"
#include "scenes/gltf/material.h"
#include "scenes/gltf/mesh.h"
#include "scenes/gltf/node.h"
#include "scenes/gltf/skin.h"
#include "scenes/gltf/validate.h"
#include "scenes/place.h"

namespace pb {
namespace {

using nlohmann::json;

// The scene that the file names or its first; -1 where it has none: then all nodes count.
int sceneIndex(const tinygltf::Model& model) { return model.scenes.empty() ? -1 : std::max(model.defaultScene, 0); }

std::vector<int> parentsOf(const tinygltf::Model& model) {
  std::vector<int> parents(model.nodes.size(), -1);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    for (const int child : model.nodes[n].children) parents[static_cast<std::size_t>(child)] = static_cast<int>(n);
  return parents;
}

// Scenes list roots; some exporters also list descendants, which then only repeat what their root says.
std::vector<bool> nodesOfScene(const tinygltf::Model& model, const std::vector<int>& parents) {
  const int scene = sceneIndex(model);
  if (scene < 0) return std::vector<bool>(model.nodes.size(), true);
  std::vector<bool> chosen(model.nodes.size(), false);
  std::vector<int> pending = model.scenes[static_cast<std::size_t>(scene)].nodes;
  for (int& n : pending)
    while (parents[static_cast<std::size_t>(n)] >= 0) n = parents[static_cast<std::size_t>(n)];
  while (!pending.empty()) {
    const auto n = static_cast<std::size_t>(pending.back());
    pending.pop_back();
    if (chosen[n]) continue;
    chosen[n] = true;
    pending.insert(pending.end(), model.nodes[n].children.begin(), model.nodes[n].children.end());
  }
  return chosen;
}

// Builds a Scene from one document.
class SceneBuilder {
 public:
  explicit SceneBuilder(const gltf::Document& document) : document_(document), model_(document.model) {}

  Scene build(const std::optional<Environment>& environment) {
    addNodes();
    gltf::readSkins(document_, sceneNodes_, scene_);
    gltf::readMaterials(document_, scene_);
    for (std::size_t n = 0; n < model_.nodes.size(); ++n)
      if (sceneNodes_[n] >= 0) addContents(n);
    if (scene_.instances.empty()) throwInputError("the scene draws no triangle");
    scene_.tracks = gltf::readTracks(document_, sceneNodes_, scene_.warnings);
    warnAboutExtensions();
    setEnvironment(environment);
    return std::move(scene_);
  }

 private:
  // The nodes of the scene in the file's order, but each after its ancestors.
  void addNodes() {
    const std::vector<int> parents = parentsOf(model_);
    const std::vector<bool> chosen = nodesOfScene(model_, parents);
    const auto isMissing = [&](int n) { return n >= 0 && sceneNodes_[static_cast<std::size_t>(n)] < 0; };
    sceneNodes_.assign(model_.nodes.size(), -1);
    for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
      if (!chosen[n]) continue;
      std::vector<int> missing;
      for (int a = static_cast<int>(n); isMissing(a); a = parents[static_cast<std::size_t>(a)]) missing.push_back(a);
      for (; !missing.empty(); missing.pop_back()) {
        const auto m = static_cast<std::size_t>(missing.back());
        addNode(m, parents[m] >= 0 ? sceneNodes_[static_cast<std::size_t>(parents[m])] : -1);
      }
    }
  }

  void addNode(std::size_t n, int parent) {
    Node node = gltf::readNode(document_, n, scene_.warnings);
    node.parent = parent;
    sceneNodes_[n] = static_cast<int>(scene_.nodes.size());
    scene_.nodes.push_back(std::move(node));
  }

  void addContents(std::size_t n) {
    const tinygltf::Node& node = model_.nodes[n];
    const std::string place = gltf::placeOfNode(document_, n);
    if (node.skin >= 0 && !hasJoints(node))
      scene_.warnings.push_back(place + ": its skin is ignored, there is no mesh with joints");
    for (const auto& [name, value] : node.extensions)
      if (!gltf::isSupportedExtension(name))
        scene_.warnings.push_back(fmt::format("{}: extension {} is ignored", place, name));
    if (node.mesh >= 0) addInstances(n, static_cast<std::size_t>(node.mesh));
    if (auto camera = gltf::readCamera(document_, n, sceneNodes_[n], scene_.warnings))
      scene_.cameras.push_back(std::move(*camera));
    if (const auto light = gltf::readLight(document_, n, sceneNodes_[n])) scene_.lights.push_back(*light);
  }

  bool hasJoints(const tinygltf::Node& node) const {
    return node.mesh >= 0 && std::ranges::any_of(model_.meshes[static_cast<std::size_t>(node.mesh)].primitives,
                                                 [](const auto& p) { return p.attributes.contains("JOINTS_0"); });
  }

  void addInstances(std::size_t n, std::size_t meshIndex) {
    const std::vector<tinygltf::Primitive>& primitives = model_.meshes[meshIndex].primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      Instance instance;
      instance.node = sceneNodes_[n];
      instance.name = scene_.nodes[static_cast<std::size_t>(instance.node)].name;
      if (primitives.size() > 1) instance.name += fmt::format("/{}", p);
      instance.material = gltf::materialIndex(document_, primitives[p]);
      instance.mesh = meshOf(meshIndex, p, scene_.materials[static_cast<std::size_t>(instance.material)]);
      if (instance.mesh != nullptr) scene_.instances.push_back(std::move(instance));
    }
  }

  // A mesh is made once for all primitives with the same data, also when they differ in material.
  std::shared_ptr<const Mesh> meshOf(std::size_t mesh, std::size_t primitive, const Material& material) {
    json data = document_.json["meshes"][mesh]["primitives"][primitive];
    data.erase("material");
    std::optional<int> tangentUvSet;
    if (material.normalTexture >= 0) tangentUvSet = static_cast<int>(material.constants.normalSlot.offset.z);
    const auto [found, isNew] = meshes_.try_emplace({std::move(data), tangentUvSet});
    if (isNew) found->second = gltf::readPrimitive(document_, mesh, primitive, tangentUvSet, scene_.warnings);
    return found->second;
  }

  // Those that no other warning names.
  void warnAboutExtensions() {
    for (const std::string& name : model_.extensionsUsed) {
      const auto isNamed = [&](const std::string& warning) { return warning.find(name) != std::string::npos; };
      if (!gltf::isSupportedExtension(name) && std::ranges::none_of(scene_.warnings, isNamed))
        scene_.warnings.push_back("extension " + name + " is ignored");
    }
  }

  json sceneExtras() const {
    const int scene = sceneIndex(model_);
    return scene < 0 ? json() : document_.json["scenes"][static_cast<std::size_t>(scene)].value("extras", json());
  }

  void setEnvironment(const std::optional<Environment>& environment) {
    const bool hasEnvironment = gltf::readSceneExtras(document_, sceneExtras(), scene_);
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
  std::vector<int> sceneNodes_;  // index in scene_ of each of the file's nodes, -1 for those that are not in the scene
  // By data and the texture coordinates that tangents are wanted for.
  std::map<std::pair<json, std::optional<int>>, std::shared_ptr<const Mesh>> meshes_;
};

Scene buildScene(const std::string& path, const std::string& bytes, const std::optional<Environment>& environment) {
  const gltf::Document document = gltf::parseDocument(bytes, std::filesystem::absolute(path).parent_path().string());
  Scene scene = SceneBuilder(document).build(environment);
  scene.name = std::filesystem::path(path).stem().string();
  finishScene(scene);
  warnOfOpenGlass(scene);
  return scene;
}

}  // namespace

Scene loadGltf(const std::string& path, const std::optional<Environment>& environment) {
  const std::string bytes = readFile(path);
  return atPlace(path, [&] {
    try {
      return buildScene(path, bytes, environment);
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throwInputError("the scene doesn't fit into memory");
    } catch (const std::exception& e) {  // of the libraries that read the file's parts
      throwInputError("the file is damaged: {}", e.what());
    }
  });
}

}  // namespace pb
