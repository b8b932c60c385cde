#include "bench/verdict.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace pb {
namespace {

Region regionOf(const CellResult& cell) { return cell.maskMetrics ? Region::mask : Region::whole; }

bool isClear(const CellResult& cell, Region region) { return isClearOfFloor(Sequence{&cell}, region); }

// The one metric whose differences noise leaves as they are, on average.
constexpr char kUnbiasedMetric[] = "mse";

bool hasInterval(const CellResult& cell, const std::string& metric) {
  const MetricIntervals& intervals = regionOf(cell) == Region::mask ? cell.maskIntervals : cell.intervals;
  return std::ranges::find(intervals, metric, &MetricIntervals::value_type::first) != intervals.end();
}

}  // namespace

Verdict verdictOf(const Difference& difference) {
  if (difference.loss.isNegative()) return Verdict::better;
  if (difference.loss.isPositive()) return Verdict::worse;
  return Verdict::equal;
}

Verdict verdictBelowFloor(const Difference& difference, const Difference& mse) {
  if (difference.loss.low == 0 && difference.loss.high == 0) return Verdict::equal;
  const Verdict verdict = verdictOf(difference);
  const bool isSure = difference.isPaired && mse.isPaired && verdict != Verdict::equal && verdictOf(mse) == verdict;
  return isSure ? verdict : Verdict::belowFloor;
}

Verdict verdictOf(const Estimate& a, const Estimate& b) { return verdictOf(Difference{unpairedDifference(a, b)}); }

std::optional<Verdict> verdictOf(const CandidateSet& set, std::size_t a, std::size_t b) {
  const Difference difference = differenceOf(set, a, b);
  if (!difference.loss.isKnown()) return difference.loss.value == 0 ? std::optional(Verdict::equal) : std::nullopt;
  if (set.candidates[a].clearOfFloor || set.candidates[b].clearOfFloor) return verdictOf(difference);
  const std::optional<Estimate> mse = pairedDifference(set, a, b, kUnbiasedMetric);
  return verdictBelowFloor(difference, mse ? Difference{*mse, true} : Difference{});
}

std::string printVerdict(Verdict verdict) {
  switch (verdict) {
    case Verdict::better:
      return "better";
    case Verdict::worse:
      return "worse";
    case Verdict::equal:
      return "equal within the interval";
    case Verdict::belowFloor:
      return "below the floor";
  }
  return {};
}

std::optional<Verdict> verdictOf(const CellResult& a, const CellResult& b, const std::string& metric, Region region) {
  Selection selection;
  selection.metric = metric;
  const std::optional<Difference> difference = differenceOf(a, b, selection, region);
  if (!difference) return std::nullopt;
  if (isClear(a, region) || isClear(b, region)) return verdictOf(*difference);
  selection.metric = kUnbiasedMetric;
  return verdictBelowFloor(*difference, differenceOf(a, b, selection, region).value_or(Difference{}));
}

RankingState rankingState(const std::vector<CellResult>& cells, const std::string& metric) {
  std::map<std::tuple<std::string, std::string, int>, std::vector<const CellResult*>> groups;
  for (const CellResult& cell : cells)
    if (hasInterval(cell, metric)) groups[{cell.scene, cell.camera, cell.frame}].push_back(&cell);
  RankingState state;
  for (const auto& [where, group] : groups)
    for (std::size_t i = 0; i < group.size(); ++i)
      for (std::size_t j = i + 1; j < group.size(); ++j) {
        const CellResult &a = *group[i], &b = *group[j];
        const Region region = regionOf(a);
        const std::optional<Verdict> verdict = verdictOf(a, b, metric, region);
        if (!verdict || errorOf(a, region, metric) == errorOf(b, region, metric)) continue;
        ++state.pairs;
        if (*verdict == Verdict::equal || *verdict == Verdict::belowFloor) ++state.undecided;
      }
  return state;
}

}  // namespace pb
