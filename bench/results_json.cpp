#include "bench/results_json.h"

#include <set>

#include "bench/metrics/metrics_json.h"
#include "results/schema/results.schema.h"
#include "scenes/error.h"

namespace pb {
namespace {

constexpr DocumentFormat kFormat{"results", "schema_version", kResultsSchemaVersion, schemas::kResults};

template <class T, class Value>
struct Field {
  const char* key;
  Value T::*member;
};

constexpr Field<Provenance, std::string> kProvenanceTexts[] = {
    {"tool_version", &Provenance::toolVersion}, {"git_hash", &Provenance::gitHash},
    {"suite_name", &Provenance::suiteName},     {"suite_hash", &Provenance::suiteHash},
    {"started_at", &Provenance::startedAt},     {"cpu", &Provenance::cpu},
    {"gl_backend", &Provenance::glBackend},     {"gl_renderer", &Provenance::glRenderer},
    {"gl_version", &Provenance::glVersion},     {"control_outcome", &Provenance::controlOutcome},
};

constexpr Field<CostResult, double> kCostNumbers[] = {
    {"frame_ms", &CostResult::frameMs},
    {"frame_ms_low", &CostResult::frameMsLow},
    {"frame_ms_high", &CostResult::frameMsHigh},
    {"plain_ms", &CostResult::plainMs},
    {"ratio", &CostResult::ratio},
    {"ratio_low", &CostResult::ratioLow},
    {"ratio_high", &CostResult::ratioHigh},
    {"final_ms", &CostResult::finalMs},
    {"renders_per_frame", &CostResult::rendersPerFrame},
    {"measured_renders_per_frame", &CostResult::measuredRendersPerFrame},
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

Json metricValuesToJson(const MetricValues& values) {
  Json json = Json::object();
  for (const auto& [key, value] : values) json[key] = encodeNumber(value);
  return json;
}

MetricValues metricValuesFromJson(const Json& json) {
  MetricValues values;
  for (const auto& [key, value] : json.items()) values.emplace_back(key, decodeNumber(value));
  return values;
}

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

Json costToJson(const std::optional<CostResult>& cost) {
  if (!cost) return nullptr;
  Json json;
  json["repetitions"] = cost->repetitions;
  for (const auto& field : kCostNumbers) json[field.key] = (*cost).*field.member;
  json["shadow_ms"] = cost->shadowMs;
  json["capture_ms"] = cost->captureMs;
  json["prefilter_ms"] = cost->prefilterMs;
  json["renders_formula"] = cost->rendersFormula;
  return json;
}

std::optional<CostResult> costFromJson(const Json& json) {
  if (json.is_null()) return std::nullopt;
  CostResult cost;
  cost.repetitions = json.at("repetitions").get<int>();
  for (const auto& field : kCostNumbers) cost.*field.member = json.at(field.key).get<double>();
  cost.captureMs = json.at("capture_ms").get<std::vector<double>>();
  cost.shadowMs = json.value("shadow_ms", 0.0);  // older results have neither
  cost.prefilterMs = json.value("prefilter_ms", 0.0);
  cost.rendersFormula = json.at("renders_formula").get<std::string>();
  return cost;
}

Json reportedCostToJson(const ReportedCost& cost) {
  const auto orNull = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  return {{"program", cost.program},           {"frames", cost.frames},
          {"frame_ms", cost.frameMs},          {"frame_ms_low", cost.frameMsLow},
          {"frame_ms_high", cost.frameMsHigh}, {"plain_ms", orNull(cost.plainMs)},
          {"ratio", orNull(cost.ratio())}};
}

// `ratio` follows from the rest.
ReportedCost reportedCostFromJson(const Json& json) {
  ReportedCost cost;
  cost.program = json.at("program").get<std::string>();
  cost.frames = json.at("frames").get<int>();
  cost.frameMs = json.at("frame_ms").get<double>();
  cost.frameMsLow = json.at("frame_ms_low").get<double>();
  cost.frameMsHigh = json.at("frame_ms_high").get<double>();
  if (const Json& plain = json.at("plain_ms"); !plain.is_null()) cost.plainMs = plain.get<double>();
  return cost;
}

Json faceAgesToJson(const std::vector<FaceAges>& ages) {
  Json probes = Json::array();
  for (const FaceAges& faces : ages) {
    Json& probe = probes.emplace_back(Json::array());
    for (const std::int64_t age : faces) probe.push_back(age < 0 ? Json() : Json(age));
  }
  return probes;
}

std::vector<FaceAges> faceAgesFromJson(const Json& json) {
  std::vector<FaceAges> ages;
  for (const Json& probe : json) {
    FaceAges& faces = ages.emplace_back();
    for (std::size_t face = 0; face < faces.size(); ++face)
      faces[face] = probe.at(face).is_null() ? -1 : probe.at(face).get<std::int64_t>();
  }
  return ages;
}

constexpr Field<MaterialError, double> kMaterialNumbers[] = {
    {"mse", &MaterialError::mse},          {"relmse", &MaterialError::relmse}, {"bias", &MaterialError::bias},
    {"flip_hdr", &MaterialError::flipHdr}, {"share", &MaterialError::share},
};

Json materialsToJson(const std::vector<MaterialError>& materials) {
  Json json = Json::array();
  for (const MaterialError& error : materials) {
    Json entry = {{"material", error.material}, {"pixels", error.pixels}};
    for (const auto& field : kMaterialNumbers) entry[field.key] = encodeNumber(error.*field.member);
    json.push_back(std::move(entry));
  }
  return json;
}

std::vector<MaterialError> materialsFromJson(const Json& json) {
  std::vector<MaterialError> materials;
  for (const Json& entry : json) {
    MaterialError& error = materials.emplace_back();
    error.material = entry.at("material").get<std::string>();
    error.pixels = entry.at("pixels").get<std::int64_t>();
    for (const auto& field : kMaterialNumbers) error.*field.member = decodeNumber(entry.at(field.key));
  }
  return materials;
}

constexpr Field<CellPictures, std::string> kPictureFiles[] = {
    {"reference", &CellPictures::reference},
    {"rendered", &CellPictures::rendered},
    {"flip", &CellPictures::flip},
};

// Without those that were not kept.
Json picturesToJson(const CellPictures& pictures) {
  Json json = Json::object();
  for (const auto& field : kPictureFiles)
    if (!(pictures.*field.member).empty()) json[field.key] = pictures.*field.member;
  return json;
}

CellPictures picturesFromJson(const Json& json) {
  CellPictures pictures;
  for (const auto& field : kPictureFiles) pictures.*field.member = json.value(field.key, std::string());
  return pictures;
}

CellResult cellFromJson(const Json& json) {
  CellResult cell;
  cell.scene = json.at("scene").get<std::string>();
  cell.camera = json.at("camera").get<std::string>();
  cell.frame = json.at("frame").get<int>();
  cell.technique = axisValuesFromJson(json.at("technique"));
  cell.metrics = metricsFromJson(json.at("metrics"));
  if (const Json& mask = json.at("mask_metrics"); !mask.is_null()) cell.maskMetrics = metricsFromJson(mask);
  cell.floor = metricValuesFromJson(json.at("floor"));
  cell.maskFloor = metricValuesFromJson(json.at("mask_floor"));
  cell.unbiased = metricValuesFromJson(json.at("unbiased"));
  cell.cost = costFromJson(json.at("cost"));
  if (const auto reported = json.find("reported_cost"); reported != json.end())
    cell.reportedCost = reportedCostFromJson(*reported);
  cell.counters = countersFromJson(json.at("counters"));
  cell.faceAgeFrames = faceAgesFromJson(json.at("face_age_frames"));
  // Files from before they were recorded don't have them.
  if (const auto coats = json.find("coats_of_probes"); coats != json.end())
    cell.coatsOfProbes = coats->get<std::vector<int>>();
  if (const auto materials = json.find("materials"); materials != json.end())
    cell.materials = materialsFromJson(*materials);
  if (const auto pictures = json.find("pictures"); pictures != json.end()) cell.pictures = picturesFromJson(*pictures);
  return cell;
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

Json axisValuesToJson(const AxisValues& values) { return objectOf(values); }

AxisValues axisValuesFromJson(const Json& json) { return pairsOf<std::string>(json); }

Json countersToJson(const std::vector<std::pair<std::string, std::int64_t>>& counters) { return objectOf(counters); }

std::vector<std::pair<std::string, std::int64_t>> countersFromJson(const Json& json) {
  return pairsOf<std::int64_t>(json);
}

Json cellToJson(const CellResult& cell) {
  Json json;
  json["scene"] = cell.scene;
  json["camera"] = cell.camera;
  json["frame"] = cell.frame;
  json["technique"] = axisValuesToJson(cell.technique);
  json["metrics"] = metricsToJson(cell.metrics);
  json["mask_metrics"] = cell.maskMetrics ? metricsToJson(*cell.maskMetrics) : nullptr;
  json["floor"] = metricValuesToJson(cell.floor);
  json["mask_floor"] = metricValuesToJson(cell.maskFloor);
  json["unbiased"] = metricValuesToJson(cell.unbiased);
  json["cost"] = costToJson(cell.cost);
  if (cell.reportedCost) json["reported_cost"] = reportedCostToJson(*cell.reportedCost);
  json["counters"] = countersToJson(cell.counters);
  json["face_age_frames"] = faceAgesToJson(cell.faceAgeFrames);
  json["coats_of_probes"] = cell.coatsOfProbes;
  json["materials"] = materialsToJson(cell.materials);
  if (cell.pictures != CellPictures()) json["pictures"] = picturesToJson(cell.pictures);
  return json;
}

std::string toJson(const CellResult& cell) { return printLine(cellToJson(cell)); }

CellResult cellFromJson(const std::string& text, const std::string& place) {
  return cellFromJson(parsePart(text, place, R"({"$ref": "results.schema.json#/definitions/cell"})"));
}

std::string toJson(const Results& results) {
  Json head;
  head["schema_version"] = kResultsSchemaVersion;
  head["provenance"] = provenanceToJson(results.provenance);
  head["tolerance"] = tolerancesToJson(results.tolerance);
  std::vector<Json> rows;
  for (const CellResult& cell : results.cells) rows.push_back(cellToJson(cell));
  return printDocument(head, "cells", rows);
}

Results resultsFromJson(const std::string& text, const std::string& place) {
  const Json document = parseDocument(text, place, kFormat);
  Results results;
  results.provenance = provenanceFromJson(document.at("provenance"));
  results.tolerance = tolerancesFromJson(document.at("tolerance"));
  for (const Json& cell : document.at("cells")) results.cells.push_back(cellFromJson(cell));
  requireDistinctKeys(results.cells, place);
  return results;
}

}  // namespace pb
