#include "scenes/gltf/extras.h"

#include <algorithm>
#include <array>
#include <glm/vector_relational.hpp>

#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/gltf/json_values.h"
#include "scenes/screen.h"
#include "scenes/spec.h"

namespace pb::gltf {
namespace {

using nlohmann::json;

// An axis-aligned box in world space.
Bounds readBox(const json& value, const std::string& owner, const std::string& place,
               std::vector<std::string>& warnings) {
  Bounds box;
  box.lower = vector(member(value, "lower", place), place + "/lower");
  box.upper = vector(member(value, "upper", place), place + "/upper");
  if (glm::any(glm::greaterThanEqual(box.lower, box.upper)))
    throwInputError("{} wants lower below upper in x, y and z, got {}", place, value.dump());
  warnOfUnknownMembers(value, owner, place, {"lower", "upper"}, warnings);
  return box;
}

json boxJson(const Bounds& box) { return {{"lower", toJson(box.lower)}, {"upper", toJson(box.upper)}}; }

bool readShadows(const json& value, const std::string& place) {
  if (value != "none" && value != "traced")
    throwInputError("{} wants \"none\" or \"traced\", got {}", place, value.dump());
  return value == "traced";
}

constexpr std::array kScreenProgramNames = {"melt", "twist", "ripples", "rings"};  // in the order of kScreen*

float screenProgram(const json& value, const std::string& place) {
  const std::vector<std::string> known(kScreenProgramNames.begin(), kScreenProgramNames.end());
  if (!value.is_string()) throwInputError("{} wants a string, got {}", place, value.dump());
  const auto found = std::ranges::find(known, value.get<std::string>());
  if (found == known.end()) throwInputError("{} {}", place, unknownMessage(value.get<std::string>(), known));
  return static_cast<float>(found - known.begin());
}

int pixelCount(const json& value, const std::string& place) {
  if (!value.is_number_integer()) throwInputError("{} wants whole numbers of pixels, got {}", place, value.dump());
  return static_cast<int>(number(value, place, 1.0, 1024.0));
}

Screen readScreen(const json& value, const std::string& place, std::vector<std::string>& warnings) {
  Screen screen;
  screen.program = screenProgram(member(value, "program", place), place + "/program");
  warnOfUnknownMembers(value, "", place, {"name", "program", "size", "periodSeconds", "phase"}, warnings);
  screen.name = value.value("name", kScreenProgramNames.at(static_cast<std::size_t>(screen.program)));
  if (value.contains("size")) {
    const json& size = value["size"];
    if (!size.is_array() || size.size() != 2)
      throwInputError("{}/size wants width and height in pixels, got {}", place, size.dump());
    screen.widthPx = pixelCount(size[0], place + "/size");
    screen.heightPx = pixelCount(size[1], place + "/size");
  }
  const auto numberAt = [&](const char* key, double minimum, float otherwise) {
    return static_cast<float>(number(value.value(key, json(otherwise)), place + "/" + key, minimum, 1e6));
  };
  screen.periodSeconds = numberAt("periodSeconds", 1e-3, screen.periodSeconds);
  screen.phase = numberAt("phase", -1e6, screen.phase);
  return screen;
}

std::vector<Screen> readScreens(const json& values, const std::string& place, std::vector<std::string>& warnings) {
  if (!values.is_array()) throwInputError("{} wants an array, got {}", place, values.dump());
  std::vector<Screen> screens;
  for (std::size_t i = 0; i < values.size(); ++i)
    screens.push_back(readScreen(values[i], fmt::format("{}/{}", place, i), warnings));
  return screens;
}

json screenJson(const Screen& screen) {
  return {{"name", screen.name},
          {"program", kScreenProgramNames.at(static_cast<std::size_t>(screen.program))},
          {"size", {screen.widthPx, screen.heightPx}},
          {"periodSeconds", screen.periodSeconds},
          {"phase", screen.phase}};
}

// Materials are read before the screens.
void checkScreensOfMaterials(const Scene& scene) {
  for (const Material& material : scene.materials)
    if (material.screen >= static_cast<int>(scene.screens.size()))
      throwInputError("material '{}' wants screen {} of extras.probebench/screens, the scene has {}", material.name,
                      material.screen, scene.screens.size());
}

// Returns whether there is an environment among them.
bool readOwnExtras(const Document& document, const json& own, Scene& scene) {
  const std::string place = "extras.probebench";
  const json& schema = member(own, "schema", place);
  if (schema != 1) throwInputError("{} wants schema 1, got {}", place, schema.dump());
  warnOfUnknownMembers(
      own, "", place,
      {"schema", "environment", "environmentChanges", "screens", "shadows", "probeNear", "room", "framesPerSecond"},
      scene.warnings);
  if (own.contains("environment"))
    scene.environment = readEnvironment(document, own["environment"], place + "/environment", scene.warnings);
  if (own.contains("environmentChanges"))
    scene.environmentChanges =
        readEnvironmentChanges(document, own["environmentChanges"], place + "/environmentChanges", scene.warnings);
  if (own.contains("screens")) scene.screens = readScreens(own["screens"], place + "/screens", scene.warnings);
  if (own.contains("shadows")) scene.castsShadows = readShadows(own["shadows"], place + "/shadows");
  if (own.contains("probeNear"))
    scene.probeNear = static_cast<float>(number(own["probeNear"], place + "/probeNear", 1e-6, kLargest));
  if (own.contains("room")) scene.room = readBox(own["room"], "", place + "/room", scene.warnings);
  if (own.contains("framesPerSecond"))
    scene.framesPerSecond = number(own["framesPerSecond"], place + "/framesPerSecond", 1e-3, 1e6);
  return own.contains("environment");
}

// The three.js benchmark's formula for its diffuse materials has no coat, though their factors would give them one.
void removeCoats(Scene& scene) {
  for (Material& material : scene.materials) {
    shading::MaterialConstants& c = material.constants;
    if (c.kind.x != shading::kSurfaceGlossy || c.factors.x > 0.0f) continue;
    c.specular.w = 0.0f;
    c.kind.x = shading::kSurfaceDiffuse;
  }
  scene.notes.emplace_back("extras.diffuse gives Lambert's law: materials that are no metals have no dielectric coat");
}

// Of the three.js cube-camera benchmark. Its sky is stored in bytes, so that no channel exceeds 1.
bool readCubeCameraExtras(const json& extras, Scene& scene) {
  bool hasEnvironment = false;
  if (extras.contains("sky")) {
    scene.environment = makeGradientEnvironment(readSky(extras["sky"], "extras.sky", 1.0f));
    hasEnvironment = true;
  } else if (extras.contains("skyRadiance")) {
    scene.environment = makeConstantEnvironment(color(extras["skyRadiance"], "extras.skyRadiance"));
    hasEnvironment = true;
  } else if (extras.contains("ambientRadiance")) {
    scene.environment = makeConstantEnvironment(glm::vec3(0.0f));
    hasEnvironment = true;
  }
  if (extras.contains("ambientRadiance"))
    scene.environment.ambient = constantAmbient(color(extras["ambientRadiance"], "extras.ambientRadiance"));
  if (extras.contains("diffuse") && extras["diffuse"].is_string() &&
      extras["diffuse"].get<std::string>().starts_with("albedo * "))
    removeCoats(scene);
  if (extras.contains("cubeCamera") && extras["cubeCamera"].is_object() && extras["cubeCamera"].contains("near"))
    scene.probeNear =
        static_cast<float>(number(extras["cubeCamera"]["near"], "extras.cubeCamera.near", 1e-6, kLargest));
  return hasEnvironment;
}

}  // namespace

bool readSceneExtras(const Document& document, const json& extras, Scene& scene) {
  bool hasEnvironment = false;
  if (extras.is_object()) hasEnvironment = readCubeCameraExtras(extras, scene);
  if (extras.is_object() && extras.contains("probebench"))
    hasEnvironment |= readOwnExtras(document, extras["probebench"], scene);
  checkScreensOfMaterials(scene);
  return hasEnvironment;
}

std::optional<ProbeSettings> readProbeExtras(const json& extras, const std::string& node,
                                             std::vector<std::string>& warnings) {
  const std::string place = "extras.probe";
  if (!extras.is_object() || !extras.contains("probe")) return std::nullopt;
  const json& probe = extras["probe"];
  if (probe.is_boolean()) return ProbeSettings{.enabled = probe, .position = {}};
  if (!probe.is_object()) throwInputError("{} wants true, false or an object, got {}", place, probe.dump());
  warnOfUnknownMembers(probe, node + ": ", place, {"enabled", "position", "box"}, warnings);
  ProbeSettings settings;
  const json enabled = probe.value("enabled", json(true));
  if (!enabled.is_boolean()) throwInputError("{}/enabled wants true or false, got {}", place, enabled.dump());
  settings.enabled = enabled;
  if (probe.contains("position")) settings.position = vector(probe["position"], place + "/position");
  if (probe.contains("box")) settings.box = readBox(probe["box"], node + ": ", place + "/box", warnings);
  return settings;
}

std::optional<Wave> readWaveExtras(const json& extras, const std::string& node, std::vector<std::string>& warnings) {
  const std::string place = "extras.probebench";
  if (!extras.is_object() || !extras.contains("probebench")) return std::nullopt;
  const json& own = extras["probebench"];
  if (!own.is_object()) throwInputError("{} wants an object, got {}", place, own.dump());
  warnOfUnknownMembers(own, node + ": ", place, {"wave"}, warnings);
  if (!own.contains("wave")) return std::nullopt;
  const json& value = own["wave"];
  const std::string at = place + "/wave";
  if (!value.is_object()) throwInputError("{} wants an object, got {}", at, value.dump());
  warnOfUnknownMembers(value, node + ": ", at, {"amplitude", "length", "wavelength", "skew", "periodSeconds"},
                       warnings);
  Wave wave;
  const auto read = [&](const char* key, double minimum, float& target) {
    target = static_cast<float>(number(value.value(key, json(target)), at + "/" + key, minimum, 1e6));
  };
  read("amplitude", -1e6, wave.amplitude);
  read("length", 1e-6, wave.length);
  read("wavelength", 1e-6, wave.wavelength);
  read("skew", -1e6, wave.skew);
  read("periodSeconds", 1e-3, wave.periodSeconds);
  return wave;
}

void readMaterialExtras(const json& extras, const std::string& owner, Material& material,
                        std::vector<std::string>& warnings) {
  const std::string place = "extras.probebench";
  if (!extras.is_object() || !extras.contains("probebench")) return;
  const json& own = extras["probebench"];
  if (!own.is_object()) throwInputError("{} wants an object, got {}", place, own.dump());
  warnOfUnknownMembers(own, owner + ": ", place, {"eta", "k", "screen"}, warnings);
  if (own.contains("screen")) {
    if (!own["screen"].is_number_unsigned() || own["screen"] > 1000000)
      throwInputError("{}/screen wants the index of a screen, got {}", place, own["screen"].dump());
    showScreen(material, own["screen"], glm::vec3(material.constants.emission));
    material.emissionTexture = -1;
  }
  if (!own.contains("eta") && !own.contains("k")) return;
  // Published values of metals are 0.03 to 8 and 0 to 14 (refractiveindex.info, visible light); with eta = k = 0 the
  // Fresnel equations are undefined.
  constexpr double kLargestIndex = 100.0;
  material.constants.conductorEta =
      glm::vec4(vector(member(own, "eta", place), place + "/eta", 1e-3, kLargestIndex), 1.0f);
  material.constants.conductorK = glm::vec4(vector(member(own, "k", place), place + "/k", 0.0, kLargestIndex), 0.0f);
  if (material.constants.factors.x == 0.0f)
    warnings.push_back(owner + ": its eta and k are those of a metal, but its metallic factor is 0");
}

json materialExtras(const Material& material) {
  json own;
  if (material.constants.conductorEta.w > 0.5f) {
    own["eta"] = toJson(material.constants.conductorEta);
    own["k"] = toJson(material.constants.conductorK);
  }
  if (material.screen >= 0) own["screen"] = material.screen;
  return own.is_null() ? json() : json{{"probebench", own}};
}

json sceneExtras(const Scene& scene, const AddBufferView& addBufferView) {
  json own = {{"schema", 1},
              {"environment", toJson(scene.environment, addBufferView)},
              {"shadows", scene.castsShadows ? "traced" : "none"},
              {"probeNear", scene.probeNear},
              {"framesPerSecond", scene.framesPerSecond}};
  for (const EnvironmentChange& change : scene.environmentChanges)
    own["environmentChanges"].push_back(
        {{"fromSeconds", change.timeSeconds}, {"environment", toJson(change.environment, addBufferView)}});
  for (const Screen& screen : scene.screens) own["screens"].push_back(screenJson(screen));
  if (scene.room) own["room"] = boxJson(*scene.room);
  return {{"probebench", own}};
}

json nodeExtras(const Node& node) {
  json extras;
  if (node.probe) {
    json& settings = extras["probe"];
    settings["enabled"] = node.probe->enabled;
    if (node.probe->position) settings["position"] = toJson(*node.probe->position);
    if (node.probe->box) settings["box"] = boxJson(*node.probe->box);
  }
  if (node.wave)
    extras["probebench"]["wave"] = {{"amplitude", node.wave->amplitude},
                                    {"length", node.wave->length},
                                    {"wavelength", node.wave->wavelength},
                                    {"skew", node.wave->skew},
                                    {"periodSeconds", node.wave->periodSeconds}};
  return extras;
}

}  // namespace pb::gltf
