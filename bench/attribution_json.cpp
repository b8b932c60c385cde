#include "bench/attribution_json.h"

namespace pb {
namespace {

using Values = std::vector<std::pair<std::string, double>>;

Json toJsonObject(const Values& values) {
  Json json = Json::object();
  for (const auto& [key, value] : values) json[key] = encodeNumber(value);
  return json;
}

Values valuesOf(const Json& json) {
  Values values;
  for (const auto& [key, value] : json.items()) values.emplace_back(key, decodeNumber(value));
  return values;
}

Json toJsonArray(const std::vector<AttributionStep>& steps) {
  Json array = Json::array();
  for (const AttributionStep& step : steps) {
    Json json = {{"step", step.step}, {"metrics", toJsonObject(step.metrics)}};
    if (!step.maskMetrics.empty()) json["mask_metrics"] = toJsonObject(step.maskMetrics);
    array.push_back(std::move(json));
  }
  return array;
}

std::vector<AttributionStep> stepsOf(const Json& array) {
  std::vector<AttributionStep> steps;
  for (const Json& json : array) {
    AttributionStep& step = steps.emplace_back();
    step.step = json.at("step").get<std::string>();
    step.metrics = valuesOf(json.at("metrics"));
    if (const auto mask = json.find("mask_metrics"); mask != json.end()) step.maskMetrics = valuesOf(*mask);
  }
  return steps;
}

Json toJsonObject(const Attribution& attribution) {
  Json json;
  json["scene"] = attribution.scene;
  json["camera"] = attribution.camera;
  json["frame"] = attribution.frame;
  json["technique"] = Json::object();
  for (const auto& [axis, value] : attribution.technique) json["technique"][axis] = value;
  json["depth"] = attribution.depth;
  json["steps"] = toJsonArray(attribution.steps);
  json["objects"] = Json::array();
  for (const ObjectAttribution& object : attribution.objects)
    json["objects"].push_back({{"object", object.object},
                               {"material", object.material},
                               {"pixels", object.pixels},
                               {"steps", toJsonArray(object.steps)}});
  return json;
}

Attribution attributionOf(const Json& json) {
  Attribution attribution;
  attribution.scene = json.at("scene").get<std::string>();
  attribution.camera = json.at("camera").get<std::string>();
  attribution.frame = json.at("frame").get<int>();
  for (const auto& [axis, value] : json.at("technique").items())
    attribution.technique.emplace_back(axis, value.get<std::string>());
  attribution.depth = json.at("depth").get<int>();
  attribution.steps = stepsOf(json.at("steps"));
  for (const Json& object : json.at("objects"))
    attribution.objects.push_back({object.at("object").get<std::string>(), object.at("material").get<std::string>(),
                                   object.at("pixels").get<std::int64_t>(), stepsOf(object.at("steps"))});
  return attribution;
}

}  // namespace

const std::vector<AttributionStepInfo>& attributionSteps() {
  static const std::vector<AttributionStepInfo> kSteps = {
      {"local diffuse", "diffuse surfaces show the light of their own point instead of global illumination"},
      {"truncated bounces", "paths end after as many specular hits as the technique follows"},
      {"lookup", "reflections and refractions are looked up in maps, which are traced, at a very high resolution"},
      {"resolution", "the traced maps have the technique's resolution"},
      {"capture", "the maps are rasterised, with all faces and all bounces of this very moment"},
      {"filtered/format", "the maps are filtered and stored as the technique does"},
      {"stale", "the technique as it is run: faces captured at their own times, blended with what was there"},
  };
  return kSteps;
}

Json attributionToJson(const std::vector<Attribution>& attributions) {
  Json array = Json::array();
  for (const Attribution& attribution : attributions) array.push_back(toJsonObject(attribution));
  return array;
}

std::vector<Attribution> attributionFromJson(const Json& json) {
  std::vector<Attribution> attributions;
  for (const Json& attribution : json) attributions.push_back(attributionOf(attribution));
  return attributions;
}

std::string toJson(const Attribution& attribution) { return printLine(toJsonObject(attribution)); }

Attribution attributionFromJson(const std::string& text, const std::string& place) {
  return attributionOf(parsePart(text, place, R"({"$ref": "results.schema.json#/definitions/attribution"})"));
}

}  // namespace pb
