#include "bench/tolerance_json.h"

namespace pb {
namespace {

Json toleranceToJson(const Tolerance& tolerance) {
  if (tolerance.kind == Tolerance::Kind::plain)
    return {{"absolute", tolerance.absolute}, {"relative", tolerance.relative}};
  Json children = Json::array();
  for (const Tolerance& child : tolerance.children) children.push_back(toleranceToJson(child));
  return Json::object({{tolerance.kind == Tolerance::Kind::any ? "any" : "all", children}});
}

Tolerance toleranceFromJson(const Json& json) {
  using Kind = Tolerance::Kind;
  const char* treeKey = json.contains("any") ? "any" : "all";
  if (!json.contains(treeKey))
    return {Kind::plain, json.at("absolute").get<double>(), json.at("relative").get<double>(), {}};
  Tolerance tree{json.contains("any") ? Kind::any : Kind::all, 0, 0, {}};
  for (const Json& child : json.at(treeKey)) tree.children.push_back(toleranceFromJson(child));
  return tree;
}

}  // namespace

Json tolerancesToJson(const Tolerances& tolerances) {
  Json json = Json::object();
  for (const auto& [metric, tolerance] : tolerances) json[metric] = toleranceToJson(tolerance);
  return json;
}

Tolerances tolerancesFromJson(const Json& json) {
  Tolerances tolerances;
  for (const auto& [metric, tolerance] : json.items()) tolerances.emplace_back(metric, toleranceFromJson(tolerance));
  return tolerances;
}

void writeTolerances(Json& document, const ToleranceLevels& levels, const SceneTolerances& scenes) {
  document["tolerance"] = tolerancesToJson(levels.fail);
  if (!levels.warn.empty()) document["warn_tolerance"] = tolerancesToJson(levels.warn);
  for (const auto& [scope, ofScene] : scenes)
    document["scene_tolerances"][scope] = {{"fail", tolerancesToJson(ofScene.fail)},
                                           {"warn", tolerancesToJson(ofScene.warn)}};
}

ToleranceLevels readTolerances(const Json& document) {
  ToleranceLevels levels{tolerancesFromJson(document.at("tolerance")), {}};
  if (const auto warn = document.find("warn_tolerance"); warn != document.end())
    levels.warn = tolerancesFromJson(*warn);
  return levels;
}

SceneTolerances readSceneTolerances(const Json& document) {
  SceneTolerances scenes;
  if (const auto stored = document.find("scene_tolerances"); stored != document.end())
    for (const auto& [scope, levels] : stored->items())
      scenes[scope] = {tolerancesFromJson(levels.at("fail")), tolerancesFromJson(levels.at("warn"))};
  return scenes;
}

}  // namespace pb
