// The gate: compares a run with a stored baseline and says whether it is the same. Rules: docs/gate.md.
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bench/baseline.h"
#include "bench/results.h"

namespace pb {

// A cost ratio counts as changed when its interval does not overlap the baseline's, and the change is larger than both
// of these: 25 % either way, and 0.2 ms of this machine's frame time.
inline constexpr double kCostRelativeFloor = 0.25;
inline constexpr double kCostAbsoluteFloorMs = 0.2;

enum class FindingKind { changed, missing, surplus, counter, cost, control };

// One thing that differs from the baseline by more than it may.
struct Finding {
  FindingKind kind = FindingKind::changed;
  std::string cell;                     // shortKey() of the cell or sequence; empty for `control`
  std::string quantity;                 // "flip_hdr", "mask flip_hdr", "draws", "cost ratio", ...
  std::optional<double> before, after;  // as stored and as measured; nullopt: undefined or not there
  double limit = 0;                     // largest allowed |after - before|
  double excess = 0;                    // |after - before| / limit: what changed most has the largest
};

// Exit codes 0, 1, 4, 4. inconclusive: nothing differs, but some references are too noisy to say so; drift: nothing
// differs, but another driver made the baseline, so that counters were not compared.
enum class Verdict { pass, fail, inconclusive, drift };

struct GateReport {
  Verdict verdict = Verdict::pass;
  std::vector<Finding> findings;     // the largest excess first
  std::vector<std::string> notes;    // one sentence each: what was not compared and why, what else differs
  std::vector<std::string> cells;    // every cell of either side, by shortKey()
  std::set<std::string> noisyCells;  // those of the run whose reference missed max_noise
  bool sameDriver = true;
  std::size_t metricsCompared = 0, countersCompared = 0, costsCompared = 0;
};

// `defaults`: of every axis; what cells stood at that were measured before an axis was added.
GateReport check(const Results& run, const Baseline& baseline, const AxisValues& defaults = {});
int exitCode(Verdict verdict);

// Markdown for people; `blessCommand` is printed when something differs.
std::string printGateReport(const GateReport& report, const std::string& blessCommand);
std::string toJson(const GateReport& report);
std::string toJUnit(const GateReport& report, const std::string& suiteName);  // one test case a cell

}  // namespace pb
