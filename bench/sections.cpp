#include "bench/sections.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace pb {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr double kClearOfFloor = 10.0;
constexpr char kFloorMetric[] = "relmse";

std::vector<VaryingAxis> axesOf(const std::vector<Sequence>& sequences) {
  std::vector<VaryingAxis> axes;
  for (const Sequence& sequence : sequences)
    for (const auto& [name, value] : sequence.front()->technique) {
      auto axis = std::ranges::find(axes, name, &VaryingAxis::name);
      if (axis == axes.end()) axis = axes.insert(axes.end(), VaryingAxis{name, {}});
      if (std::ranges::find(axis->values, value) == axis->values.end()) axis->values.push_back(value);
    }
  return axes;
}

bool hasMask(const Sequence& sequence) {
  return std::ranges::any_of(sequence, [](const CellResult* cell) { return cell->maskMetrics.has_value(); });
}

void describe(Section& section) {
  for (VaryingAxis& axis : axesOf(section.sequences)) {
    if (axis.values.size() == 1)
      section.fixed.push_back(axis.name + "=" + axis.values.front());
    else
      section.axes.push_back(std::move(axis));
  }
  const auto any = [&](const auto& predicate) {
    return std::ranges::any_of(section.sequences, predicate) || std::ranges::any_of(section.externals, predicate);
  };
  if (any(hasMask)) section.region = Region::mask;
  section.severalFrames = any([](const Sequence& s) { return s.size() > 1; });
}

bool isExternal(const CellResult& cell) {
  return !cell.technique.empty() && cell.technique.front().first == kExternalAxis;
}

template <class Value>
double meanOver(const Sequence& sequence, Value value) {
  double sum = 0;
  int count = 0;
  for (const CellResult* cell : sequence)
    if (const std::optional<double> number = value(*cell)) {
      sum += *number;
      ++count;
    }
  return count > 0 ? sum / count : kUndefined;
}

bool isClearOfFloor(const CellResult& cell, Region region) {
  const std::optional<double> error = errorOf(cell, region, kFloorMetric);
  const MetricValues& floors = region == Region::whole ? cell.floor : cell.maskFloor;
  const auto floor = std::ranges::find(floors, kFloorMetric, [](const auto& pair) { return pair.first; });
  return !error || floor == floors.end() || *error >= kClearOfFloor * floor->second;
}

}  // namespace

std::vector<Section> sectionsOf(const std::vector<CellResult>& cells) {
  std::vector<Section> sections;
  std::map<std::pair<std::string, std::string>, std::size_t> sectionByView;
  std::map<std::string, std::size_t> sequenceByKey;
  for (const CellResult& cell : cells) {
    const auto [view, newView] = sectionByView.try_emplace({cell.scene, cell.camera}, sections.size());
    if (newView) sections.emplace_back();
    Section& section = sections[view->second];
    std::vector<Sequence>& sequences = isExternal(cell) ? section.externals : section.sequences;
    const auto [key, newKey] = sequenceByKey.try_emplace(cell.sequenceKey(), sequences.size());
    if (newKey) sequences.emplace_back();
    sequences[key->second].push_back(&cell);
  }
  std::ranges::for_each(sections, describe);
  return sections;
}

std::string axisValue(const Sequence& sequence, const std::string& axis) {
  for (const auto& [name, value] : sequence.front()->technique)
    if (name == axis) return value;
  return "";
}

std::optional<double> errorOf(const CellResult& cell, Region region, const std::string& metric) {
  if (region == Region::whole) return metricValue(cell.metrics, metric);
  return cell.maskMetrics ? metricValue(*cell.maskMetrics, metric) : std::nullopt;
}

std::optional<double> counterOf(const CellResult& cell, const std::string& name) {
  for (const auto& [counter, value] : cell.counters)
    if (counter == name) return static_cast<double>(value);
  return std::nullopt;
}

std::optional<double> faceAgeOf(const CellResult& cell) {
  const std::optional<AgeSummary> ages = summaryOf(cell.faceAgeFrames);
  return ages ? std::optional(ages->mean) : std::nullopt;
}

double meanError(const Sequence& sequence, Region region, const std::string& metric) {
  return meanOver(sequence, [&](const CellResult& cell) { return errorOf(cell, region, metric); });
}

double largestError(const Sequence& sequence, Region region, const std::string& metric) {
  double largest = kUndefined;  // fmax prefers the number
  for (const CellResult* cell : sequence)
    largest = std::fmax(largest, errorOf(*cell, region, metric).value_or(kUndefined));
  return largest;
}

double meanCounter(const Sequence& sequence, const std::string& name) {
  return meanOver(sequence, [&](const CellResult& cell) { return counterOf(cell, name); });
}

double meanFaceAge(const Sequence& sequence) { return meanOver(sequence, faceAgeOf); }

double largestFaceAge(const Sequence& sequence) {
  double largest = kUndefined;  // fmax prefers the number
  for (const CellResult* cell : sequence)
    if (const std::optional<AgeSummary> ages = summaryOf(cell->faceAgeFrames))
      largest = std::fmax(largest, static_cast<double>(ages->largest));
  return largest;
}

double costRank(const CellResult& cell) {
  return cell.cost ? cell.cost->ratio : std::numeric_limits<double>::infinity();
}

bool isFreeOfNoise(const CellResult& cell, Region region) {
  const MetricValues& floor = region == Region::mask ? cell.maskFloor : cell.floor;
  return !floor.empty() && std::ranges::all_of(floor, [](const auto& entry) { return entry.second == 0; });
}

bool isClearOfFloor(const Sequence& sequence, Region region) {
  return std::ranges::all_of(sequence, [&](const CellResult* cell) { return isClearOfFloor(*cell, region); });
}

}  // namespace pb
