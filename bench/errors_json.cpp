#include "bench/cell_json.h"
#include "bench/metrics/metrics_json.h"

namespace pb {
namespace {

constexpr Field<RegionErrors, double> kRegionNumbers[] = {
    {"mse", &RegionErrors::mse},          {"relmse", &RegionErrors::relmse}, {"bias", &RegionErrors::bias},
    {"flip_hdr", &RegionErrors::flipHdr}, {"share", &RegionErrors::share},
};

constexpr Field<ErrorCluster, int> kClusterBox[] = {{"x", &ErrorCluster::x},
                                                    {"y", &ErrorCluster::y},
                                                    {"width", &ErrorCluster::width},
                                                    {"height", &ErrorCluster::height}};

void addRegion(const RegionErrors& errors, Json& json) {
  json["pixels"] = errors.pixels;
  for (const auto& field : kRegionNumbers) json[field.key] = encodeNumber(errors.*field.member);
}

void readRegion(const Json& json, RegionErrors& errors) {
  errors.pixels = json.at("pixels").get<std::int64_t>();
  for (const auto& field : kRegionNumbers) errors.*field.member = decodeNumber(json.at(field.key));
}

}  // namespace

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

Json intervalsToJson(const MetricIntervals& intervals) {
  Json json = Json::object();
  for (const auto& [key, interval] : intervals)
    json[key] = Json::array({encodeNumber(interval.low), encodeNumber(interval.high)});
  return json;
}

MetricIntervals intervalsFromJson(const Json& json) {
  MetricIntervals intervals;
  for (const auto& [key, bounds] : json.items())
    intervals.emplace_back(key, Interval{decodeNumber(bounds.at(0)), decodeNumber(bounds.at(1))});
  return intervals;
}

Json replicatesToJson(const MetricReplicates& replicates) {
  Json json = Json::object();
  for (const auto& [key, values] : replicates) {
    Json& array = json[key] = Json::array();
    for (const double value : values) array.push_back(encodeNumber(value));
  }
  return json;
}

MetricReplicates replicatesFromJson(const Json& json) {
  MetricReplicates replicates;
  for (const auto& [key, array] : json.items()) {
    std::vector<double>& values = replicates.emplace_back(key, std::vector<double>()).second;
    for (const Json& value : array) values.push_back(decodeNumber(value));
  }
  return replicates;
}

Json matchedToJson(const MatchedErrors& matched) {
  return {{"depth", matched.depth},
          {"converged", matched.converged},
          {"metrics", metricsToJson(matched.metrics)},
          {"mask_metrics", matched.maskMetrics ? metricsToJson(*matched.maskMetrics) : Json()},
          {"floor", metricValuesToJson(matched.floor)},
          {"mask_floor", metricValuesToJson(matched.maskFloor)}};
}

MatchedErrors matchedFromJson(const Json& json) {
  MatchedErrors matched;
  matched.depth = json.at("depth").get<int>();
  matched.converged = json.at("converged").get<bool>();
  matched.metrics = metricsFromJson(json.at("metrics"));
  if (const Json& mask = json.at("mask_metrics"); !mask.is_null()) matched.maskMetrics = metricsFromJson(mask);
  matched.floor = metricValuesFromJson(json.at("floor"));
  matched.maskFloor = metricValuesFromJson(json.at("mask_floor"));
  return matched;
}

Json materialsToJson(const std::vector<MaterialError>& materials) {
  Json json = Json::array();
  for (const MaterialError& error : materials) {
    Json& entry = json.emplace_back(Json::object({{"material", error.material}}));
    addRegion(error, entry);
  }
  return json;
}

std::vector<MaterialError> materialsFromJson(const Json& json) {
  std::vector<MaterialError> materials;
  for (const Json& entry : json) {
    MaterialError& error = materials.emplace_back();
    error.material = entry.at("material").get<std::string>();
    readRegion(entry, error);
  }
  return materials;
}

Json objectsToJson(const std::vector<ObjectError>& objects) {
  Json json = Json::array();
  for (const ObjectError& error : objects) {
    Json& entry = json.emplace_back(Json::object({{"object", error.object}, {"material", error.material}}));
    addRegion(error, entry);
    if (error.probe) entry["probe"] = *error.probe;
    if (error.probeDistance) entry["probe_distance"] = *error.probeDistance;
    entry["roughness"] = error.roughness;
  }
  return json;
}

std::vector<ObjectError> objectsFromJson(const Json& json) {
  std::vector<ObjectError> objects;
  for (const Json& entry : json) {
    ObjectError& error = objects.emplace_back();
    error.object = entry.at("object").get<std::string>();
    error.material = entry.at("material").get<std::string>();
    readRegion(entry, error);
    if (const auto probe = entry.find("probe"); probe != entry.end()) error.probe = probe->get<int>();
    if (const auto distance = entry.find("probe_distance"); distance != entry.end())
      error.probeDistance = distance->get<double>();
    error.roughness = entry.at("roughness").get<double>();
  }
  return objects;
}

Json clustersToJson(const std::vector<ErrorCluster>& clusters) {
  Json json = Json::array();
  for (const ErrorCluster& cluster : clusters) {
    Json& entry = json.emplace_back(Json::object());
    for (const auto& field : kClusterBox) entry[field.key] = cluster.*field.member;
    entry["pixels"] = cluster.pixels;
    entry["share"] = cluster.share;
    entry["object"] = cluster.object;
  }
  return json;
}

std::vector<ErrorCluster> clustersFromJson(const Json& json) {
  std::vector<ErrorCluster> clusters;
  for (const Json& entry : json) {
    ErrorCluster& cluster = clusters.emplace_back();
    for (const auto& field : kClusterBox) cluster.*field.member = entry.at(field.key).get<int>();
    cluster.pixels = entry.at("pixels").get<std::int64_t>();
    cluster.share = entry.at("share").get<double>();
    cluster.object = entry.at("object").get<std::string>();
  }
  return clusters;
}

Json flickerToJson(const Flicker& flicker) {
  return {{"whole", flicker.whole}, {"mask", flicker.mask ? Json(*flicker.mask) : Json()}};
}

Flicker flickerFromJson(const Json& json) {
  Flicker flicker{json.at("whole").get<double>()};
  if (const Json& mask = json.at("mask"); !mask.is_null()) flicker.mask = mask.get<double>();
  return flicker;
}

}  // namespace pb
