#include "bench/until_decided.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "bench/interval_runner.h"

namespace pb {
namespace {

constexpr char kMetric[] = "flip_hdr";
constexpr double kStep = 4;  // in max_noise: half of an interval's width, for four times the samples
// What samples can do is done when a step gains less than this.
constexpr double kLeastGain = 0.9;

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// The noise of the noisiest reference, as relMSE.
double largestNoise(const std::vector<CellResult>& cells) {
  double largest = 0;
  for (const CellResult& cell : cells)
    for (const auto& [metric, value] : cell.floor)
      if (metric == "relmse") largest = std::max(largest, value);
  return largest;
}

// Errors of the last frames only.
Suite trialSuite(const Suite& suite) {
  Suite trial = suite;
  trial.cost.repetitions = 0;
  trial.attribution.reset();
  trial.reference.matched = false;
  return trial;
}

Plan trialPlan(const Plan& plan) {
  Plan trial = plan;
  for (PlannedSequence& sequence : trial.sequences) sequence.frames = {sequence.frames.back()};
  return trial;
}

std::string sentenceOf(const Ranking& ranking, const char* reason) {
  if (ranking.isDecided())
    return fmt::format("all {} pairs of cells are decided at noise {:.3g}", ranking.state.pairs, ranking.noise);
  return fmt::format("{} of {} pairs of cells are not decided at noise {:.3g}: {}", ranking.state.undecided,
                     ranking.state.pairs, ranking.noise, reason);
}

}  // namespace

Ranking decideRanking(const RunContext& context, double budgetSeconds) {
  const Clock::time_point start = Clock::now();
  Suite suite = trialSuite(context.suite);
  const Plan plan = trialPlan(context.plan);
  const RunContext trial{suite,           context.scenes, plan, context.device, context.store, context.directory,
                         context.progress};
  std::vector<CellResult> cells = runPlan(trial).cells;
  Ranking ranking{rankingState(cells, kMetric), suite.reference.maxNoise, largestNoise(cells), {}};
  const char* reason = "more samples would take longer than the budget";
  double roundSeconds = 0;
  while (!ranking.isDecided()) {
    if (secondsSince(start) + roundSeconds > budgetSeconds) break;
    const Clock::time_point round = Clock::now();
    const double noise = ranking.noise;
    suite.reference.maxNoise = std::min(noise / kStep, suite.reference.maxNoise.value_or(noise));
    context.progress.message(
        fmt::format("{} of {} pairs of cells are not decided at noise {:.3g}: next max_noise {:.3g}",
                    ranking.state.undecided, ranking.state.pairs, noise, *suite.reference.maxNoise));
    rescore(trial, cells);
    ranking = {rankingState(cells, kMetric), suite.reference.maxNoise, largestNoise(cells), {}};
    if (!ranking.isDecided() && ranking.noise >= kLeastGain * noise) {
      reason = "samples are at their limit";
      break;
    }
    roundSeconds = kStep * secondsSince(round);
  }
  ranking.sentence = sentenceOf(ranking, reason);
  return ranking;
}

}  // namespace pb
