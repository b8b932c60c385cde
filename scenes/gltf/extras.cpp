#include "scenes/gltf/extras.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/image_io.h"
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

glm::vec3 vector(const json& value, const std::string& place, double minimum = -kLargest) {
  if (!value.is_array() || value.size() != 3)
    throwInputError("{} wants an array of 3 numbers, got {}", place, value.dump());
  return glm::dvec3(number(value[0], place, minimum, kLargest), number(value[1], place, minimum, kLargest),
                    number(value[2], place, minimum, kLargest));
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
  const double glowPower = number(member(sky, "glowPower", place), place + "/glowPower", 0.0, kLargest);
  result.glow = glm::vec4(colorAt("glow"), static_cast<float>(glowPower));
  result.toGlow = glm::vec4(unitVector(member(sky, "toGlow", place), place + "/toGlow"), 0.0f);
  return result;
}

json toJson(const glm::vec3& v) { return {v.x, v.y, v.z}; }
json toJson(const glm::vec4& v) { return toJson(glm::vec3(v)); }

json toJson(const shading::Sky& sky) {
  return {{"horizon", toJson(sky.horizon)}, {"zenith", toJson(sky.zenith)}, {"below", toJson(sky.below)},
          {"glow", toJson(sky.glow)},       {"glowPower", sky.glow.w},      {"toGlow", toJson(sky.toGlow)},
          {"limit", sky.horizon.w}};
}

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

Environment readEnvironment(const Document& document, const json& value, const std::string& place) {
  Environment environment;
  if (value.is_object() && value.contains("faces")) {
    environment = makeCubeEnvironment("cube map", readFaces(document, value["faces"], place + "/faces"));
  } else {
    const json& sky = member(value, "sky", place);
    const std::string skyPlace = place + "/sky";
    const double limit = number(member(sky, "limit", skyPlace), skyPlace + "/limit", 0.0, kLargest);
    environment = makeGradientEnvironment(readSky(sky, skyPlace, static_cast<float>(limit)));
  }
  const json& name = member(value, "name", place);
  if (!name.is_string()) throwInputError("{}/name wants a string, got {}", place, name.dump());
  environment.name = name;
  environment.ambient = readAmbient(member(value, "ambient", place), place + "/ambient");
  return environment;
}

void readOwnExtras(const Document& document, const json& own, Scene& scene) {
  const std::string place = "extras.probebench";
  const json& schema = member(own, "schema", place);
  if (schema != 1) throwInputError("{} wants schema 1, got {}", place, schema.dump());
  scene.environment = readEnvironment(document, member(own, "environment", place), place + "/environment");
  scene.probeNear = static_cast<float>(number(member(own, "probeNear", place), place + "/probeNear", 1e-6, kLargest));
  scene.framesPerSecond = number(member(own, "framesPerSecond", place), place + "/framesPerSecond", 1e-3, 1e6);
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
  if (extras.contains("cubeCamera") && extras["cubeCamera"].is_object() && extras["cubeCamera"].contains("near"))
    scene.probeNear =
        static_cast<float>(number(extras["cubeCamera"]["near"], "extras.cubeCamera.near", 1e-6, kLargest));
  return hasEnvironment;
}

}  // namespace

bool readSceneExtras(const Document& document, const json& extras, Scene& scene) {
  if (!extras.is_object()) return false;
  if (!extras.contains("probebench")) return readCubeCameraExtras(extras, scene);
  readOwnExtras(document, extras["probebench"], scene);
  return true;
}

std::optional<ProbeSettings> readProbeExtras(const json& extras, const std::string& node,
                                             std::vector<std::string>& warnings) {
  const std::string place = "extras.probe";
  if (!extras.is_object() || !extras.contains("probe")) return std::nullopt;
  const json& probe = extras["probe"];
  if (probe.is_boolean()) return ProbeSettings{.enabled = probe, .position = {}};
  if (!probe.is_object()) throwInputError("{} wants true, false or an object, got {}", place, probe.dump());
  const std::vector<std::string> known = {"enabled", "position"};
  for (const auto& [key, value] : probe.items())
    if (std::ranges::find(known, key) == known.end())
      warnings.push_back(fmt::format("{}: a member of {} is ignored: {}", node, place, unknownMessage(key, known)));
  ProbeSettings settings;
  const json enabled = probe.value("enabled", json(true));
  if (!enabled.is_boolean()) throwInputError("{}/enabled wants true or false, got {}", place, enabled.dump());
  settings.enabled = enabled;
  if (probe.contains("position")) settings.position = vector(probe["position"], place + "/position");
  return settings;
}

json sceneExtras(const Scene& scene, const AddBufferView& addBufferView) {
  const Environment& source = scene.environment;
  json environment = {{"name", source.name}, {"ambient", toJson(source.ambient)}};
  if (source.sky.toGlow.w > 0.5f)
    for (const ImageRgba& face : source.faces) environment["faces"].push_back(addBufferView(encodeExr(rgbOf(face))));
  else
    environment["sky"] = toJson(source.sky);
  const json own = {{"schema", 1},
                    {"environment", environment},
                    {"probeNear", scene.probeNear},
                    {"framesPerSecond", scene.framesPerSecond}};
  return {{"probebench", own}};
}

json probeExtras(const ProbeSettings& probe) {
  json settings = {{"enabled", probe.enabled}};
  if (probe.position) settings["position"] = toJson(*probe.position);
  return {{"probe", settings}};
}

}  // namespace pb::gltf
