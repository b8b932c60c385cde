#include "bench/results_json.h"

#include <set>

#include "bench/attribution_json.h"
#include "bench/cell_json.h"
#include "bench/tolerance_json.h"
#include "results/schema/results.schema.h"
#include "scenes/error.h"

namespace pb {
namespace {

constexpr DocumentFormat kFormat{"results", "schema_version", kResultsSchemaVersion, schemas::kResults};

constexpr Field<Provenance, std::string> kProvenanceTexts[] = {
    {"tool_version", &Provenance::toolVersion}, {"git_hash", &Provenance::gitHash},
    {"suite_name", &Provenance::suiteName},     {"suite_hash", &Provenance::suiteHash},
    {"started_at", &Provenance::startedAt},     {"cpu", &Provenance::cpu},
    {"gl_backend", &Provenance::glBackend},     {"gl_renderer", &Provenance::glRenderer},
    {"gl_version", &Provenance::glVersion},     {"control_outcome", &Provenance::controlOutcome},
};

// Any range of (name, value) pairs as an object, and back.
template <class Pairs>
Json objectOf(const Pairs& pairs) {
  Json json = Json::object();
  for (const auto& [name, value] : pairs) json[name] = value;
  return json;
}

template <class Value>
std::vector<std::pair<std::string, Value>> pairsOf(const Json& json) {
  std::vector<std::pair<std::string, Value>> pairs;
  for (const auto& [name, value] : json.items()) pairs.emplace_back(name, value.template get<Value>());
  return pairs;
}

void requireDistinctKeys(const std::vector<CellResult>& cells, const std::string& place) {
  std::set<std::string> keys;
  for (const CellResult& cell : cells)
    if (!keys.insert(cell.key()).second) throwInputError("a cell may stand once in '{}', twice: {}", place, cell.key());
}

}  // namespace

Json provenanceToJson(const Provenance& provenance) {
  Json json;
  for (const auto& field : kProvenanceTexts) json[field.key] = provenance.*field.member;
  json["threads"] = provenance.threads;
  json["seed"] = provenance.seed;
  json["max_noise"] = provenance.maxNoise ? Json(*provenance.maxNoise) : Json();
  json["settings"] = objectOf(provenance.settings);
  json["scene_hashes"] = objectOf(provenance.sceneHashes);
  json["libraries"] = objectOf(provenance.libraries);
  return json;
}

Provenance provenanceFromJson(const Json& json) {
  Provenance provenance;
  for (const auto& field : kProvenanceTexts) provenance.*field.member = json.at(field.key).get<std::string>();
  provenance.threads = json.at("threads").get<int>();
  provenance.seed = json.at("seed").get<std::uint64_t>();
  // Files from before it was recorded don't have it.
  if (const auto noise = json.find("max_noise"); noise != json.end() && !noise->is_null())
    provenance.maxNoise = noise->get<double>();
  provenance.settings = pairsOf<std::string>(json.at("settings"));
  for (auto& [name, hash] : pairsOf<std::string>(json.at("scene_hashes"))) provenance.sceneHashes[name] = hash;
  for (auto& [name, version] : pairsOf<std::string>(json.at("libraries"))) provenance.libraries[name] = version;
  return provenance;
}

Json axisValuesToJson(const AxisValues& values) { return objectOf(values); }

AxisValues axisValuesFromJson(const Json& json) { return pairsOf<std::string>(json); }

Json countersToJson(const std::vector<std::pair<std::string, std::int64_t>>& counters) { return objectOf(counters); }

std::vector<std::pair<std::string, std::int64_t>> countersFromJson(const Json& json) {
  return pairsOf<std::int64_t>(json);
}

std::string toJson(const CellResult& cell) { return printLine(cellToJson(cell)); }

CellResult cellFromJson(const std::string& text, const std::string& place) {
  return cellFromJson(parsePart(text, place, R"({"$ref": "results.schema.json#/definitions/cell"})"));
}

std::string toJson(const Results& results) {
  Json head;
  head["schema_version"] = kResultsSchemaVersion;
  head["provenance"] = provenanceToJson(results.provenance);
  writeTolerances(head, {results.tolerance, results.warnTolerance}, results.sceneTolerances);
  if (!results.attribution.empty()) head["attribution"] = attributionToJson(results.attribution);
  std::vector<Json> rows;
  for (const CellResult& cell : results.cells) rows.push_back(cellToJson(cell));
  return printDocument(head, "cells", rows);
}

Results resultsFromJson(const std::string& text, const std::string& place) {
  const Json document = parseDocument(text, place, kFormat);
  Results results;
  results.provenance = provenanceFromJson(document.at("provenance"));
  ToleranceLevels levels = readTolerances(document);
  results.tolerance = std::move(levels.fail);
  results.warnTolerance = std::move(levels.warn);
  results.sceneTolerances = readSceneTolerances(document);
  for (const Json& cell : document.at("cells")) results.cells.push_back(cellFromJson(cell));
  if (const auto found = document.find("attribution"); found != document.end())
    results.attribution = attributionFromJson(*found);
  requireDistinctKeys(results.cells, place);
  return results;
}

}  // namespace pb
