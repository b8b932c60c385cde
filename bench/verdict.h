// Which of two errors is smaller, as far as that can be known: against the reference's noise, pure functions.
//
// What decides is the difference of the two (bench/differences.h): paired where both are scored against the same
// batches of the same reference, by overlap of their intervals where they are not.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/differences.h"
#include "bench/estimate.h"
#include "bench/results.h"
#include "bench/sections.h"

namespace pb {

enum class Verdict {
  better,      // the whole interval of the difference lies below 0
  worse,       // above
  equal,       // it holds 0
  belowFloor,  // it does, or is not paired, and neither error is clear of the reference's own noise (isClearOfFloor())
};

// Of the first, seen from the second. A paired difference that is clear decides below the floor as well: noise that is
// larger than both errors adds to both alike, and what it adds differently is in the interval. Unpaired, two numbers
// that are mostly noise say nothing.
Verdict verdictOf(const Difference& difference, bool anyIsClear = true);

// Of a, seen from b, of which nothing is known in common. Smaller is better.
Verdict verdictOf(const Estimate& a, const Estimate& b, bool aIsClear = true, bool bIsClear = true);

// "better", "worse", "equal within the interval", "below the floor".
std::string printVerdict(Verdict verdict);

// Of two cells of the same scene, camera and frame, of one run or two, by a metric of metricTable() in which more may
// be better. nullopt where it is undefined in one of them.
std::optional<Verdict> verdictOf(const CellResult& a, const CellResult& b, const std::string& metric, Region region);

// How far the ranking of the cells of each scene, camera and frame is decided, over all pairs of cells that have an
// interval of the metric. Pairs of the same value (techniques that do the same) are no question.
struct RankingState {
  std::size_t pairs = 0;
  std::size_t undecided = 0;  // equal within the interval, or below the floor
};
RankingState rankingState(const std::vector<CellResult>& cells, const std::string& metric);

}  // namespace pb
