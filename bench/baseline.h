// Stored baselines: what the gate needs of a blessed run, and why it was blessed. Schema:
// results/schema/baseline.schema.json.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/results.h"
#include "bench/tolerance.h"

namespace pb {

inline constexpr int kBaselineSchemaVersion = 1;

using GatedMetrics = std::vector<std::pair<std::string, std::optional<double>>>;

struct BaselineCell {
  std::string key;  // of the cell, shortKey() of CellResult::key()
  GatedMetrics metrics;
  std::optional<GatedMetrics> maskMetrics;
  std::vector<std::pair<std::string, std::int64_t>> counters;
  MetricValues integrity;  // empty in files from before it was stored, and where it is not gated
};

struct BaselineCost {
  double ratio = 0, ratioLow = 0, ratioHigh = 0;
  std::vector<double> ratios;  // of the repetitions; empty in files from before they were stored
};

struct Baseline {
  std::string reason, blessedAt;  // UTC, ISO 8601
  Provenance provenance;
  Tolerances tolerance;
  AxisValues defaults;  // what axes stand at that the keys don't name; empty in files from before it was stored
  std::vector<BaselineCell> cells;
  std::map<std::string, BaselineCost> costs;  // by shortKey() of CellResult::sequenceKey()
  Tolerances warnTolerance;
  SceneTolerances sceneTolerances;
};

// `defaults`: of every axis.
Baseline makeBaseline(const Results& run, const std::string& reason, const std::string& blessedAt,
                      const AxisValues& defaults = {});

// One cell a line, so that version control shows what a blessing changed. Inverse to each other.
std::string toJson(const Baseline& baseline);
Baseline baselineFromJson(const std::string& text, const std::string& place);
Baseline readBaseline(const std::string& path);

// Writes the baseline of a run. Throws an input Error for an empty reason, a run without cells or tolerances, and one
// whose control did not pass; unless `force`, also an inconclusive Error for references that missed max_noise and an
// input Error for another GL driver or other libraries than those of the baseline that is there.
void bless(const Results& run, const std::string& baselinePath, const std::string& reason, bool force,
           const AxisValues& defaults = {});

}  // namespace pb
