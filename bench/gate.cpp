#include "bench/gate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "bench/gate_cost.h"
#include "bench/platform.h"
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

// The levels of one metric on one scene.
struct MetricLevels {
  const Tolerance& fail;
  const Tolerance* warn;  // nullptr: a change is not reported before it fails
};

MetricLevels levelsOf(const Baseline& baseline, const std::string& scope, const std::string& metric) {
  if (const auto scene = baseline.sceneTolerances.find(scope); scene != baseline.sceneTolerances.end())
    if (const Tolerance* fail = findTolerance(scene->second.fail, metric))
      return {*fail, findTolerance(scene->second.warn, metric)};
  return {*findTolerance(baseline.tolerance, metric), findTolerance(baseline.warnTolerance, metric)};
}

// What another platform may have changed as well as the code. Cells that are missing and a failed control are not.
bool isOfPlatform(const Finding& finding) {
  return finding.level == Level::fail && (finding.kind == FindingKind::changed ||
                                          finding.kind == FindingKind::counter || finding.kind == FindingKind::cost);
}

class Comparison {
 public:
  Comparison(const Results& run, const Baseline& baseline, const AxisValues& defaults, const Results* rerun)
      : run_(run), baseline_(baseline), rerun_(rerun), defaults_(defaultsOf(baseline, defaults)) {
    for (const CellResult& cell : run.cells)
      if (!runCells_.emplace(keyOf(cell), &cell).second)
        throwInputError("a cell may stand once in a run, twice: {}", keyOf(cell));
  }

  GateReport make() {
    compareControl();
    compareCells();
    findSurplus();
    addCosts();
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
    const std::string scope = toleranceScope(after.scene, after.camera);
    compareMetrics(key, scope, "", before.metrics, after.metrics);
    if (before.maskMetrics && after.maskMetrics)
      compareMetrics(key, scope, "mask ", *before.maskMetrics, *after.maskMetrics);
    else if (before.maskMetrics || after.maskMetrics)
      report_.findings.push_back(
          makeFinding(before.maskMetrics ? FindingKind::missing : FindingKind::surplus, key, "mask"));
    compareIntegrity(key, scope, before.integrity, after.integrity);
    if (sameDriver(run_.provenance, baseline_.provenance)) compareCounters(key, before, after);
  }

  void compareMetrics(const std::string& cell, const std::string& scope, const std::string& region,
                      const GatedMetrics& before, const Metrics& after) {
    for (const auto& [key, value] : before)
      compareMetric(cell, region + key, value, metricValue(after, key), levelsOf(baseline_, scope, key));
  }

  void compareMetric(const std::string& cell, const std::string& quantity, const std::optional<double>& before,
                     const std::optional<double>& after, const MetricLevels& levels) {
    ++report_.metricsCompared;
    const auto find = [&](const Tolerance& tolerance, Level level) {
      const double limit = limitFor(tolerance, before);
      if (isWithin(before, after, limit)) return false;
      const bool finite = before && after && std::isfinite(*before) && std::isfinite(*after);
      const double excess = finite ? excessOf(std::abs(*after - *before), limit) : kInfinity;
      report_.findings.push_back({FindingKind::changed, cell, quantity, before, after, limit, excess, level});
      return true;
    };
    if (!find(levels.fail, Level::fail) && levels.warn != nullptr) find(*levels.warn, Level::warn);
  }

  // Those of the baseline: programs learn to measure more.
  void compareIntegrity(const std::string& cell, const std::string& scope, const MetricValues& before,
                        const MetricValues& after) {
    for (const auto& [name, value] : before) {
      const auto found = std::ranges::find(after, name, &MetricValues::value_type::first);
      const std::optional<double> now = found == after.end() ? std::nullopt : std::optional(found->second);
      compareMetric(cell, "integrity " + name, value, now, levelsOf(baseline_, scope, kIntegrityTolerance));
    }
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

  void addCosts() {
    CostFindings costs = compareCosts(run_, baseline_, defaults_, rerun_);
    report_.costsCompared = costs.compared;
    std::ranges::move(costs.findings, std::back_inserter(report_.findings));
    std::ranges::move(costs.notes, std::back_inserter(report_.notes));
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
    const std::vector<PlatformDifference> platform = platformDifferences(old, now);
    report_.samePlatform = platform.empty();
    if (!report_.samePlatform)
      report_.notes.push_back(
          fmt::format("Drift: {}.{}", describe(platform), sameDriver(now, old) ? "" : " Counters were not compared."));
    if (!newCounters_.empty())
      report_.notes.push_back(
          fmt::format("Counters that the baseline lacks were not compared: {}.", fmt::join(newCounters_, ", ")));
    if (now.suiteHash != old.suiteHash) report_.notes.push_back("The suite has changed since the baseline.");
    for (const auto& [scene, hash] : now.sceneHashes)
      if (const auto found = old.sceneHashes.find(scene); found != old.sceneHashes.end() && found->second != hash)
        report_.notes.push_back(fmt::format("The content of scene '{}' has changed since the baseline.", scene));
  }

  // A metric out of its tolerance fails against any reference. Against a noisy one agreement proves nothing; on another
  // platform a difference need not come from the code.
  void conclude() {
    for (Finding& finding : report_.findings)
      if (!report_.samePlatform && isOfPlatform(finding)) finding.level = Level::drift;
    std::ranges::stable_sort(report_.findings, [](const Finding& a, const Finding& b) {
      return a.level != b.level ? a.level < b.level : a.excess > b.excess;
    });
    if (report_.count(Level::fail) > 0)
      report_.verdict = GateVerdict::fail;
    else if (!report_.noisyCells.empty() || report_.count(Level::unconfirmed) > 0)
      report_.verdict = GateVerdict::inconclusive;
    else if (!report_.samePlatform)
      report_.verdict = GateVerdict::drift;
  }

  const Results& run_;
  const Baseline& baseline_;
  const Results* rerun_;
  const AxisValues defaults_;
  std::map<std::string, const CellResult*> runCells_;  // by shortKey()
  std::set<std::string> newCounters_;                  // that the baseline lacks
  GateReport report_;
};

}  // namespace

std::size_t GateReport::count(Level level) const {
  return static_cast<std::size_t>(std::ranges::count(findings, level, &Finding::level));
}

std::vector<std::string> GateReport::unconfirmedCosts() const {
  std::vector<std::string> sequences;
  for (const Finding& finding : findings)
    if (finding.level == Level::unconfirmed) sequences.push_back(finding.cell);
  return sequences;
}

GateReport check(const Results& run, const Baseline& baseline, const AxisValues& defaults, const Results* rerun) {
  return Comparison(run, baseline, defaults, rerun).make();
}

int exitCode(GateVerdict verdict) {
  switch (verdict) {
    case GateVerdict::pass:
      return 0;
    case GateVerdict::fail:
      return static_cast<int>(Failure::verdict);
    case GateVerdict::inconclusive:
    case GateVerdict::drift:
      return static_cast<int>(Failure::inconclusive);
  }
  return static_cast<int>(Failure::verdict);
}

}  // namespace pb
