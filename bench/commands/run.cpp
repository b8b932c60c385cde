#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bench/axes.h"
#include "bench/certify.h"
#include "bench/commands/commands.h"
#include "bench/commands/validators.h"
#include "bench/plan.h"
#include "bench/plan_check.h"
#include "bench/provenance.h"
#include "bench/recommend.h"
#include "bench/report.h"
#include "bench/report/page.h"
#include "bench/runner.h"
#include "bench/shell_word.h"
#include "bench/truth.h"
#include "bench/until_decided.h"
#include "bench/version.h"
#include "bench/work.h"
#include "scenes/error.h"

namespace pb {
namespace {

struct RunOptions {
  std::string suite, output, store;
  std::vector<std::string> scenes, settings;
  std::optional<std::string> only, shard;
  bool noCost = false, resume = false, dryRun = false, untilDecided = false;
  std::optional<double> budgetSeconds;
};

// Comparisons with NaN would end the search at once or never.
void requireBudget(const RunOptions& options) {
  if (options.budgetSeconds && !(*options.budgetSeconds > 0 && std::isfinite(*options.budgetSeconds)))
    throwInputError("--budget-s must be positive and finite, got {:g}", *options.budgetSeconds);
}

// The suite as the options change it.
Suite effectiveSuite(const RunOptions& options) {
  Suite suite = loadSuite(options.suite);
  if (!options.scenes.empty()) {
    const SuiteScene like = suite.scenes.front();
    suite.scenes.clear();
    for (const std::string& reference : options.scenes) suite.scenes.push_back(sceneLike(like, reference));
  }
  if (options.noCost) suite.cost.repetitions = 0;
  std::set<std::string> axes;
  for (const std::string& text : options.settings) {
    GridAxis axis = parseAxisValues(text);
    if (!axes.insert(axis.first).second) throwInputError("--set names axis '{}' twice", axis.first);
    setGridAxis(suite, std::move(axis));
  }
  return suite;
}

PlanFilter filterOf(const RunOptions& options) {
  return {options.only, options.shard ? parseShard(*options.shard) : Shard()};
}

void printWarnings(const Scenes& scenes) {
  for (const auto& scene : scenes)
    for (const std::string& warning : scene->warnings) fmt::print(stderr, "warning: {}: {}\n", scene->name, warning);
}

// What `recommend` starts its commands with: everything of the command line that decides the numbers.
std::string commandOf(const RunOptions& options) {
  std::string text = "probebench run " + shellWord(options.suite);
  for (const std::string& scene : options.scenes) text += " --scene " + shellWord(scene);
  for (const std::string& setting : options.settings) text += " --set " + shellWord(setting);
  if (options.noCost) text += " --no-cost";
  return text;
}

// Rates of one machine say nothing about another.
std::string machineOf(const GlobalOptions& globals) {
  return fmt::format("{}, {} threads, {}", cpuName(), globals.threadCount(),
                     globals.backend() == GlBackend::egl ? "egl" : "osmesa");
}

// The suite's numbers mean nothing if the two renderers disagree where nothing is approximated.
std::string passControl(RasterDevice& device, Progress& progress) {
  progress.begin("control", 1);
  const std::vector<Check> checks = runControl(device);
  progress.step();
  progress.end();
  if (!allPassed(checks)) throw Error(Failure::verdict, "the control failed, no suite is run: " + summary(checks));
  return summary(checks);
}

// Prints what a complete run found and sees to its page.
void showResults(const Results& results, const std::string& folder, bool hasPage) {
  const std::vector<std::string> answer = summaryLines(results, {folder, describe(Technique())});
  if (!hasPage) writePage({{"", folder, results}}, answer, pageOfRun(folder));
  fmt::print("{}\n", makeReport(results, describe(Technique())));
  if (!answer.empty()) fmt::print("{}\n\n", fmt::join(answer, "\n"));
  fmt::print("report: {}\n", pageOfRun(folder));
  std::fflush(stdout);  // before what follows on the other stream
}

void finishRun(const RunOutcome& outcome, Provenance provenance, const Suite& suite, RunDirectory& directory) {
  for (const auto& [what, why] : outcome.skipped) provenance.settings.emplace_back(what, "skipped: " + why);
  const Results results{std::move(provenance), suite.tolerance,          outcome.cells,
                        suite.warnTolerance,   sceneTolerancesOf(suite), outcome.attribution};
  directory.finish(results, outcome.benchmarkJson);
  showResults(results, directory.folder().string(), false);
}

// The verdict comes last: what the run leaves open.
int conclude(const std::vector<std::string>& noisyReferences, const std::optional<Ranking>& ranking) {
  std::vector<std::string> open;
  if (const std::size_t count = noisyReferences.size(); count > 0)
    open.push_back(fmt::format("{} too noisy; the first: {}",
                               count == 1 ? "1 reference is" : fmt::format("{} references are", count),
                               noisyReferences.front()));
  if (ranking && !ranking->isDecided()) open.push_back(ranking->sentence);
  if (!open.empty()) throw Error(Failure::inconclusive, fmt::format("{}", fmt::join(open, "; ")));
  if (ranking) fmt::print(stderr, "{}\n", ranking->sentence);
  return 0;
}

// With what max_noise the ranking is decided, as far as the budget goes; of a run that goes on, as it was found before.
Ranking decide(const RunOptions& options, const RunContext& context) {
  const std::filesystem::path& folder = context.directory.folder();
  if (options.resume)
    if (std::optional<Ranking> found = readRanking(folder)) return *std::move(found);
  Ranking ranking = decideRanking(context, options.budgetSeconds.value_or(std::numeric_limits<double>::infinity()));
  fmt::print(stderr, "{}\n", ranking.sentence);
  writeRanking(ranking, folder);
  return ranking;
}

// Its max_noise was a means: what a reference may fail to meet is the suite's own.
void note(const Ranking& ranking, const std::optional<double>& ownMaxNoise, Provenance& provenance,
          RunOutcome& outcome) {
  provenance.settings.emplace_back("ranking", ranking.sentence);
  provenance.maxNoise = ownMaxNoise;
  if (findNoisyReferences(outcome.cells, ownMaxNoise).empty()) outcome.noisyReferences.clear();
}

// What a run goes on with, the max_noise that --until-decided finds included, stands in its folder.
RunIdentity identityOf(const Provenance& provenance, const Plan& plan, const Suite& suite, const RunOptions& options) {
  return {suite.name, fingerprint(provenance, plan, suite) + (options.untilDecided ? " until decided" : "")};
}

// What an earlier run found if it is complete and of the suite's tolerances, which its identity leaves out: nothing of
// it is measured again, neither the control nor costs. Techniques whose program was missing may have it now.
std::optional<Results> readComplete(const std::string& folder, const RunIdentity& identity, const Suite& suite,
                                    const Plan& plan) {
  if (!RunDirectory::hasResults(folder)) return std::nullopt;
  if (RunDirectory(folder, identity, true).finishedCells().size() != plan.cellCount()) return std::nullopt;
  Results results = readResults(folder);
  const bool areItsTolerances = results.tolerance == suite.tolerance && results.warnTolerance == suite.warnTolerance &&
                                results.sceneTolerances == sceneTolerancesOf(suite);
  if (results.cells.size() != plan.cellCount() || !areItsTolerances) return std::nullopt;
  return results;
}

int showComplete(const Results& results, TruthSettings reference, const RunOptions& options,
                 const std::string& folder) {
  fmt::print(stderr, "the run in '{}' is complete: nothing is measured again\n", folder);
  showResults(results, folder, std::filesystem::exists(pageOfRun(folder)));
  const std::optional<Ranking> ranking = options.untilDecided ? readRanking(folder) : std::nullopt;
  const bool isQuiet = findNoisyReferences(results.cells, reference.maxNoise).empty();  // as note() has it
  if (ranking) reference.maxNoise = ranking->maxNoise;
  return conclude(isQuiet ? std::vector<std::string>() : describeNoisyReferences(results.cells, reference), ranking);
}

// Measures what is missing; `suite` is the context's.
int measure(const RunOptions& options, Suite& suite, const RunContext& context, Provenance provenance,
            const PlanWork& work, Rates& rates) {
  const std::optional<double> ownMaxNoise = suite.reference.maxNoise;
  std::optional<Ranking> ranking;
  if (options.untilDecided) {
    ranking = decide(options, context);
    suite.reference.maxNoise = ranking->maxNoise;
    const std::string control = std::move(provenance.controlOutcome);
    provenance = makeProvenance(suite, context.scenes, context.device.info(), provenance.threads);
    provenance.controlOutcome = control;
  }
  provenance.settings.emplace_back(kCommandSetting, commandOf(options));
  RunOutcome outcome = runPlan(context, ranking ? ranking->skipped : SkippedExternals());
  // Rates are not those of a part of a run, nor of one whose pictures and references were there before.
  if (!options.resume && !options.untilDecided) {
    rates.record(context.progress.phases(), work);
    rates.save();
  }
  if (ranking) note(*ranking, ownMaxNoise, provenance, outcome);
  finishRun(outcome, std::move(provenance), suite, context.directory);
  return conclude(outcome.noisyReferences, ranking);
}

int run(const RunOptions& options, const GlobalOptions& globals) {
  requireBudget(options);
  Suite suite = effectiveSuite(options);
  const Scenes scenes = loadScenes(suite);
  const Plan plan = makePlan(suite, filterOf(options));
  RasterDevice device(globals.backend());
  checkPlan(suite, scenes, plan, device);
  const ReferenceStore store(options.store.empty() ? defaultStoreFolder() : std::filesystem::path(options.store));
  PlanWork work = computeWork(suite, scenes, plan, store);
  work.untilDecided = options.untilDecided;
  Rates rates(store.folder(), machineOf(globals));
  const std::string planned = printPlan(suite, plan) + printWork(work, rates);
  if (options.dryRun) {
    fmt::print("{}", planned);
    return 0;
  }
  const std::string folder = options.output.empty() ? "out/" + suite.name : options.output;
  Provenance provenance = makeProvenance(suite, scenes, device.info(), globals.threadCount());
  const RunIdentity identity = identityOf(provenance, plan, suite, options);
  if (options.resume)
    if (const std::optional<Results> results = readComplete(folder, identity, suite, plan))
      return showComplete(*results, suite.reference, options, folder);
  fmt::print(stderr, "{}", planned);
  printWarnings(scenes);
  requireExternals(suite, scenes, plan);

  Progress progress;
  provenance.controlOutcome = passControl(device, progress);
  RunDirectory directory(folder, identity, options.resume);  // last, as it removes an earlier run
  return measure(options, suite, {suite, scenes, plan, device, store, directory, progress}, std::move(provenance), work,
                 rates);
}

// Says what an interrupt leaves behind.
int runOrExplain(const RunOptions& options, const GlobalOptions& globals) {
  try {
    return run(options, globals);
  } catch (const Error& error) {
    if (error.kind() != Failure::interrupted) throw;
    throw Error(Failure::interrupted, "interrupted; finished cells are kept, the same command with --resume goes on");
  }
}

}  // namespace

void addRunCommand(CLI::App& app, const GlobalOptions& globals, Action& action) {
  CLI::App* command = app.add_subcommand("run", "run a suite: errors, costs, tables");
  const auto options = std::make_shared<RunOptions>();
  command->add_option("SUITE", options->suite, "a .toml file or the name of a shipped suite")->required();
  command->add_option("--out", options->output, "folder of the run (default out/SUITE)")->check(folderName());
  command->add_option("--scene", options->scenes, "in place of the suite's scenes; repeatable")
      ->allow_extra_args(false);
  command->add_option("--set", options->settings, "AXIS=V1,V2..: in place of the suite's values; repeatable")
      ->allow_extra_args(false);
  command->add_option("--only", options->only, "only cells whose key matches this regular expression");
  command->add_option("--shard", options->shard, "I/N: only part I of N; see merge");
  command->add_option("--store", options->store, "folder of stored references")->check(folderName());
  command->add_flag("--no-cost", options->noCost, "measure errors only");
  command->add_flag("--resume", options->resume, "go on with a run that was stopped");
  CLI::Option* decided =
      command->add_flag("--until-decided", options->untilDecided, "add reference samples until the ranking is decided");
  command
      ->add_option("--budget-s", options->budgetSeconds,
                   "seconds of scoring that --until-decided may take (default: no limit)")
      ->needs(decided);
  command->add_flag("--dry-run", options->dryRun, "print what would be measured");
  command->callback(
      [&action, &globals, options] { action = [&globals, options] { return runOrExplain(*options, globals); }; });
}

}  // namespace pb
