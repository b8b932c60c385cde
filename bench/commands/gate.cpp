#include "bench/gate.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "bench/axes.h"
#include "bench/commands/commands.h"
#include "bench/remeasure.h"
#include "bench/report.h"
#include "bench/shell_word.h"
#include "scenes/files.h"

namespace pb {
namespace {

struct GateOptions {
  std::string run, baseline, junit, reason, confirm, rerun, annotations;
  bool json = false, force = false;
};

// Costs that changed are measured again where the options say how.
GateReport checkAgain(const GateOptions& options, const Results& run, const Baseline& baseline,
                      const GlobalOptions& globals) {
  const AxisValues defaults = describe(Technique{});
  if (!options.confirm.empty()) {
    const Results rerun = readResults(options.confirm);
    return check(run, baseline, defaults, &rerun);
  }
  if (!options.rerun.empty()) requireRunOf(run, options.rerun);  // also where no cost turns out to have changed
  const GateReport first = check(run, baseline, defaults);
  const std::vector<std::string> changed = first.unconfirmedCosts();
  if (options.rerun.empty() || changed.empty()) return first;
  const Results rerun = remeasureRun(run, options.rerun, changed, globals.backend(), globals.threadCount());
  return check(run, baseline, defaults, &rerun);
}

int checkRun(const GateOptions& options, const GlobalOptions& globals) {
  const Results run = readResults(options.run);
  const GateReport report = checkAgain(options, run, readBaseline(options.baseline), globals);
  if (!options.junit.empty()) writeFileAtomically(options.junit, toJUnit(report, run.provenance.suiteName));
  const std::string files = fmt::format("{} --baseline {}", shellWord(options.run), shellWord(options.baseline));
  const GateCommands commands{fmt::format("probebench bless {} --reason TEXT", files),
                              fmt::format("probebench check {} --rerun SUITE", files)};
  fmt::print("{}", options.json ? toJson(report) : printGateReport(report, commands));
  if (options.annotations == "github") fmt::print("\n{}", toGitHubAnnotations(report));
  return exitCode(report.verdict);
}

int blessRun(const GateOptions& options) {
  bless(readResults(options.run), options.baseline, options.reason, options.force, describe(Technique{}));
  fmt::print(stderr, "blessed: {}\n", options.baseline);
  return 0;
}

void addRunAndBaseline(CLI::App& command, GateOptions& options) {
  command.add_option("RUN_DIR", options.run, "folder of a run")->required();
  command.add_option("--baseline", options.baseline, "baseline file")->required();
}

}  // namespace

void addCheckCommand(CLI::App& app, const GlobalOptions& globals, Action& action) {
  CLI::App* command = app.add_subcommand("check", "compare a run with a stored baseline");
  const auto options = std::make_shared<GateOptions>();
  addRunAndBaseline(*command, *options);
  CLI::Option* confirm = command->add_option("--confirm", options->confirm,
                                             "folder of a second run: costs count as changed if they are there too");
  command->add_option("--rerun", options->rerun, "the run's suite: costs that changed are measured once more")
      ->excludes(confirm);
  command->add_option("--junit", options->junit, "write a JUnit XML file");
  CLI::Option* json = command->add_flag("--json", options->json, "print one JSON object");
  command->add_option("--annotations", options->annotations, "also print findings for a service: github")
      ->check(CLI::IsMember({"github"}))
      ->excludes(json);
  command->callback(
      [&action, &globals, options] { action = [&globals, options] { return checkRun(*options, globals); }; });
}

void addBlessCommand(CLI::App& app, const GlobalOptions&, Action& action) {
  CLI::App* command = app.add_subcommand("bless", "store a run as the baseline");
  const auto options = std::make_shared<GateOptions>();
  addRunAndBaseline(*command, *options);
  command->add_option("--reason", options->reason, "why the numbers may change; stored")->required();
  command->add_flag("--force", options->force,
                    "also over a baseline of another platform, and with references noisier than max_noise");
  command->callback([&action, options] { action = [options] { return blessRun(*options); }; });
}

}  // namespace pb
