#include "bench/until_decided.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "bench/counted.h"
#include "bench/interval_runner.h"
#include "bench/kept_pictures.h"
#include "scenes/error.h"
#include "scenes/files.h"

namespace pb {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kMetric[] = "flip_hdr";
constexpr char kRankingFile[] = "ranking.json";
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

// In the plan's order, without scores: what the pictures show of each sequence in the end. External techniques that
// were skipped have none.
std::vector<CellResult> lastCells(const Plan& plan, const KeptPictures& pictures) {
  std::vector<CellResult> cells;
  for (const PlannedSequence& sequence : plan.sequences)
    if (const CellResult* cell = pictures.find(sequence, sequence.frames.back())) cells.push_back(*cell);
  return cells;
}

// "1 of 66 pairs of cells is not decided at noise 6e-05".
std::string openPairs(const Ranking& ranking) {
  const auto& [pairs, undecided] = ranking.state;
  return fmt::format("{} of {} of cells {} not decided at noise {:.3g}", undecided, counted(pairs, "pair"),
                     undecided == 1 ? "is" : "are", ranking.noise);
}

std::string sentenceOf(const Ranking& ranking, const char* reason) {
  const auto& [pairs, undecided] = ranking.state;
  if (pairs == 0) return "no two cells are to be told apart";
  if (!ranking.isDecided()) return fmt::format("{}: {}", openPairs(ranking), reason);
  return fmt::format("{} decided at noise {:.3g}",
                     pairs == 1 ? "the only pair of cells is" : fmt::format("all {} pairs of cells are", pairs),
                     ranking.noise);
}

}  // namespace

Ranking decideRanking(const RunContext& context, double budgetSeconds) {
  KeptPictures pictures(context);
  SkippedExternals skipped = renderAndKeep(context, pictures);
  std::vector<CellResult> cells = lastCells(context.plan, pictures);
  const Clock::time_point start = Clock::now();
  Suite suite = context.suite;
  const RunContext trial{suite,         context.scenes,    context.plan,    context.device,
                         context.store, context.directory, context.progress};
  rescore(trial, cells);
  Ranking ranking{rankingState(cells, kMetric), suite.reference.maxNoise, largestNoise(cells), {}, {}};
  const char* reason = "more samples would take longer than the budget";
  double roundSeconds = 0;
  while (!ranking.isDecided()) {
    if (secondsSince(start) + roundSeconds > budgetSeconds) break;
    const Clock::time_point round = Clock::now();
    const double noise = ranking.noise;
    suite.reference.maxNoise = std::min(noise / kStep, suite.reference.maxNoise.value_or(noise));
    context.progress.message(fmt::format("{}: next max_noise {:.3g}", openPairs(ranking), *suite.reference.maxNoise));
    rescore(trial, cells);
    ranking = {rankingState(cells, kMetric), suite.reference.maxNoise, largestNoise(cells), {}, {}};
    if (!ranking.isDecided() && ranking.noise >= kLeastGain * noise) {
      reason = "samples are at their limit";
      break;
    }
    roundSeconds = kStep * secondsSince(round);
  }
  ranking.skipped = std::move(skipped);
  ranking.sentence = sentenceOf(ranking, reason);
  return ranking;
}

void writeRanking(const Ranking& ranking, const std::filesystem::path& folder) {
  const Json json = {{"pairs", ranking.state.pairs},
                     {"undecided", ranking.state.undecided},
                     {"max_noise", ranking.maxNoise ? Json(*ranking.maxNoise) : Json()},
                     {"noise", ranking.noise},
                     {"sentence", ranking.sentence}};
  writeFileAtomically((folder / kRankingFile).string(), json.dump(2) + "\n");
}

std::optional<Ranking> readRanking(const std::filesystem::path& folder) {
  const std::string path = (folder / kRankingFile).string();
  if (!std::filesystem::exists(path)) return std::nullopt;
  try {
    const Json json = Json::parse(readFile(path));
    Ranking ranking;
    ranking.state = {json.at("pairs").get<std::size_t>(), json.at("undecided").get<std::size_t>()};
    if (!json.at("max_noise").is_null()) ranking.maxNoise = json.at("max_noise").get<double>();
    ranking.noise = json.at("noise").get<double>();
    ranking.sentence = json.at("sentence").get<std::string>();
    return ranking;
  } catch (const Json::exception&) {
    throwInputError("'{}' was not written by probebench, run without --resume", path);
  }
}

}  // namespace pb
