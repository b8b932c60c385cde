#include "bench/baseline.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <set>

#include "bench/cell_json.h"
#include "bench/platform.h"
#include "bench/results_json.h"
#include "bench/tolerance_json.h"
#include "results/schema/baseline.schema.h"
#include "scenes/error.h"
#include "scenes/files.h"

namespace pb {
namespace {

constexpr DocumentFormat kFormat{"baseline", "baseline_version", kBaselineSchemaVersion, schemas::kBaseline};

GatedMetrics gatedMetrics(const Metrics& metrics, const Tolerances& tolerance) {
  GatedMetrics gated;
  for (const auto& [key, limit] : tolerance)
    if (key != kIntegrityTolerance) gated.emplace_back(key, metricValue(metrics, key));
  return gated;
}

BaselineCell makeCell(const CellResult& cell, const Tolerances& tolerance, const AxisValues& defaults) {
  BaselineCell made{
      shortKey(cell.key(), defaults), gatedMetrics(cell.metrics, tolerance), std::nullopt, cell.counters, {}};
  if (cell.maskMetrics) made.maskMetrics = gatedMetrics(*cell.maskMetrics, tolerance);
  if (findTolerance(tolerance, kIntegrityTolerance) != nullptr) made.integrity = cell.integrity;
  return made;
}

Json gatedMetricsToJson(const GatedMetrics& metrics) {
  Json json = Json::object();
  for (const auto& [key, value] : metrics) json[key] = value ? encodeNumber(*value) : nullptr;
  return json;
}

GatedMetrics gatedMetricsFromJson(const Json& json) {
  GatedMetrics metrics;
  for (const auto& [key, value] : json.items())
    metrics.emplace_back(key, value.is_null() ? std::nullopt : std::optional(decodeNumber(value)));
  return metrics;
}

Json baselineCellToJson(const BaselineCell& cell) {
  Json json;
  json["key"] = cell.key;
  json["metrics"] = gatedMetricsToJson(cell.metrics);
  json["mask_metrics"] = cell.maskMetrics ? gatedMetricsToJson(*cell.maskMetrics) : nullptr;
  json["counters"] = countersToJson(cell.counters);
  if (!cell.integrity.empty()) json["integrity"] = metricValuesToJson(cell.integrity);
  return json;
}

BaselineCell baselineCellFromJson(const Json& json) {
  BaselineCell cell{json.at("key").get<std::string>(),
                    gatedMetricsFromJson(json.at("metrics")),
                    std::nullopt,
                    countersFromJson(json.at("counters")),
                    {}};
  if (const auto integrity = json.find("integrity"); integrity != json.end())
    cell.integrity = metricValuesFromJson(*integrity);
  if (const Json& mask = json.at("mask_metrics"); !mask.is_null()) cell.maskMetrics = gatedMetricsFromJson(mask);
  return cell;
}

Json baselineCostToJson(const BaselineCost& cost) {
  Json json = {{"ratio", cost.ratio}, {"ratio_low", cost.ratioLow}, {"ratio_high", cost.ratioHigh}};
  if (!cost.ratios.empty()) json["ratios"] = cost.ratios;
  return json;
}

BaselineCost baselineCostFromJson(const Json& json) {
  return {json.at("ratio").get<double>(), json.at("ratio_low").get<double>(), json.at("ratio_high").get<double>(),
          json.value("ratios", std::vector<double>())};
}

// A metric that was edited out of one cell would silently not be compared.
void requireGatedMetrics(const GatedMetrics& metrics, const Baseline& baseline, const BaselineCell& cell,
                         const std::string& place) {
  const auto keyOf = [](const auto& pair) { return pair.first; };
  Tolerances ofMetrics = baseline.tolerance;
  std::erase_if(ofMetrics, [](const auto& pair) { return pair.first == kIntegrityTolerance; });
  if (!std::ranges::equal(metrics, ofMetrics, {}, keyOf, keyOf))
    throwInputError("a baseline cell holds exactly the metrics that have a tolerance, '{}' does not in cell '{}'",
                    place, cell.key);
}

// Warning levels and those of scenes belong to metrics that can fail.
void requireGated(const Tolerances& tolerances, const Baseline& baseline, const std::string& place) {
  for (const auto& [metric, tolerance] : tolerances)
    if (findTolerance(baseline.tolerance, metric) == nullptr)
      throwInputError("'{}' has a level for '{}', which has no tolerance there", place, metric);
}

void requireConsistent(const Baseline& baseline, const std::string& place) {
  for (const auto& [key, limit] : baseline.tolerance)
    if (key != kIntegrityTolerance) metricValue({}, key);
  requireGated(baseline.warnTolerance, baseline, place);
  for (const auto& [scope, levels] : baseline.sceneTolerances)
    for (const Tolerances& level : {levels.fail, levels.warn}) requireGated(level, baseline, place);
  std::set<std::string> keys;
  for (const BaselineCell& cell : baseline.cells) {
    if (!keys.insert(cell.key).second) throwInputError("a cell may stand once in '{}', twice: {}", place, cell.key);
    requireGatedMetrics(cell.metrics, baseline, cell, place);
    if (cell.maskMetrics) requireGatedMetrics(*cell.maskMetrics, baseline, cell, place);
    if (!cell.integrity.empty() && findTolerance(baseline.tolerance, kIntegrityTolerance) == nullptr)
      throwInputError("'{}' holds the integrity of cell '{}' without a tolerance for it", place, cell.key);
  }
}

std::string utcNow() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

// What is no baseline may be one that a crash damaged, or a file that was named by mistake.
Baseline readReplaced(const std::string& path) {
  try {
    return readBaseline(path);
  } catch (const Error& error) {
    if (!std::filesystem::is_regular_file(path)) throw;
    throw Error(error.kind(), fmt::format("{}; --force replaces it", error.what()));
  }
}

void requireSamePlatform(const Provenance& run, const std::string& baselinePath) {
  const std::vector<PlatformDifference> differences = platformDifferences(readReplaced(baselinePath).provenance, run);
  if (!differences.empty())
    throwInputError("baseline '{}' was made on another platform: {}; --force replaces it", baselinePath,
                    describe(differences));
}

void requireQuietReferences(const Results& run) {
  const std::optional<double>& limit = run.provenance.maxNoise;
  const std::vector<NoisyReference> noisy = findNoisyReferences(run.cells, limit);
  if (noisy.empty()) return;
  const NoisyReference& first = noisy.front();
  throw Error(Failure::inconclusive,
              fmt::format("max_noise is {:g}, but {} references have more, the first is that of '{}' frame {} with "
                          "{:.3g}: --force blesses the run all the same",
                          *limit, noisy.size(), first.scene, first.frame, first.noise));
}

void requireBlessable(const Results& run, const std::string& reason) {
  if (reason.find_first_not_of(" \t\r\n") == std::string::npos)
    throwInputError("a blessing needs a reason, got '{}'", reason);
  if (run.cells.empty())
    throwInputError("a run without cells can't become a baseline, suite '{}'", run.provenance.suiteName);
  if (run.tolerance.empty())
    throwInputError("a run without tolerances can't become a baseline, suite '{}' has no [tolerance]",
                    run.provenance.suiteName);
  if (run.provenance.controlOutcome != kControlPassed)
    throwInputError("a run whose control did not pass can't become a baseline, its control: {}",
                    run.provenance.controlOutcome);
}

}  // namespace

Baseline makeBaseline(const Results& run, const std::string& reason, const std::string& blessedAt,
                      const AxisValues& defaults) {
  Baseline baseline{reason, blessedAt, run.provenance,    run.tolerance,      defaults,
                    {},     {},        run.warnTolerance, run.sceneTolerances};
  for (const CellResult& cell : run.cells) {
    baseline.cells.push_back(makeCell(cell, run.tolerance, defaults));
    if (cell.cost)
      baseline.costs[shortKey(cell.sequenceKey(), defaults)] = {cell.cost->ratio, cell.cost->ratioLow,
                                                                cell.cost->ratioHigh, cell.cost->ratios};
  }
  return baseline;
}

std::string toJson(const Baseline& baseline) {
  Json head;
  head["baseline_version"] = kBaselineSchemaVersion;
  head["reason"] = baseline.reason;
  head["blessed_at"] = baseline.blessedAt;
  head["provenance"] = provenanceToJson(baseline.provenance);
  writeTolerances(head, {baseline.tolerance, baseline.warnTolerance}, baseline.sceneTolerances);
  head["defaults"] = axisValuesToJson(baseline.defaults);
  head["costs"] = Json::object();
  for (const auto& [sequence, cost] : baseline.costs) head["costs"][sequence] = baselineCostToJson(cost);
  std::vector<Json> rows;
  for (const BaselineCell& cell : baseline.cells) rows.push_back(baselineCellToJson(cell));
  return printDocument(head, "cells", rows);
}

Baseline baselineFromJson(const std::string& text, const std::string& place) {
  const Json document = parseDocument(text, place, kFormat);
  Baseline baseline;
  baseline.reason = document.at("reason").get<std::string>();
  baseline.blessedAt = document.at("blessed_at").get<std::string>();
  baseline.provenance = provenanceFromJson(document.at("provenance"));
  ToleranceLevels levels = readTolerances(document);
  baseline.tolerance = std::move(levels.fail);
  baseline.warnTolerance = std::move(levels.warn);
  baseline.sceneTolerances = readSceneTolerances(document);
  if (const auto defaults = document.find("defaults"); defaults != document.end())
    baseline.defaults = axisValuesFromJson(*defaults);
  for (const auto& [sequence, cost] : document.at("costs").items())
    baseline.costs[sequence] = baselineCostFromJson(cost);
  for (const Json& cell : document.at("cells")) baseline.cells.push_back(baselineCellFromJson(cell));
  requireConsistent(baseline, place);
  return baseline;
}

Baseline readBaseline(const std::string& path) { return baselineFromJson(readFile(path), path); }

void bless(const Results& run, const std::string& baselinePath, const std::string& reason, bool force,
           const AxisValues& defaults) {
  requireBlessable(run, reason);
  if (!force) requireQuietReferences(run);
  if (!force && std::filesystem::exists(baselinePath)) requireSamePlatform(run.provenance, baselinePath);
  writeFileAtomically(baselinePath, toJson(makeBaseline(run, reason, utcNow(), defaults)));
}

}  // namespace pb
