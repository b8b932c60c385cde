// Which of two errors is smaller, as far as that can be known: against the reference's noise, pure functions.
//
// What decides is the difference of the two (bench/differences.h): paired where both are scored against the same
// batches of the same reference, by overlap of their intervals where they are not.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/candidates.h"
#include "bench/differences.h"
#include "bench/estimate.h"
#include "bench/results.h"
#include "bench/sections.h"

namespace pb {

enum class Verdict {
  better,      // the whole interval of the difference lies below 0
  worse,       // above
  equal,       // it holds 0
  belowFloor,  // neither error is clear of the reference's own noise (isClearOfFloor()), nor verdictBelowFloor() sure
};

// Of the first, seen from the second, where one of them is clear of the floor.
Verdict verdictOf(const Difference& difference);

// Where neither is. Noise that is larger than both errors has a preference of its own: by most metrics the picture
// looks better that is nearer to the median of the noise, and rendering noise is skewed, so that the median is darker
// than the mean. The jackknife takes out only a part of that. But the difference of two mean squared errors has no
// bias: E[(I_a - R)^2 - (I_b - R)^2] = (I_a - E R)^2 - (I_b - E R)^2, as the variance of R cancels. So a difference
// decides only if it is paired, and that of "mse" (in the same frames) too, clear, and of the same sign.
Verdict verdictBelowFloor(const Difference& difference, const Difference& mse);

// Of a, seen from b, of which nothing is known in common. Smaller is better.
Verdict verdictOf(const Estimate& a, const Estimate& b);

// "better", "worse", "equal within the interval", "below the floor".
std::string printVerdict(Verdict verdict);

// Of two candidates of a set, by its selection; nullopt where the difference is unknown and not 0.
std::optional<Verdict> verdictOf(const CandidateSet& set, std::size_t a, std::size_t b);

// Of two cells of the same scene, camera and frame, of one run or two, by a metric of metricTable() in which more may
// be better. nullopt where it is undefined in one of them. What is unknown is not decided.
std::optional<Verdict> verdictOf(const CellResult& a, const CellResult& b, const std::string& metric, Region region);

// How far the ranking of the cells of each scene, camera and frame is decided, over all pairs of cells that have an
// interval of the metric. Pairs of the same value (techniques that do the same) are no question.
struct RankingState {
  std::size_t pairs = 0;
  std::size_t undecided = 0;  // equal within the interval, or below the floor
};
RankingState rankingState(const std::vector<CellResult>& cells, const std::string& metric);

}  // namespace pb
