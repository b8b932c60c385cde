#include "bench/cell_json.h"

#include "bench/metrics/metrics_json.h"
#include "bench/results_json.h"

namespace pb {
namespace {

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

// What files from before it was recorded, and cells that don't have it, leave out.
void addOptionalParts(const CellResult& cell, Json& json) {
  if (!cell.intervals.empty()) json["intervals"] = intervalsToJson(cell.intervals);
  if (!cell.maskIntervals.empty()) json["mask_intervals"] = intervalsToJson(cell.maskIntervals);
  if (!cell.replicates.empty()) json["replicates"] = replicatesToJson(cell.replicates);
  if (!cell.maskReplicates.empty()) json["mask_replicates"] = replicatesToJson(cell.maskReplicates);
  if (!cell.referenceHash.empty()) json["reference_hash"] = cell.referenceHash;
  if (cell.matched) json["matched"] = matchedToJson(*cell.matched);
  if (cell.pictures != CellPictures()) json["pictures"] = picturesToJson(cell.pictures);
  if (!cell.integrity.empty()) json["integrity"] = metricValuesToJson(cell.integrity);
  if (!cell.objects.empty()) json["objects"] = objectsToJson(cell.objects);
  if (!cell.clusters.empty()) json["clusters"] = clustersToJson(cell.clusters);
  if (cell.flicker) json["flicker"] = flickerToJson(*cell.flicker);
}

void readOptionalParts(const Json& json, CellResult& cell) {
  const auto read = [&](const char* key, auto& member, auto fromJson) {
    if (const auto part = json.find(key); part != json.end()) member = fromJson(*part);
  };
  const auto toText = [](const Json& part) { return part.get<std::string>(); };
  const auto toInts = [](const Json& part) { return part.get<std::vector<int>>(); };
  read("reported_cost", cell.reportedCost, reportedCostFromJson);
  read("coats_of_probes", cell.coatsOfProbes, toInts);
  read("materials", cell.materials, materialsFromJson);
  read("pictures", cell.pictures, picturesFromJson);
  read("integrity", cell.integrity, metricValuesFromJson);
  read("intervals", cell.intervals, intervalsFromJson);
  read("mask_intervals", cell.maskIntervals, intervalsFromJson);
  read("replicates", cell.replicates, replicatesFromJson);
  read("mask_replicates", cell.maskReplicates, replicatesFromJson);
  read("reference_hash", cell.referenceHash, toText);
  read("matched", cell.matched, matchedFromJson);
  read("objects", cell.objects, objectsFromJson);
  read("clusters", cell.clusters, clustersFromJson);
  read("flicker", cell.flicker, flickerFromJson);
}

}  // namespace

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
  addOptionalParts(cell, json);
  return json;
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
  cell.counters = countersFromJson(json.at("counters"));
  cell.faceAgeFrames = faceAgesFromJson(json.at("face_age_frames"));
  readOptionalParts(json, cell);
  return cell;
}

}  // namespace pb
