#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <string_view>

#include "scenes/builtin.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/gltf_load.h"
#include "scenes/obj_load.h"
#include "scenes/scene.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr std::string_view kBuiltinPrefix = "builtin:";

std::optional<std::string> takeParameter(Spec& spec, std::string_view key) {
  const auto found = std::ranges::find(spec.parameters, key, &std::pair<std::string, std::string>::first);
  if (found == spec.parameters.end()) return std::nullopt;
  std::string value = std::move(found->second);
  spec.parameters.erase(found);
  return value;
}

// The node of that name and everything below it.
std::vector<bool> subtree(const Scene& scene, const std::string& name) {
  std::vector<bool> inside(scene.nodes.size(), false);
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const int parent = scene.nodes[n].parent;
    inside[n] = scene.nodes[n].name == name || (parent >= 0 && inside[static_cast<std::size_t>(parent)]);
  }
  return inside;
}

// Perfect mirrors, added to a scene when first wanted: one seen from the front, one seen from both sides.
class MirrorMaterials {
 public:
  explicit MirrorMaterials(Scene& scene) : scene_(scene) {}

  // The one that is seen from the same sides as the given material.
  int like(int material) {
    const bool doubleSided = scene_.materials[static_cast<std::size_t>(material)].doubleSided;
    std::optional<int>& index = indices_[doubleSided ? 1 : 0];
    if (index) return *index;
    Material mirror = makeMirrorMaterial(doubleSided ? "double-sided mirror" : "mirror");
    mirror.doubleSided = doubleSided;
    scene_.materials.push_back(std::move(mirror));
    return *(index = static_cast<int>(scene_.materials.size() - 1));
  }

 private:
  Scene& scene_;
  std::array<std::optional<int>, 2> indices_;
};

void makeMirrors(Scene& scene, const std::string& nodeName, const std::string& reference) {
  const bool all = nodeName == "all";
  const std::vector<bool> chosen = all ? std::vector<bool>(scene.nodes.size(), true) : subtree(scene, nodeName);
  MirrorMaterials mirrors(scene);
  bool any = false;
  for (Instance& instance : scene.instances) {
    if (!chosen[static_cast<std::size_t>(instance.node)]) continue;
    instance.material = mirrors.like(instance.material);
    any = true;
  }
  if (any) return;
  std::vector<std::string> names = {"all"};
  for (const Instance& instance : scene.instances)
    names.push_back(scene.nodes[static_cast<std::size_t>(instance.node)].name);
  throwInputError("scene '{}': mirror wants a node with a mesh, {}", reference, unknownMessage(nodeName, names));
}

// The names of built-in scenes are easily written without their prefix.
void checkFileIsMeant(const std::string& path, const std::string& reference) {
  const bool isBuiltin = std::ranges::find(builtinScenes(), path, &BuiltinScene::name) != builtinScenes().end();
  if (isBuiltin && !std::filesystem::exists(path))
    throwInputError("scene '{}': there is no such file; did you mean '{}{}'?", reference, kBuiltinPrefix, reference);
}

bool isObj(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension == ".obj";
}

Scene loadFile(Spec spec, const std::string& reference, const std::optional<Environment>& environment) {
  checkFileIsMeant(spec.name, reference);
  const std::optional<std::string> mirror = takeParameter(spec, "mirror");
  const std::vector<std::string> known = {"mirror", "environment", "shadows", "fps", "time_step"};
  if (!spec.parameters.empty())
    throwInputError("scene '{}': parameter {}", reference, unknownMessage(spec.parameters.front().first, known));
  Scene scene = isObj(spec.name) ? loadObj(spec.name, environment) : loadGltf(spec.name, environment);
  if (mirror) makeMirrors(scene, *mirror, reference);
  return scene;
}

// What `environment=` says, in the place of all environments of the scene.
struct GivenEnvironments {
  std::optional<Environment> first;
  std::vector<EnvironmentChange> changes;
};

GivenEnvironments loadEnvironments(const std::optional<std::string>& text, std::vector<std::string>& warnings) {
  GivenEnvironments given;
  if (!text) return given;
  for (const TimedEnvironment& timed : parseEnvironments(*text)) {
    Environment environment = loadEnvironment(timed.text, warnings);
    if (given.first)
      given.changes.push_back({timed.timeSeconds, std::move(environment)});
    else
      given.first = std::move(environment);
  }
  return given;
}

std::optional<double> framesPerSecond(Spec& spec, const std::string& reference) {
  const std::optional<std::string> fps = takeParameter(spec, "fps"), step = takeParameter(spec, "time_step");
  if (fps && step) throwInputError("scene '{}': fps and time_step say the same, give one of them", reference);
  if (!fps && !step) return std::nullopt;
  const std::optional<double> value = parseNumber(fps ? *fps : *step);
  if (!value || *value < 1e-3 || *value > 1e3)
    throwInputError("scene '{}': {} wants a number from 0.001 to 1000, got '{}'", reference, fps ? "fps" : "time_step",
                    fps ? *fps : *step);
  return fps ? *value : 1.0 / *value;
}

Scene makeBuiltin(Spec spec) {
  spec.name.erase(0, kBuiltinPrefix.size());
  return makeBuiltinScene(spec);
}

}  // namespace

std::shared_ptr<const Scene> loadScene(const std::string& reference) {
  Spec spec = parseSpec(reference);
  const std::optional<std::string> shadows = takeParameter(spec, "shadows");
  if (shadows && *shadows != "none" && *shadows != "traced")
    throwInputError("scene '{}': shadows wants none or traced, got '{}'", reference, *shadows);
  const std::optional<double> fps = framesPerSecond(spec, reference);
  std::vector<std::string> warnings;
  const GivenEnvironments given = loadEnvironments(takeParameter(spec, "environment"), warnings);
  Scene scene = spec.name.starts_with(kBuiltinPrefix) ? makeBuiltin(std::move(spec))
                                                      : loadFile(std::move(spec), reference, given.first);
  if (given.first) {
    scene.environment = *given.first;
    scene.environmentChanges = given.changes;
    finishScene(scene);
  }
  if (fps) scene.framesPerSecond = *fps;
  if (shadows) scene.castsShadows = *shadows == "traced";
  scene.warnings.insert(scene.warnings.end(), warnings.begin(), warnings.end());
  return std::make_shared<const Scene>(std::move(scene));
}

}  // namespace pb
