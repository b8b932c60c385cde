#include "bench/gate_cost.h"

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "bench/platform.h"
#include "bench/significance.h"
#include "bench/statistics.h"
#include "scenes/error.h"

namespace pb {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Costs = std::map<std::string, const CostResult*>;  // by sequence

// What was measured of a sequence on both sides.
struct Pair {
  std::string sequence;
  const BaselineCost* before;
  const CostResult* after;
};

struct Ratios {
  double before, after;
};

// Medians of the repetitions, which are what is compared.
Ratios ratiosOf(const Pair& pair) { return {median(pair.before->ratios), median(pair.after->ratios)}; }

// As a change of the ratio. 25 % slower is ratio 1.25, 25 % faster is ratio 1 / 1.25 of the baseline, of plain frames
// so long that their error doesn't count.
double limitOf(const Ratios& ratios, double plainMs) {
  const double plainError = plainMs > 0 ? kPlainFrameErrorMs / plainMs : kInfinity;
  const double factor = (1 + kCostRelativeFloor) * (1 + plainError);
  return ratios.before * (ratios.after > ratios.before ? factor - 1 : 1 - 1 / factor);
}

bool isAboveFloors(const Pair& pair) {
  const Ratios ratios = ratiosOf(pair);
  return std::abs(ratios.after - ratios.before) > limitOf(ratios, pair.after->plainMs);
}

bool isSlower(const Pair& pair) {
  const Ratios ratios = ratiosOf(pair);
  return ratios.after > ratios.before;
}

// Those above the floors that are significant among all.
std::vector<Pair> changedAmong(const std::vector<Pair>& pairs) {
  std::vector<double> probabilities;
  for (const Pair& pair : pairs)
    // Below the floors nothing is a finding; 1 never makes another comparison more significant.
    probabilities.push_back(isAboveFloors(pair) ? equalCostProbability(pair.before->ratios, pair.after->ratios) : 1.0);
  const std::vector<double> adjusted = holmAdjusted(probabilities);
  std::vector<Pair> changed;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (adjusted[i] < kCostSignificance) changed.push_back(pairs[i]);
  return changed;
}

class CostComparison {
 public:
  CostComparison(const Results& run, const Baseline& baseline, const AxisValues& defaults, const Results* rerun)
      : run_(run), baseline_(baseline), defaults_(defaults), costs_(costsOf(run)) {
    if (rerun == nullptr) return;
    requireRerun(*rerun);
    rerun_ = costsOf(*rerun);
    std::erase_if(rerun_, [](const auto& cost) { return cost.second->ratios.size() < kFewestRepetitions; });
  }

  CostFindings make() {
    if (const std::string obstacle = findObstacle(); !obstacle.empty()) {
      found_.notes.push_back(fmt::format("Cost was not compared: {}.", obstacle));
      return std::move(found_);
    }
    const std::vector<Pair> pairs = pairUp();
    if (tooFew_ > 0)
      found_.notes.push_back(
          fmt::format("The cost of {} sequences was not compared: a comparison wants {} repetitions on both sides.",
                      tooFew_, kFewestRepetitions));
    found_.compared = pairs.size();
    const std::vector<Pair> changed = changedAmong(pairs);
    const std::set<std::string> confirmed = findConfirmed(changed);
    for (const Pair& pair : changed) report(pair, confirmed.contains(pair.sequence));
    return std::move(found_);
  }

 private:
  std::string keyOf(const CellResult& cell) const { return shortKey(cell.sequenceKey(), defaults_); }

  Costs costsOf(const Results& results) const {
    Costs costs;
    for (const CellResult& cell : results.cells)
      if (cell.cost) costs.emplace(keyOf(cell), &*cell.cost);
    return costs;
  }

  void requireRerun(const Results& rerun) const {
    const Provenance &first = run_.provenance, &second = rerun.provenance;
    if (first.toolVersion != second.toolVersion || first.gitHash != second.gitHash ||
        first.suiteHash != second.suiteHash)
      throwInputError(
          "the second measurement must be of the same suite by the same program, it is of suite '{}' by {} {}",
          second.suiteName, second.toolVersion, second.gitHash);
    if (!sameDriver(first, second) || first.cpu != second.cpu || first.threads != second.threads)
      throwInputError(
          "the second measurement must be made on the same driver and CPU with as many threads, it is of '{}'"
          " on '{}' with {}",
          second.glRenderer, second.cpu, second.threads);
    requireNewRepetitions(rerun);
  }

