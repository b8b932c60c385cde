// The gate: compares a run with a stored baseline and says whether it is the same. Rules: docs/gate.md.
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

// A cost ratio counts as changed when its interval does not overlap the baseline's, and the change is larger than both
// of these: 25 % either way, and 0.2 ms of this machine's frame time.
inline constexpr double kCostRelativeFloor = 0.25;
inline constexpr double kCostAbsoluteFloorMs = 0.2;

using GatedMetrics = std::vector<std::pair<std::string, std::optional<double>>>;

struct BaselineCell {
  std::string key;  // CellResult::key()
  GatedMetrics metrics;
  std::optional<GatedMetrics> maskMetrics;
  std::vector<std::pair<std::string, std::int64_t>> counters;
};

struct BaselineCost {
  double ratio = 0, ratioLow = 0, ratioHigh = 0;
};

// What the gate needs of a blessed run, and why it was blessed.
struct Baseline {
  std::string reason, blessedAt;  // UTC, ISO 8601
  Provenance provenance;
  Tolerances tolerance;
  std::vector<BaselineCell> cells;
  std::map<std::string, BaselineCost> costs;  // by CellResult::sequenceKey()
};

Baseline makeBaseline(const Results& run, const std::string& reason, const std::string& blessedAt);

// One cell a line, so that version control shows what a blessing changed. Inverse to each other.
std::string toJson(const Baseline& baseline);
Baseline baselineFromJson(const std::string& text, const std::string& place);
Baseline readBaseline(const std::string& path);

enum class FindingKind { changed, missing, surplus, counter, cost, control };

// One thing that differs from the baseline by more than it may.
struct Finding {
  FindingKind kind = FindingKind::changed;
  std::string cell;                     // cell or sequence key; empty for `control`
  std::string quantity;                 // "flip_hdr", "mask flip_hdr", "draws", "cost ratio", ...
  std::optional<double> before, after;  // as stored and as measured; nullopt: undefined or not there
  double limit = 0;                     // largest allowed |after - before|
  double excess = 0;                    // |after - before| / limit: what changed most has the largest
};

enum class Verdict { pass, fail, drift };  // exit codes 0, 1, 4

struct GateReport {
  Verdict verdict = Verdict::pass;
  std::vector<Finding> findings;   // the largest excess first
  std::vector<std::string> notes;  // one sentence each: what was not compared and why, what else differs
  std::vector<std::string> cells;  // every cell of either side
  std::size_t metricsCompared = 0, countersCompared = 0, costsCompared = 0;
};

GateReport check(const Results& run, const Baseline& baseline);
int exitCode(Verdict verdict);

// Markdown for people; `blessCommand` is printed when something differs.
std::string printGateReport(const GateReport& report, const std::string& blessCommand);
std::string toJson(const GateReport& report);
std::string toJUnit(const GateReport& report, const std::string& suiteName);  // one test case a cell

// Writes the baseline of a run. Throws an input Error for an empty reason, a run without cells, one whose control did
// not pass, and (unless `force`) another GL renderer or driver than that of the baseline that is there.
void bless(const Results& run, const std::string& baselinePath, const std::string& reason, bool force);

}  // namespace pb
