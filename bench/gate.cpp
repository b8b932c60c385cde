#include "bench/gate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "scenes/error.h"

namespace pb {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const std::optional<double> kAbsent;

// A finding about presence, for which no size of change is defined.
Finding makeFinding(FindingKind kind, const std::string& cell, const std::string& quantity) {
  return {kind, cell, quantity, kAbsent, kAbsent, 0, kInfinity};
}

double excessOf(double delta, double limit) { return limit > 0 ? delta / limit : kInfinity; }

bool isUndefined(const std::optional<double>& value) { return !value || std::isnan(*value); }

// |after - before| <= limit, where undefined equals undefined only and an infinity equals itself only.
bool isWithin(const std::optional<double>& before, const std::optional<double>& after, double limit) {
  if (isUndefined(before) || isUndefined(after)) return isUndefined(before) && isUndefined(after);
  if (std::isinf(*before) || std::isinf(*after)) return *before == *after;
  return std::abs(*after - *before) <= limit;
}

double limitFor(const Tolerance& tolerance, const std::optional<double>& before) {
  const bool finite = before && std::isfinite(*before);
  return finite ? largestAllowedDelta(tolerance, *before) : 0.0;
}

class Comparison {
 public:
  Comparison(const Results& run, const Baseline& baseline, const AxisValues& defaults)
      : run_(run), baseline_(baseline), defaults_(defaultsOf(baseline, defaults)) {
    for (const CellResult& cell : run.cells)
      if (!runCells_.emplace(keyOf(cell), &cell).second)
        throwInputError("a cell may stand once in a run, twice: {}", keyOf(cell));
  }

  GateReport make() {
    compareControl();
    compareCells();
    findSurplus();
    compareCosts();
    findNoise();
    noteDifferences();
    conclude();
    return std::move(report_);
  }

 private:
  // Where a default has changed since, that of the baseline says what its keys mean.
  static AxisValues defaultsOf(const Baseline& baseline, const AxisValues& now) {
    std::map<std::string, std::string> values(baseline.defaults.begin(), baseline.defaults.end());
    values.insert(now.begin(), now.end());
    return {values.begin(), values.end()};
  }

  std::string keyOf(const CellResult& cell) const { return shortKey(cell.key(), defaults_); }
  std::string sequenceKeyOf(const CellResult& cell) const { return shortKey(cell.sequenceKey(), defaults_); }

  void compareControl() {
    const std::string& outcome = run_.provenance.controlOutcome;
    if (outcome != kControlPassed) report_.findings.push_back(makeFinding(FindingKind::control, "", outcome));
  }

  void compareCells() {
    for (const BaselineCell& before : baseline_.cells) {
      const std::string key = shortKey(before.key, defaults_);  // older baselines name every axis that there was
      report_.cells.push_back(key);
      const auto found = runCells_.find(key);
      if (found == runCells_.end())
        report_.findings.push_back(makeFinding(FindingKind::missing, key, "cell"));
      else
        compareCell(key, before, *found->second);
    }
  }

  void compareCell(const std::string& key, const BaselineCell& before, const CellResult& after) {
    compareMetrics(key, "", before.metrics, after.metrics);
    if (before.maskMetrics && after.maskMetrics)
      compareMetrics(key, "mask ", *before.maskMetrics, *after.maskMetrics);
    else if (before.maskMetrics || after.maskMetrics)
      report_.findings.push_back(
          makeFinding(before.maskMetrics ? FindingKind::missing : FindingKind::surplus, key, "mask"));
    if (sameDriver(run_.provenance, baseline_.provenance)) compareCounters(key, before, after);
  }

  // Both lists stand in the order of the tolerances.
  void compareMetrics(const std::string& cell, const std::string& region, const GatedMetrics& before,
                      const Metrics& after) {
    for (std::size_t i = 0; i < before.size(); ++i) {
      const auto& [key, value] = before[i];
      compareMetric(cell, region + key, value, metricValue(after, key), limitFor(baseline_.tolerance[i].second, value));
    }
  }

