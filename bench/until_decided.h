// Reference samples until the ranking of the cells is decided: `run --until-decided --budget-s T`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bench/runner.h"
#include "bench/verdict.h"

namespace pb {

struct Ranking {
  RankingState state;
  std::optional<double> maxNoise;  // with which it is decided, or was last tried
  double noise = 0;                // that the noisiest reference reached with it, as relMSE
  SkippedExternals skipped;        // without a picture to rank
  std::string sentence;            // "all 66 pairs of cells are decided at noise 6e-05"

  bool isDecided() const { return state.undecided == 0; }
};

// Renders the measured frames of every sequence and keeps them for the run (bench/kept_pictures.h), as pictures don't
// depend on samples of the reference. Then scores the last ones, and lowers max_noise by factors of 4 and scores them
// anew until verdicts by HDR-FLIP decide every pair of cells of a scene, the next step, four times as long as the last
// one, would not end within the budget (of scoring), or samples are at their limit. max_noise never rises above the
// suite's own. The references stay in the store.
Ranking decideRanking(const RunContext& context, double budgetSeconds);

// A ranking in the folder of its run, so that a run that goes on has the max_noise that it was started with. Throws an
// environment Error if it can't be written, an input Error if what is there can't be read; nullopt without any.
void writeRanking(const Ranking& ranking, const std::filesystem::path& folder);
std::optional<Ranking> readRanking(const std::filesystem::path& folder);

}  // namespace pb
