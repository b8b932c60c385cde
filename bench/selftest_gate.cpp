#include "bench/selftest_gate.h"

#include <algorithm>
#include <cmath>

#include "bench/axes.h"
#include "bench/plan.h"
#include "bench/provenance.h"
#include "bench/remeasure.h"

namespace pb {
namespace {

// Plants a fault for as long as it lives.
class Plant {
 public:
  Plant(RasterDevice& device, const Fault& fault) : device_(device) { plantFault(device, fault); }
  ~Plant() { plantFault(device_, {}); }
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

 private:
  RasterDevice& device_;
};

// What must be the same in every bit.
std::string withoutCost(const Results& run) {
  std::string text;
  for (CellResult cell : run.cells) {
    cell.cost.reset();
    text += toJson(cell) + '\n';
  }
  return text;
}

}  // namespace

const std::vector<NamedFault>& plantedFaults() {
  static const std::vector<NamedFault> faults = {
      {"swapped faces", {FaultKind::swappedFaces}},         {"half-texel shift", {FaultKind::halfTexelShift}},
      {"missing depth buffer", {FaultKind::noDepthBuffer}}, {"stale face", {FaultKind::staleFace}},
      {"double gamma", {FaultKind::doubleGamma}},           {"dropped bounce", {FaultKind::droppedBounce}},
      {"wrong owner hidden", {FaultKind::wrongOwner}},      {"1 % energy", {FaultKind::energy, 1.01}},
      {"5 % more draws", {FaultKind::moreDraws, 1.05}}};
  return faults;
}

double RepeatOutcome::alarmBound() const { return 1 - std::pow(0.05, 1 / static_cast<double>(runs)); }

Results GateSelftest::run(const Fault& fault, bool withCost) const {
  const Plant plant(c_.device, fault);
  Suite suite = c_.suite;
  if (!withCost) suite.cost.repetitions = 0;
  const Plan plan = makePlan(suite);
  RunDirectory directory(c_.scratch, {suite.name, fingerprint(c_.provenance, plan, suite)}, false);
  RunOutcome outcome = runPlan({suite, c_.scenes, plan, c_.device, c_.store, directory, c_.progress});
  Results results;
  results.provenance = c_.provenance;
  results.tolerance = suite.tolerance;
  results.cells = std::move(outcome.cells);
  return results;
}

FaultOutcome GateSelftest::plant(const NamedFault& fault) const {
  return {fault.name, check(run(fault.fault, false), c_.baseline, describe(Technique{}))};
}

bool GateSelftest::isEnergyCaught(double share) const { return plant({"", {FaultKind::energy, 1 + share}}).isCaught(); }

double GateSelftest::smallestCaughtEnergy(double largest) const {
  constexpr int kMaxHalvings = 12;
  double caught = largest, missed = 0;
  for (int i = 0; i < kMaxHalvings && missed == 0; ++i)
    if (isEnergyCaught(caught / 2))
      caught /= 2;
    else
      missed = caught / 2;
  while (caught - missed > caught / 8 && missed > 0) {
    const double middle = (caught + missed) / 2;
    (isEnergyCaught(middle) ? caught : missed) = middle;
  }
  return caught;
}

RepeatOutcome GateSelftest::repeat(int runs, const std::function<void(int)>& done) const {
  const AxisValues defaults = describe(Technique{});
  RepeatOutcome outcome;
  std::string first;
  for (int i = 0; i < runs; ++i) {
    const Results now = run({}, true);
    GateReport report = check(now, c_.baseline, defaults);
    if (const std::vector<std::string> changed = report.unconfirmedCosts(); !changed.empty()) {
      ++outcome.remeasured;
      Results again;
      again.provenance = c_.provenance;
      again.cells = remeasureCosts({c_.suite, c_.scenes, c_.device}, changed, defaults, c_.progress);
      report = check(now, c_.baseline, defaults, &again);
    }
    ++outcome.runs;
    outcome.costsCompared = outcome.costsCompared && (c_.baseline.costs.empty() || report.costsCompared > 0);
    if (report.verdict == GateVerdict::fail) ++outcome.alarms;
    if (report.verdict != GateVerdict::pass) outcome.bad.push_back(report);
    const std::string text = withoutCost(now);
    if (first.empty()) first = text;
    if (text != first) ++outcome.differing;
    done(i + 1);
  }
  return outcome;
}

}  // namespace pb