  void compareMetric(const std::string& cell, const std::string& quantity, const std::optional<double>& before,
                     const std::optional<double>& after, double limit) {
    ++report_.metricsCompared;
    if (isWithin(before, after, limit)) return;
    const bool finite = before && after && std::isfinite(*before) && std::isfinite(*after);
    const double excess = finite ? excessOf(std::abs(*after - *before), limit) : kInfinity;
    report_.findings.push_back({FindingKind::changed, cell, quantity, before, after, limit, excess});
  }

  // Those of the baseline: programs learn to count more.
  void compareCounters(const std::string& key, const BaselineCell& before, const CellResult& after) {
    std::map<std::string, std::int64_t> now(after.counters.begin(), after.counters.end());
    for (const auto& [name, value] : before.counters) {
      ++report_.countersCompared;
      const auto found = now.find(name);
      compareCounter(key, name, value, found == now.end() ? std::nullopt : std::optional(found->second));
      now.erase(name);
    }
    for (const auto& [name, value] : now) newCounters_.insert(name);
  }

  void compareCounter(const std::string& cell, const std::string& name, std::int64_t before,
                      std::optional<std::int64_t> after) {
    if (before == after) return;
    const std::optional<double> changed = after ? std::optional(static_cast<double>(*after)) : std::nullopt;
    report_.findings.push_back({FindingKind::counter, cell, name, static_cast<double>(before), changed, 0, kInfinity});
  }

  void findSurplus() {
    std::set<std::string> known(report_.cells.begin(), report_.cells.end());
    for (const CellResult& cell : run_.cells) {
      const std::string key = keyOf(cell);
      if (known.contains(key)) continue;
      report_.cells.push_back(key);
      report_.findings.push_back(makeFinding(FindingKind::surplus, key, "cell"));
    }
  }

  std::map<std::string, const CostResult*> costsOfRun() const {
    std::map<std::string, const CostResult*> costs;
    for (const CellResult& cell : run_.cells)
      if (cell.cost) costs.emplace(sequenceKeyOf(cell), &*cell.cost);
    return costs;
  }

  // Why ratios of run and baseline can't be compared; empty if they can.
  std::string costObstacle(bool measured) const {
    const Provenance &now = run_.provenance, &old = baseline_.provenance;
    if (baseline_.costs.empty()) return measured ? "the baseline holds none" : "neither side measured it";
    if (!measured) return "this run did not measure it";
    if (!sameDriver(now, old)) return "the GL driver differs";
    if (now.cpu != old.cpu) return fmt::format("the CPU is '{}', was '{}'", now.cpu, old.cpu);
    if (now.threads != old.threads) return fmt::format("threads are {}, were {}", now.threads, old.threads);
    return "";
  }

  void compareCosts() {
    const std::map<std::string, const CostResult*> costs = costsOfRun();
    if (const std::string obstacle = costObstacle(!costs.empty()); !obstacle.empty())
      return report_.notes.push_back(fmt::format("Cost was not compared: {}.", obstacle));
    std::set<std::string> sequences;  // those that the run lacks altogether are found as missing cells
    for (const CellResult& cell : run_.cells) sequences.insert(sequenceKeyOf(cell));
    for (const auto& [key, before] : baseline_.costs) {
      const std::string sequence = shortKey(key, defaults_);
      if (const auto found = costs.find(sequence); found != costs.end())
        compareCost(sequence, before, *found->second);
      else if (sequences.contains(sequence))
        report_.findings.push_back(makeFinding(FindingKind::missing, sequence, "cost"));
    }
  }

  void compareCost(const std::string& sequence, const BaselineCost& before, const CostResult& after) {
    ++report_.costsCompared;
    const double limit = costLimit(before.ratio, after);
    const double delta = std::abs(after.ratio - before.ratio);
    const bool overlap = after.ratioLow <= before.ratioHigh && before.ratioLow <= after.ratioHigh;
    if (overlap || delta <= limit) return;
    report_.findings.push_back(
        {FindingKind::cost, sequence, "cost ratio", before.ratio, after.ratio, limit, excessOf(delta, limit)});
  }

