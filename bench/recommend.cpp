#include "bench/recommend.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "bench/differences.h"
#include "bench/pareto.h"
#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBytesPerMegabyte = 1e6;

double costOf(const Candidate& candidate) { return candidate.ratio ? candidate.ratio->value : kInfinity; }

bool hasCosts(const CandidateSet& set) {
  return std::ranges::any_of(set.candidates, [](const Candidate& c) { return c.ratio.has_value(); });
}

enum class Fit { no, perhaps, yes };

// Perhaps: the value is below the limit, its interval is not, or not known.
Fit fitOf(const std::optional<Estimate>& estimate, const std::optional<double>& limit) {
  if (!limit) return Fit::yes;
  if (!estimate || !(estimate->value <= *limit)) return Fit::no;
  return estimate->high <= *limit ? Fit::yes : Fit::perhaps;
}

Fit fitOf(const Candidate& candidate, const RecommendRequest& request) {
  const Estimate megabytes{candidate.probeBytes / kBytesPerMegabyte, 0, candidate.probeBytes / kBytesPerMegabyte};
  std::optional<double> maxLoss = request.maxError;
  if (maxLoss) maxLoss = lossOf(request.selection.metric, *maxLoss);
  return std::min({fitOf(candidate.loss, maxLoss), fitOf(candidate.frameMs, request.budgetMs),
                   fitOf(candidate.ratio, request.budgetRatio), fitOf(megabytes, request.budgetMb)});
}

void requireAnswerable(const CandidateSet& set, const RecommendRequest& request) {
  const bool wantsCosts = request.maxError || request.budgetMs || request.budgetRatio;
  if (wantsCosts && !set.candidates.empty() && !hasCosts(set))
    throwInputError("the run measured no costs, so that nothing can be called cheap; repeat it without --no-cost");
}

std::vector<Tradeoff> tradeoffsOf(const CandidateSet& set) {
  std::vector<Tradeoff> tradeoffs;
  for (const Candidate& candidate : set.candidates)
    tradeoffs.push_back({candidate.loss, candidate.ratio.value_or(Estimate{kInfinity, kInfinity, kInfinity})});
  return tradeoffs;
}

// --- Steps

// The axis in which the techniques differ, if it is one only.
std::optional<std::string> soleDifference(const AxisValues& a, const AxisValues& b) {
  if (a.size() != b.size()) return std::nullopt;
  std::optional<std::string> axis;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    if (axis || a[i].first != b[i].first) return std::nullopt;
    axis = a[i].first;
  }
  return axis;
}

std::string valueOf(const AxisValues& technique, const std::string& axis) {
  for (const auto& [name, value] : technique)
    if (name == axis) return value;
  return {};
}

Step makeStep(const std::string& axis, const CandidateSet& set, std::size_t first, std::size_t second) {
  const Candidate &from = set.candidates[first], &to = set.candidates[second];
  Step step{axis, valueOf(from.technique, axis), valueOf(to.technique, axis)};
  step.gain = -differenceOf(set, second, first).loss;
  step.verdict = verdictOf(set, second, first);
  if (from.ratio && to.ratio)
    step.costFactor = Estimate{to.ratio->value / from.ratio->value, to.ratio->low / from.ratio->high,
                               to.ratio->high / from.ratio->low};
  return step;
}

bool areNumbers(const std::vector<Step>& steps) {
  return std::ranges::all_of(steps, [](const Step& s) { return parseNumber(s.from) && parseNumber(s.to); });
}

// The nearest number either way.
std::vector<Step> nearestOf(const std::vector<Step>& steps) {
  const auto number = [](const Step& step) { return *parseNumber(step.to); };
  const double here = *parseNumber(steps.front().from);
  const Step* below = nullptr;
  const Step* above = nullptr;
  for (const Step& step : steps) {
    if (number(step) < here && (!below || number(step) > number(*below))) below = &step;
    if (number(step) > here && (!above || number(step) < number(*above))) above = &step;
  }
  std::vector<Step> nearest;
  for (const Step* step : {below, above})
    if (step) nearest.push_back(*step);
  return nearest;
}

}  // namespace

std::vector<Step> stepsFrom(const CandidateSet& set, std::size_t candidate) {
  const Candidate& from = set.candidates[candidate];
  std::vector<Step> steps;
  for (const VaryingAxis& axis : set.axes) {
    std::vector<Step> along;
    for (std::size_t to = 0; to < set.candidates.size(); ++to)
      if (soleDifference(from.technique, set.candidates[to].technique) == axis.name)
        along.push_back(makeStep(axis.name, set, candidate, to));
    if (!along.empty() && areNumbers(along)) along = nearestOf(along);
    steps.insert(steps.end(), along.begin(), along.end());
  }
  return steps;
}

Recommendation recommend(const Results& results, const RecommendRequest& request) {
  Recommendation answer;
  answer.set = candidatesOf(results, request.selection);
  requireAnswerable(answer.set, request);
  const std::vector<Candidate>& candidates = answer.set.candidates;
  const auto rank = [&](std::size_t i) {
    const double cost = costOf(candidates[i]), loss = candidates[i].loss.value;
    return request.maxError ? std::tuple(cost, loss, i) : std::tuple(loss, cost, i);
  };
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (fitOf(candidates[i], request) == Fit::yes && (!answer.chosen || rank(i) < rank(*answer.chosen)))
      answer.chosen = i;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (fitOf(candidates[i], request) == Fit::perhaps && (!answer.chosen || rank(i) < rank(*answer.chosen)))
      answer.undecided.push_back(i);
  std::ranges::sort(answer.undecided, {}, rank);
  if (hasCosts(answer.set)) {
    const std::vector<Tradeoff> tradeoffs = tradeoffsOf(answer.set);
    answer.front = paretoFront(
        tradeoffs, [&](std::size_t i, std::size_t j) { return verdictOf(answer.set, i, j) == Verdict::better; });
    answer.knee = kneeOf(tradeoffs, answer.front);
  }
  if (answer.chosen) answer.steps = stepsFrom(answer.set, *answer.chosen);
  return answer;
}

}  // namespace pb
