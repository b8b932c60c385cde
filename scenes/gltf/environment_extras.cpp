#include "scenes/gltf/environment_extras.h"

#include <array>

#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/gltf/json_values.h"
#include "scenes/image_io.h"

namespace pb::gltf {
namespace {

using nlohmann::json;

constexpr std::array kAmbientMembers = {&shading::Ambient::constant, &shading::Ambient::y,  &shading::Ambient::z,
                                        &shading::Ambient::x,        &shading::Ambient::xy, &shading::Ambient::yz,
                                        &shading::Ambient::zz,       &shading::Ambient::xz, &shading::Ambient::xxyy};

json skyJson(const shading::Sky& sky) {
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

json ambientJson(const shading::Ambient& ambient) {
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

}  // namespace

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
  json environment = {{"name", source.name}, {"ambient", ambientJson(source.ambient)}};
  if (source.sky.toGlow.w > 0.5f)
    for (const ImageRgba& face : source.faces) environment["faces"].push_back(addBufferView(encodeExr(rgbOf(face))));
  else
    environment["sky"] = skyJson(source.sky);
  return environment;
}

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

}  // namespace pb::gltf
