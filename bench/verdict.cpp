#include "bench/verdict.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "bench/candidates.h"

namespace pb {
namespace {

Region regionOf(const CellResult& cell) { return cell.maskMetrics ? Region::mask : Region::whole; }

bool isClear(const CellResult& cell, Region region) { return isClearOfFloor(Sequence{&cell}, region); }

bool hasInterval(const CellResult& cell, const std::string& metric) {
  const MetricIntervals& intervals = regionOf(cell) == Region::mask ? cell.maskIntervals : cell.intervals;
  return std::ranges::find(intervals, metric, &MetricIntervals::value_type::first) != intervals.end();
}

}  // namespace

Verdict verdictOf(const Estimate& a, const Estimate& b, bool aIsClear, bool bIsClear) {
  if (!aIsClear && !bIsClear) return Verdict::belowFloor;
  if (a.isBelow(b)) return Verdict::better;
  if (b.isBelow(a)) return Verdict::worse;
  return Verdict::equal;
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
  const std::optional<Estimate> lossA = lossOf(a, selection, region), lossB = lossOf(b, selection, region);
  if (!lossA || !lossB) return std::nullopt;
  return verdictOf(*lossA, *lossB, isClear(a, region), isClear(b, region));
}

RankingState rankingState(const std::vector<CellResult>& cells, const std::string& metric) {
  std::map<std::tuple<std::string, std::string, int>, std::vector<const CellResult*>> groups;
  for (const CellResult& cell : cells)
    if (hasInterval(cell, metric)) groups[{cell.scene, cell.camera, cell.frame}].push_back(&cell);
  Selection selection;
  selection.metric = metric;
  RankingState state;
  for (const auto& [where, group] : groups)
    for (std::size_t i = 0; i < group.size(); ++i)
      for (std::size_t j = i + 1; j < group.size(); ++j) {
        const CellResult &a = *group[i], &b = *group[j];
        const std::optional<Estimate> lossA = lossOf(a, selection, regionOf(a)),
                                      lossB = lossOf(b, selection, regionOf(b));
        if (!lossA || !lossB || lossA->value == lossB->value) continue;
        ++state.pairs;
        const Verdict verdict = verdictOf(*lossA, *lossB, isClear(a, regionOf(a)), isClear(b, regionOf(b)));
        if (verdict == Verdict::equal || verdict == Verdict::belowFloor) ++state.undecided;
      }
  return state;
}

}  // namespace pb
