// Which of two errors is smaller, as far as that can be known: against the reference's noise, pure functions.
#pragma once

#include <string>

#include "bench/estimate.h"
#include "bench/results.h"
#include "bench/sections.h"

namespace pb {

enum class Verdict {
  better,      // the whole interval lies below the other's
  worse,       // above
  equal,       // the intervals overlap, or neither has one and the values are the same
  belowFloor,  // neither error is clear of the reference's own noise (isClearOfFloor())
};

// Of a, seen from b. Smaller is better.
Verdict verdictOf(const Estimate& a, const Estimate& b, bool aIsClear = true, bool bIsClear = true);

// "better", "worse", "equal within the interval", "below the floor".
std::string printVerdict(Verdict verdict);

// Of two cells of the same scene, camera and frame, by a metric of metricTable() in which more may be better. nullopt
// where it is undefined in one of them.
std::optional<Verdict> verdictOf(const CellResult& a, const CellResult& b, const std::string& metric, Region region);

// How far the ranking of the cells of each scene, camera and frame is decided, over all pairs of cells that have an
// interval of the metric. Pairs of the same value (techniques that do the same) are no question.
struct RankingState {
  std::size_t pairs = 0;
  std::size_t undecided = 0;  // equal within the interval, or below the floor
};
RankingState rankingState(const std::vector<CellResult>& cells, const std::string& metric);

}  // namespace pb
