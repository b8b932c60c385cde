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

enum class FindingKind { changed, missing, surplus, counter, cost, control };

// What a finding comes to. drift: a value on another platform than the baseline's, where the code need not be the
// reason; unconfirmed: a cost that no second measurement has confirmed; warn: beyond the warning level only.
enum class Level { fail, drift, unconfirmed, warn };

// One thing that differs from the baseline by more than it may.
struct Finding {
  FindingKind kind = FindingKind::changed;
  std::string cell;                     // shortKey() of the cell or sequence; empty for `control`
  std::string quantity;                 // "flip_hdr", "mask flip_hdr", "draws", "cost ratio", ...
  std::optional<double> before, after;  // as stored and as measured; nullopt: undefined or not there
  double limit = 0;                     // largest allowed |after - before|
  double excess = 0;                    // |after - before| / limit: what changed most has the largest
  Level level = Level::fail;
};

// Exit codes 0, 1, 4, 4. inconclusive: nothing fails, but some references are too noisy to say so or a cost is not
// confirmed; drift: nothing fails, but the baseline was made on another platform.
enum class GateVerdict { pass, fail, inconclusive, drift };

struct GateReport {
  GateVerdict verdict = GateVerdict::pass;
  std::vector<Finding> findings;     // by level, the largest excess first
  std::vector<std::string> notes;    // one sentence each: what was not compared and why, what else differs
  std::vector<std::string> cells;    // every cell of either side, by shortKey()
  std::set<std::string> noisyCells;  // those of the run whose reference missed max_noise
  bool samePlatform = true;
  std::size_t metricsCompared = 0, countersCompared = 0, costsCompared = 0;

  std::size_t count(Level level) const;
  // Keys of the sequences whose cost has to be measured again.
  std::vector<std::string> unconfirmedCosts() const;
};

// `defaults`: of every axis; what cells stood at that were measured before an axis was added. `rerun`: a second
// measurement of some of the costs, by the same program; an input Error if it is of another.
GateReport check(const Results& run, const Baseline& baseline, const AxisValues& defaults = {},
                 const Results* rerun = nullptr);
int exitCode(GateVerdict verdict);

struct GateCommands {
  std::string bless;    // printed when something differs
  std::string confirm;  // printed when a cost is not confirmed
};

// Markdown for people.
std::string printGateReport(const GateReport& report, const GateCommands& commands);
std::string toJson(const GateReport& report);
std::string toJUnit(const GateReport& report, const std::string& suiteName);  // one test case a cell
// Workflow commands of GitHub Actions, one a line: errors, then warnings, of each the ten that it shows.
std::string toGitHubAnnotations(const GateReport& report);

}  // namespace pb
