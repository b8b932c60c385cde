#include "bench/results.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "bench/results_json.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/spec.h"

namespace pb {
namespace {

std::vector<std::string> metricKeys() {
  std::vector<std::string> keys;
  for (const MetricInfo& metric : metricTable()) keys.push_back(metric.key);
  return keys;
}

std::string axesText(const CellResult& cell) {
  std::string text;
  for (const auto& [axis, value] : cell.technique) text += fmt::format(" {}={}", axis, value);
  return text;
}

// relMSE of the reference's floor.
std::optional<double> noiseOf(const CellResult& cell) {
  const auto found = std::ranges::find(cell.floor, "relmse", &MetricValues::value_type::first);
  return found == cell.floor.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

std::optional<AgeSummary> summaryOf(const std::vector<FaceAges>& ages) {
  std::int64_t sum = 0, count = 0, largest = 0;
  for (const FaceAges& faces : ages)
    for (const std::int64_t age : faces) {
      if (age < 0) continue;
      sum += age;
      ++count;
      largest = std::max(largest, age);
    }
  if (count == 0) return std::nullopt;
  return AgeSummary{static_cast<double>(sum) / static_cast<double>(count), largest};
}

std::optional<double> metricValue(const Metrics& metrics, const std::string& key) {
  const auto& table = metricTable();
  const auto found = std::ranges::find(table, key, &MetricInfo::key);
  if (found == table.end()) throwInputError("metric {}", unknownMessage(key, metricKeys()));
  return found->value(metrics);
}

bool isLowerBetter(const std::string& key) {
  const auto& table = metricTable();
  const auto found = std::ranges::find(table, key, &MetricInfo::key);
  return found == table.end() || found->lowerIsBetter;
}

std::string CellResult::sequenceKey() const {
  return fmt::format("scene={} camera={}{}", scene, camera, axesText(*this));
}

std::string CellResult::key() const {
  return fmt::format("scene={} camera={} frame={}{}", scene, camera, frame, axesText(*this));
}

std::string shortKey(const std::string& key, const AxisValues& defaults) {
  // The camera is the last of what is not an axis and has a free name.
  const std::size_t camera = std::min(key.rfind(" camera="), key.size());
  std::string axes = key.substr(camera) + ' ';
  for (const auto& [axis, value] : defaults) {
    const std::string text = fmt::format(" {}={}", axis, value);
    if (const std::size_t at = axes.rfind(text + ' '); at != std::string::npos) axes.erase(at, text.size());
  }
  axes.pop_back();
  return key.substr(0, camera) + axes;
}

bool isTooNoisy(const CellResult& cell, const std::optional<double>& maxNoise) {
  const std::optional<double> noise = noiseOf(cell);
  return noise && maxNoise && !(*noise <= *maxNoise);
}

std::vector<NoisyReference> findNoisyReferences(const std::vector<CellResult>& cells,
                                                const std::optional<double>& maxNoise) {
  std::vector<NoisyReference> noisy;
  std::set<std::tuple<std::string, std::string, int>> seen;
  for (const CellResult& cell : cells)
    if (isTooNoisy(cell, maxNoise) && seen.emplace(cell.scene, cell.camera, cell.frame).second)
      noisy.push_back({cell.scene, cell.camera, cell.frame, *noiseOf(cell)});
  return noisy;
}

Results readResults(const std::string& runDirectory) {
  const std::string path = runDirectory + "/results.json";
  return resultsFromJson(readFile(path), path);
}

}  // namespace pb