  // Two measurements never agree in every bit of so many times: that would be the first one once more.
  void requireNewRepetitions(const Results& rerun) const {
    for (const auto& [sequence, second] : costsOf(rerun)) {
      const auto first = costs_.find(sequence);
      if (first == costs_.end() || second->ratios.size() < kFewestRepetitions) continue;
      if (first->second->ratios == second->ratios)
        throwInputError("the second measurement must be another one, the repetitions of {} are those of the first",
                        sequence);
    }
  }

  // Why ratios of run and baseline can't be compared; empty if they can.
  std::string findObstacle() const {
    const Provenance &now = run_.provenance, &old = baseline_.provenance;
    if (baseline_.costs.empty()) return costs_.empty() ? "neither side measured it" : "the baseline holds none";
    if (costs_.empty()) return "this run did not measure it";
    if (!sameDriver(now, old)) return "the GL driver differs";
    if (now.cpu != old.cpu) return fmt::format("the CPU is '{}', was '{}'", now.cpu, old.cpu);
    if (now.threads != old.threads) return fmt::format("threads are {}, were {}", now.threads, old.threads);
    return "";
  }

  // Reports those that are missing for a sequence of which the run has cells.
  std::vector<Pair> pairUp() {
    std::set<std::string> sequences;
    for (const CellResult& cell : run_.cells) sequences.insert(keyOf(cell));
    std::vector<Pair> pairs;
    for (const auto& [key, before] : baseline_.costs) {
      const std::string sequence = shortKey(key, defaults_);
      if (const auto after = costs_.find(sequence); after != costs_.end())
        addPair({sequence, &before, after->second}, pairs);
      else if (sequences.contains(sequence))
        found_.findings.push_back(
            {FindingKind::missing, sequence, "cost", std::nullopt, std::nullopt, 0, kInfinity, Level::fail});
    }
    return pairs;
  }

  void addPair(const Pair& pair, std::vector<Pair>& pairs) {
    if (haveRepetitions(pair.before->ratios, pair.after->ratios))
      pairs.push_back(pair);
    else
      ++tooFew_;
  }

  // Those that changed in the second measurement too, the same way.
  std::set<std::string> findConfirmed(const std::vector<Pair>& changed) const {
    std::vector<Pair> again;
    for (const Pair& pair : changed) {
      const auto second = rerun_.find(pair.sequence);
      if (second == rerun_.end()) continue;
      const Pair repeated{pair.sequence, pair.before, second->second};
      if (isSlower(repeated) == isSlower(pair)) again.push_back(repeated);
    }
    std::set<std::string> confirmed;
    for (const Pair& pair : changedAmong(again)) confirmed.insert(pair.sequence);
    return confirmed;
  }

  void report(const Pair& pair, bool confirmed) {
    const Ratios ratios = ratiosOf(pair);
    if (const auto second = rerun_.find(pair.sequence); !confirmed && second != rerun_.end()) {
      found_.notes.push_back(fmt::format(
          "A second measurement did not confirm the cost ratio of {}: {:.3g}, then {:.3g}, "
          "in the baseline {:.3g}.",
          pair.sequence, ratios.after, ratiosOf({pair.sequence, pair.before, second->second}).after, ratios.before));
      return;
    }
    const double limit = limitOf(ratios, pair.after->plainMs), delta = std::abs(ratios.after - ratios.before);
    found_.findings.push_back({FindingKind::cost, pair.sequence, "cost ratio", ratios.before, ratios.after, limit,
                               limit > 0 ? delta / limit : kInfinity, confirmed ? Level::fail : Level::unconfirmed});
  }

  const Results& run_;
  const Baseline& baseline_;
  const AxisValues& defaults_;
  Costs costs_, rerun_;
  std::size_t tooFew_ = 0;  // sequences without enough repetitions
  CostFindings found_;
};

}  // namespace

CostFindings compareCosts(const Results& run, const Baseline& baseline, const AxisValues& defaults,
                          const Results* rerun) {
  return CostComparison(run, baseline, defaults, rerun).make();
}

}  // namespace pb
