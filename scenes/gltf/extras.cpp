#include "scenes/gltf/extras.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/image_io.h"
#include "scenes/screen.h"
#include "scenes/spec.h"

namespace pb::gltf {
namespace {

using nlohmann::json;

constexpr double kLargest = 1e9;
constexpr std::array kAmbientMembers = {&shading::Ambient::constant, &shading::Ambient::y,  &shading::Ambient::z,
                                        &shading::Ambient::x,        &shading::Ambient::xy, &shading::Ambient::yz,
                                        &shading::Ambient::zz,       &shading::Ambient::xz, &shading::Ambient::xxyy};

double number(const json& value, const std::string& place, double minimum, double maximum) {
  if (!value.is_number() || value < minimum || value > maximum)
    throwInputError("{} wants a number from {} to {}, got {}", place, minimum, maximum, value.dump());
  return value.get<double>();
}

glm::vec3 vector(const json& value, const std::string& place, double minimum = -kLargest, double maximum = kLargest) {
  if (!value.is_array() || value.size() != 3)
    throwInputError("{} wants an array of 3 numbers, got {}", place, value.dump());
  return glm::dvec3(number(value[0], place, minimum, maximum), number(value[1], place, minimum, maximum),
                    number(value[2], place, minimum, maximum));
}

// Grey may be written as one number.
glm::vec3 color(const json& value, const std::string& place) {
  return value.is_number() ? glm::vec3(glm::dvec3(number(value, place, 0.0, kLargest))) : vector(value, place, 0.0);
}

glm::vec3 unitVector(const json& value, const std::string& place) {
  const glm::vec3 v = vector(value, place);
  const float length = glm::length(v);
  if (!(length > 0.0f)) throwInputError("{} wants a direction, got {}", place, value.dump());
  // Dividing what is unit already would change its last bits.
  return std::abs(length - 1.0f) < 1e-6f ? v : v / length;
}

const json& member(const json& object, const char* key, const std::string& place) {
  if (!object.is_object()) throwInputError("{} wants an object, got {}", place, object.dump());
  const auto found = object.find(key);
  if (found == object.end()) throwInputError("{} wants a member '{}'", place, key);
  return *found;
}

// A gradient whose channels are bounded by `limit` (0: unbounded).
shading::Sky readSky(const json& sky, const std::string& place, float limit) {
  const auto colorAt = [&](const char* key) { return color(member(sky, key, place), place + "/" + key); };
  shading::Sky result;
  result.horizon = glm::vec4(colorAt("horizon"), limit);
  result.zenith = glm::vec4(colorAt("zenith"), 0.0f);
  result.below = glm::vec4(colorAt("below"), 0.0f);
  result.glow = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
  result.toGlow = glm::vec4(0.0f, 1.0f, 0.0f, 0.0f);
  if (!sky.contains("glow")) return result;
  const double glowPower = number(member(sky, "glowPower", place), place + "/glowPower", 0.0, kLargest);
  result.glow = glm::vec4(colorAt("glow"), static_cast<float>(glowPower));
  result.toGlow = glm::vec4(unitVector(member(sky, "toGlow", place), place + "/toGlow"), 0.0f);
  return result;
}

// `owner` is "" or names a node or material, with a colon and a space behind it.
void warnOfUnknownMembers(const json& object, const std::string& owner, const std::string& place,
                          const std::vector<std::string>& known, std::vector<std::string>& warnings) {
  for (const auto& [key, value] : object.items())
    if (std::ranges::find(known, key) == known.end())
      warnings.push_back(fmt::format("{}a member of {} is ignored: {}", owner, place, unknownMessage(key, known)));
}

json toJson(const glm::vec3& v) { return {v.x, v.y, v.z}; }
json toJson(const glm::vec4& v) { return toJson(glm::vec3(v)); }

json toJson(const shading::Sky& sky) {
  return {{"horizon", toJson(sky.horizon)}, {"zenith", toJson(sky.zenith)}, {"below", toJson(sky.below)},
          {"glow", toJson(sky.glow)},       {"glowPower", sky.glow.w},      {"toGlow", toJson(sky.toGlow)},
          {"limit", sky.horizon.w}};
}

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

json toJson(const Bounds& box) { return {{"lower", toJson(box.lower)}, {"upper", toJson(box.upper)}}; }

shading::Ambient readAmbient(const json& value, const std::string& place) {
  if (!value.is_array() || value.size() != kAmbientMembers.size())
    throwInputError("{} wants {} colours, got {}", place, kAmbientMembers.size(), value.dump());
  shading::Ambient ambient;
  for (std::size_t i = 0; i < kAmbientMembers.size(); ++i)
    ambient.*kAmbientMembers[i] = glm::vec4(vector(value[i], fmt::format("{}/{}", place, i)), 0.0f);
  return ambient;
}

json toJson(const shading::Ambient& ambient) {
  json coefficients = json::array();
  for (const auto member : kAmbientMembers) coefficients.push_back(toJson(ambient.*member));
  return coefficients;
}

ImageRgba readFace(const Document& document, const json& bufferView, const std::string& place) {
  if (!bufferView.is_number_integer() || bufferView < 0 || bufferView >= document.model.bufferViews.size())
    throwInputError("{} wants the indices of bufferViews, got {}", place, bufferView.dump());
  return readImage(bytesOf(document, bufferView), place).pixels;
}

std::vector<ImageRgba> readFaces(const Document& document, const json& bufferViews, const std::string& place) {
  if (!bufferViews.is_array() || bufferViews.size() != 6)
    throwInputError("{} wants six bufferViews, got {}", place, bufferViews.dump());
  std::vector<ImageRgba> faces;
  for (const json& bufferView : bufferViews) {
    faces.push_back(readFace(document, bufferView, place));
    if (faces.back().width() != faces.back().height() || faces.back().width() != faces.front().width())
      throwInputError("{} wants square images of one size, got {} x {}", place, faces.back().width(),
                      faces.back().height());
  }
  return faces;
}

Environment readFacesEnvironment(const Document& document, const json& faces, const std::string& place,
                                 std::vector<std::string>& warnings) {
  std::vector<ImageRgba> images = readFaces(document, faces, place);
  for (ImageRgba& image : images) repairRadiance(image, place, warnings);
  return makeCubeEnvironment("cube map", std::move(images));
}

Environment readGradientEnvironment(const json& sky, const std::string& place, std::vector<std::string>& warnings) {
  if (!sky.is_object()) throwInputError("{} wants an object, got {}", place, sky.dump());
  warnOfUnknownMembers(sky, "", place, {"horizon", "zenith", "below", "glow", "glowPower", "toGlow", "limit"},
                       warnings);
  const double limit = number(sky.value("limit", json(0.0)), place + "/limit", 0.0, kLargest);
  return makeGradientEnvironment(readSky(sky, place, static_cast<float>(limit)));
}

// The one of its three members that says what the sky is.
std::string kindOfEnvironment(const json& value, const std::string& place) {
  if (!value.is_object()) throwInputError("{} wants an object, got {}", place, value.dump());
  std::string kind;
  for (const char* key : {"constant", "sky", "faces"}) {
    if (!value.contains(key)) continue;
    if (!kind.empty()) throwInputError("{} wants one of constant, sky and faces, got {} and {}", place, kind, key);
    kind = key;
  }
  if (kind.empty()) throwInputError("{} wants one of constant, sky and faces, got none", place);
  return kind;
}

Environment readEnvironment(const Document& document, const json& value, const std::string& place,
                            std::vector<std::string>& warnings) {
  const std::string kind = kindOfEnvironment(value, place);
  warnOfUnknownMembers(value, "", place, {"name", "ambient", "constant", "sky", "faces"}, warnings);
  const std::string kindPlace = place + "/" + kind;
  Environment environment = kind == "constant" ? makeConstantEnvironment(color(value[kind], kindPlace))
                            : kind == "sky"    ? readGradientEnvironment(value[kind], kindPlace, warnings)
                                               : readFacesEnvironment(document, value[kind], kindPlace, warnings);
  if (value.contains("name")) {
    const json& name = value["name"];
    if (!name.is_string()) throwInputError("{}/name wants a string, got {}", place, name.dump());
    environment.name = name;
  }
  if (value.contains("ambient")) environment.ambient = readAmbient(value["ambient"], place + "/ambient");
  return environment;
}

json toJson(const Environment& source, const AddBufferView& addBufferView) {
  json environment = {{"name", source.name}, {"ambient", toJson(source.ambient)}};
  if (source.sky.toGlow.w > 0.5f)
    for (const ImageRgba& face : source.faces) environment["faces"].push_back(addBufferView(encodeExr(rgbOf(face))));
  else
    environment["sky"] = toJson(source.sky);
  return environment;
}

// Whether times increase is for finishScene() to check.
std::vector<EnvironmentChange> readEnvironmentChanges(const Document& document, const json& values,
                                                      const std::string& place, std::vector<std::string>& warnings) {
  if (!values.is_array()) throwInputError("{} wants an array, got {}", place, values.dump());
  std::vector<EnvironmentChange> changes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string at = fmt::format("{}/{}", place, i);
    EnvironmentChange& change = changes.emplace_back();
    change.timeSeconds = number(member(values[i], "fromSeconds", at), at + "/fromSeconds", 1e-6, 1e6);
    change.environment = readEnvironment(document, member(values[i], "environment", at), at + "/environment", warnings);
    warnOfUnknownMembers(values[i], "", at, {"fromSeconds", "environment"}, warnings);
  }
  return changes;
}

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

json toJson(const Screen& screen) {
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
  for (const Screen& screen : scene.screens) own["screens"].push_back(toJson(screen));
  if (scene.room) own["room"] = toJson(*scene.room);
  return {{"probebench", own}};
}

json nodeExtras(const Node& node) {
  json extras;
  if (node.probe) {
    json& settings = extras["probe"];
    settings["enabled"] = node.probe->enabled;
    if (node.probe->position) settings["position"] = toJson(*node.probe->position);
    if (node.probe->box) settings["box"] = toJson(*node.probe->box);
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
