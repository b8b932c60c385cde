#include "bench/over_time.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "bench/statistics.h"

namespace pb {
namespace {

using CellValue = std::function<std::optional<double>(const CellResult&)>;

std::optional<FrameSummary> summarize(const Sequence& sequence, const CellValue& valueOf, bool lowerIsBetter) {
  const double sign = lowerIsBetter ? 1.0 : -1.0;
  FrameSummary summary;
  std::vector<double> badness;
  for (const CellResult* cell : sequence)
    if (const std::optional<double> value = valueOf(*cell)) {
      if (badness.empty() || sign * *value > sign * summary.worst) {
        summary.worst = *value;
        summary.worstFrame = cell->frame;
      }
      badness.push_back(sign * *value);
      summary.mean += *value;
    }
  if (badness.empty()) return std::nullopt;
  summary.frames = static_cast<int>(badness.size());
  summary.mean /= summary.frames;
  summary.p95 = sign * quantile(badness, 0.95);
  return summary;
}

}  // namespace

std::optional<FrameSummary> summarizeErrors(const Sequence& sequence, Region region, const std::string& metric) {
  return summarize(
      sequence, [&](const CellResult& cell) { return errorOf(cell, region, metric); }, isLowerBetter(metric));
}

std::optional<double> flickerOf(const CellResult& cell, Region region) {
  if (!cell.flicker) return std::nullopt;
  return region == Region::whole ? std::optional(cell.flicker->whole) : cell.flicker->mask;
}

std::optional<FrameSummary> summarizeFlicker(const Sequence& sequence, Region region) {
  return summarize(
      sequence, [&](const CellResult& cell) { return flickerOf(cell, region); }, true);
}

std::vector<StalePoint> errorsByStaleness(const Sequence& sequence, Region region, const std::string& metric) {
  std::vector<StalePoint> points;
  for (const CellResult* cell : sequence) {
    const std::optional<double> error = errorOf(*cell, region, metric);
    const std::optional<AgeSummary> ages = summaryOf(cell->faceAgeFrames);
    if (error && ages) points.push_back({cell->frame, ages->mean, ages->largest, *error});
  }
  return points;
}

std::vector<StaleMean> meansByAge(const std::vector<StalePoint>& points) {
  std::map<std::int64_t, StaleMean> byAge;
  for (const StalePoint& point : points) {
    StaleMean& mean = byAge[std::llround(point.meanAge)];
    mean.error += point.error;
    ++mean.frames;
  }
  std::vector<StaleMean> means;
  for (const auto& [age, sum] : byAge) means.push_back({age, sum.error / sum.frames, sum.frames});
  return means;
}

}  // namespace pb
