#include "bench/report_verdict.h"

#include <algorithm>

namespace pb {

bool isNoiseKnown(const CellResult& cell, Region region, const std::string& metric) {
  const MetricIntervals& intervals = region == Region::mask ? cell.maskIntervals : cell.intervals;
  if (std::ranges::find(intervals, metric, &MetricIntervals::value_type::first) != intervals.end()) return true;
  return isFreeOfNoise(cell, region);
}

std::optional<Verdict> knownVerdict(const CellResult& a, const CellResult& b, const std::string& metric,
                                    Region region) {
  const std::optional<double> valueA = errorOf(a, region, metric), valueB = errorOf(b, region, metric);
  if (!valueA || !valueB) return std::nullopt;
  if (*valueA == *valueB) return Verdict::equal;
  if (!isNoiseKnown(a, region, metric) || !isNoiseKnown(b, region, metric)) return std::nullopt;
  return verdictOf(a, b, metric, region);
}

}  // namespace pb
