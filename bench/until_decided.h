// Reference samples until the ranking of the cells is decided: `run --until-decided --budget-s T`.
#pragma once

#include <optional>
#include <string>

#include "bench/runner.h"
#include "bench/verdict.h"

namespace pb {

struct Ranking {
  RankingState state;
  std::optional<double> maxNoise;  // with which it is decided, or was last tried
  double noise = 0;                // that the noisiest reference reached with it, as relMSE
  std::string sentence;            // "all 66 pairs of cells are decided at noise 6e-05"

  bool isDecided() const { return state.undecided == 0; }
};

// Renders the last measured frame of every sequence, then lowers max_noise by factors of 4 and scores the pictures anew
// until verdicts by HDR-FLIP decide every pair of cells of a scene, the next step, four times as long as the last one,
// would not end within the budget, or samples are at their limit. max_noise never rises above the suite's own. The
// references stay in the store. The context's directory is for the pictures and of no use afterwards.
Ranking decideRanking(const RunContext& context, double budgetSeconds);

}  // namespace pb
