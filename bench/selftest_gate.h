// Tests the gate itself: faults that are planted on purpose must be caught, unchanged runs must not.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/gate.h"
#include "bench/progress.h"
#include "bench/runner.h"
#include "raster/fault.h"

namespace pb {

struct NamedFault {
  std::string name;
  Fault fault;
};
// Those that a gate has to catch.
const std::vector<NamedFault>& plantedFaults();

struct SelftestContext {
  const Suite& suite;
  const Scenes& scenes;
  RasterDevice& device;
  const ReferenceStore& store;
  const Baseline& baseline;
  const Provenance& provenance;   // of a run of the suite, with the control's outcome
  std::filesystem::path scratch;  // a folder for runs, which are removed again
  Progress& progress;
};

struct FaultOutcome {
  std::string name;
  GateReport report;
  bool isCaught() const { return report.verdict == GateVerdict::fail; }
};

struct RepeatOutcome {
  std::size_t runs = 0;
  std::size_t alarms = 0;       // runs that failed
  std::size_t remeasured = 0;   // runs in which a cost had to be measured again
  std::size_t differing = 0;    // runs whose errors or counters differ from the first one's in any bit
  std::vector<GateReport> bad;  // of the runs that did not pass
  bool costsCompared = true;    // those that the baseline has

  bool isQuiet() const { return bad.empty() && differing == 0; }
  // Upper end of the 95 % interval of the probability of an alarm after none in `runs`: 1 - 0.05^(1/runs).
  double alarmBound() const;
};

class GateSelftest {
 public:
  explicit GateSelftest(const SelftestContext& context) : c_(context) {}

  FaultOutcome plant(const NamedFault& fault) const;

  // The smallest share of additional radiance in the captures that is caught, between nothing and `largest`, which is;
  // to within an eighth of itself.
  double smallestCaughtEnergy(double largest) const;

  // Runs the suite unchanged, with its costs. `done` hears of each run.
  RepeatOutcome repeat(int runs, const std::function<void(int)>& done) const;

 private:
  Results run(const Fault& fault, bool withCost) const;
  bool isEnergyCaught(double share) const;

  const SelftestContext& c_;
};

// Markdown.
std::string printFaults(const std::vector<FaultOutcome>& outcomes, double smallestEnergy);
std::string printRepeats(const RepeatOutcome& outcome);

}  // namespace pb
