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
};

struct BaselineCost {
  double ratio = 0, ratioLow = 0, ratioHigh = 0;
};

struct Baseline {
  std::string reason, blessedAt;  // UTC, ISO 8601
  Provenance provenance;
  Tolerances tolerance;
  AxisValues defaults;  // what axes stand at that the keys don't name; empty in files from before it was stored
  std::vector<BaselineCell> cells;
  std::map<std::string, BaselineCost> costs;  // by shortKey() of CellResult::sequenceKey()
};

// `defaults`: of every axis.
Baseline makeBaseline(const Results& run, const std::string& reason, const std::string& blessedAt,
                      const AxisValues& defaults = {});

// One cell a line, so that version control shows what a blessing changed. Inverse to each other.
std::string toJson(const Baseline& baseline);
Baseline baselineFromJson(const std::string& text, const std::string& place);
Baseline readBaseline(const std::string& path);

// Whether counters and costs of the two are comparable at all: same GL renderer and version.
bool sameDriver(const Provenance& a, const Provenance& b);

// Writes the baseline of a run. Throws an input Error for an empty reason, a run without cells or tolerances, and one
// whose control did not pass; unless `force`, also an inconclusive Error for references that missed max_noise and an
// input Error for another GL renderer or driver than that of the baseline that is there.
void bless(const Results& run, const std::string& baselinePath, const std::string& reason, bool force,
           const AxisValues& defaults = {});

}  // namespace pb