  // As a change of the ratio. 25 % slower is ratio 1.25, 25 % faster is ratio 1 / 1.25 of the baseline.
  static double costLimit(double before, const CostResult& after) {
    const double relative = after.ratio > before ? kCostRelativeFloor : kCostRelativeFloor / (1 + kCostRelativeFloor);
    const double absolute = after.plainMs > 0 ? kCostAbsoluteFloorMs / after.plainMs : kInfinity;
    return std::max(relative * before, absolute);
  }

  // The stricter of both sides: like a loosened tolerance, a loosened max_noise does not pass unnoticed.
  std::optional<double> maxNoise() const {
    const std::optional<double>&now = run_.provenance.maxNoise, &old = baseline_.provenance.maxNoise;
    return now && old ? std::min(*now, *old) : now ? now : old;
  }

  void findNoise() {
    const std::optional<double> limit = maxNoise();
    for (const CellResult& cell : run_.cells)
      if (isTooNoisy(cell, limit)) report_.noisyCells.insert(keyOf(cell));
    std::map<std::string, std::vector<double>> noiseOfScenes;
    for (const NoisyReference& noisy : findNoisyReferences(run_.cells, limit))
      noiseOfScenes[noisy.scene].push_back(noisy.noise);
    const char* owner = limit == run_.provenance.maxNoise ? "" : " in the baseline";
    for (const auto& [scene, noise] : noiseOfScenes)
      report_.notes.push_back(fmt::format(
          "Noise: max_noise is {:g}{}, but references of scene '{}' have up to {:.3g}, in {} of its frames.", *limit,
          owner, scene, *std::ranges::max_element(noise), noise.size()));
  }

  void noteDifferences() {
    const Provenance &now = run_.provenance, &old = baseline_.provenance;
    report_.sameDriver = sameDriver(now, old);
    if (!report_.sameDriver)
      report_.notes.push_back(
          fmt::format("Drift: counters were not compared, the baseline was made with '{}' ({}), "
                      "this run with '{}' ({}).",
                      old.glRenderer, old.glVersion, now.glRenderer, now.glVersion));
    if (!newCounters_.empty())
      report_.notes.push_back(
          fmt::format("Counters that the baseline lacks were not compared: {}.", fmt::join(newCounters_, ", ")));
    if (now.suiteHash != old.suiteHash) report_.notes.push_back("The suite has changed since the baseline.");
    for (const auto& [scene, hash] : now.sceneHashes)
      if (const auto found = old.sceneHashes.find(scene); found != old.sceneHashes.end() && found->second != hash)
        report_.notes.push_back(fmt::format("The content of scene '{}' has changed since the baseline.", scene));
  }

  // A metric out of its tolerance fails against any reference and on any driver. Against a noisy reference agreement
  // proves nothing; on another driver the exact half of the gate is missing.
  void conclude() {
    std::ranges::stable_sort(report_.findings, std::ranges::greater{}, &Finding::excess);
    if (!report_.findings.empty())
      report_.verdict = Verdict::fail;
    else if (!report_.noisyCells.empty())
      report_.verdict = Verdict::inconclusive;
    else if (!report_.sameDriver)
      report_.verdict = Verdict::drift;
  }

  const Results& run_;
  const Baseline& baseline_;
  const AxisValues defaults_;
  std::map<std::string, const CellResult*> runCells_;  // by shortKey()
  std::set<std::string> newCounters_;                  // that the baseline lacks
  GateReport report_;
};

}  // namespace

GateReport check(const Results& run, const Baseline& baseline, const AxisValues& defaults) {
  return Comparison(run, baseline, defaults).make();
}

int exitCode(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return 0;
    case Verdict::fail:
      return static_cast<int>(Failure::verdict);
    case Verdict::inconclusive:
    case Verdict::drift:
      return static_cast<int>(Failure::inconclusive);
  }
  return static_cast<int>(Failure::verdict);
}

}  // namespace pb
