#include <fmt/format.h>

#include <algorithm>

#include "bench/results.h"
#include "bench/results_json.h"

namespace pb {
namespace {

// Cells of one run may have different axes (`--set` on one shard): the union, in the order of first use, of those that
// don't stand at their default everywhere.
std::vector<std::string> axesOf(const std::vector<CellResult>& cells, const AxisValues& defaults) {
  std::vector<std::string> axes;
  for (const CellResult& cell : cells)
    for (const auto& setting : cell.technique)
      if (std::ranges::find(axes, setting.first) == axes.end() &&
          std::ranges::find(defaults, setting) == defaults.end())
        axes.push_back(setting.first);
  return axes;
}

std::string axisValue(const CellResult& cell, const std::string& axis) {
  const auto found = std::ranges::find(cell.technique, axis, [](const auto& pair) { return pair.first; });
  return found == cell.technique.end() ? "" : found->second;
}

// RFC 4180.
std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csvValue(const Json& value) {
  if (value.is_null()) return "";
  return csvField(value.is_string() ? value.get<std::string>() : printLine(value));
}

// One row for each number in `value`; nested keys are joined by points: flip_hdr.mean.
void appendRows(const std::string& prefix, const std::string& name, const Json& value, std::string& csv) {
  if (!value.is_structured()) {
    csv += prefix + csvField(name) + ',' + csvValue(value) + '\n';
    return;
  }
  for (const auto& [key, child] : value.items())
    appendRows(prefix, name.empty() ? key : fmt::format("{}.{}", name, key), child, csv);
}

struct Region {
  const char* jsonKey;
  const char* name;
  const char* metric;  // name of the value where the JSON holds a bare array
};

constexpr Region kRegions[] = {
    {"metrics", "whole", ""},       {"mask_metrics", "mask", ""},
    {"floor", "floor", ""},         {"mask_floor", "mask_floor", ""},
    {"unbiased", "unbiased", ""},   {"flicker", "flicker", ""},
    {"cost", "cost", ""},           {"reported_cost", "reported_cost", ""},
    {"counters", "counter", ""},    {"coats_of_probes", "probe", "coats"},
    {"integrity", "integrity", ""},
};

// Entries of an array, each a region of its own, named after the entry's number (from 1 on) or its `nameKey`.
void appendEntries(const std::string& prefix, const std::string& region, const char* nameKey, const Json& entries,
                   std::string& csv) {
  int number = 0;
  for (Json entry : entries) {
    ++number;
    const std::string name = nameKey == nullptr ? std::to_string(number) : entry.at(nameKey).get<std::string>();
    if (nameKey != nullptr) entry.erase(nameKey);
    appendRows(fmt::format("{}{},", prefix, csvField(region + " " + name)), "", entry, csv);
  }
}

void appendMatched(const std::string& prefix, const Json& matched, std::string& csv) {
  constexpr Region kMatchedRegions[] = {{"metrics", "matched", ""},
                                        {"mask_metrics", "matched_mask", ""},
                                        {"floor", "matched_floor", ""},
                                        {"mask_floor", "matched_mask_floor", ""}};
  appendRows(prefix + "matched,", "depth", matched.at("depth"), csv);
  for (const Region& region : kMatchedRegions)
    if (const Json& values = matched.at(region.jsonKey); !values.is_null())
      appendRows(fmt::format("{}{},", prefix, region.name), "", values, csv);
}

void appendIntervals(const std::string& prefix, const char* region, const MetricIntervals& intervals,
                     std::string& csv) {
  for (const auto& [metric, interval] : intervals)
    appendRows(fmt::format("{}{},", prefix, region), metric,
               {{"low", encodeNumber(interval.low)}, {"high", encodeNumber(interval.high)}}, csv);
}

std::string prefixOf(const CellResult& cell, const std::vector<std::string>& axes) {
  std::string prefix = fmt::format("{},{},{},", csvField(cell.scene), csvField(cell.camera), cell.frame);
  for (const std::string& axis : axes) prefix += csvField(axisValue(cell, axis)) + ',';
  return prefix;
}

void appendAttribution(const Attribution& attribution, const std::vector<std::string>& axes, std::string& csv) {
  CellResult cell;
  cell.scene = attribution.scene;
  cell.camera = attribution.camera;
  cell.frame = attribution.frame;
  cell.technique = attribution.technique;
  const std::string prefix = prefixOf(cell, axes);
  const auto append = [&](const char* region, const AttributionStep& step, const MetricValues& values) {
    for (const auto& [metric, value] : values)
      appendRows(prefix + csvField(fmt::format("{} {}", region, step.step)) + ',', metric, encodeNumber(value), csv);
  };
  for (const AttributionStep& step : attribution.steps) {
    append("attribution", step, step.metrics);
    append("attribution_mask", step, step.maskMetrics);
  }
}

void appendCell(const CellResult& cell, const std::vector<std::string>& axes, std::string& csv) {
  const std::string prefix = prefixOf(cell, axes);
  const Json json = cellToJson(cell);
  for (const Region& region : kRegions) {
    const Json values = json.value(region.jsonKey, Json());  // null where a cell doesn't have it
    if (!values.is_null()) appendRows(fmt::format("{}{},", prefix, region.name), region.metric, values, csv);
  }
  for (std::size_t probe = 0; probe < cell.faceAgeFrames.size(); ++probe)
    if (const std::optional<AgeSummary> ages = summaryOf({cell.faceAgeFrames[probe]}))
      appendRows(prefix + "probe,", fmt::format("face_age_frames.{}", probe),
                 {{"mean", ages->mean}, {"max", ages->largest}}, csv);
  appendIntervals(prefix, "interval", cell.intervals, csv);
  appendIntervals(prefix, "mask_interval", cell.maskIntervals, csv);
  if (cell.matched) appendMatched(prefix, json.at("matched"), csv);
  appendEntries(prefix, "material", "material", json.at("materials"), csv);
  appendEntries(prefix, "object", "object", json.value("objects", Json::array()), csv);
  appendEntries(prefix, "cluster", nullptr, json.value("clusters", Json::array()), csv);
}

}  // namespace

std::string toCsv(const Results& results, const AxisValues& defaults) {
  const std::vector<std::string> axes = axesOf(results.cells, defaults);
  std::string csv = "scene,camera,frame,";
  for (const std::string& axis : axes) csv += csvField(axis) + ',';
  csv += "region,metric,value\n";
  for (const CellResult& cell : results.cells) appendCell(cell, axes, csv);
  for (const Attribution& attribution : results.attribution) appendAttribution(attribution, axes, csv);
  return csv;
}

}  // namespace pb
