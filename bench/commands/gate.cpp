#include "bench/gate.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "bench/axes.h"
#include "bench/commands/commands.h"
#include "bench/report.h"
#include "scenes/files.h"

namespace pb {
namespace {

struct GateOptions {
  std::string run, baseline, junit, reason;
  bool json = false, force = false;
};

int checkRun(const GateOptions& options) {
  const Results run = readResults(options.run);
  const GateReport report = check(run, readBaseline(options.baseline), describe(Technique{}));
  if (!options.junit.empty()) writeFileAtomically(options.junit, toJUnit(report, run.provenance.suiteName));
  const std::string blessCommand =
      fmt::format("probebench bless {} --baseline {} --reason TEXT", options.run, options.baseline);
  fmt::print("{}", options.json ? toJson(report) : printGateReport(report, blessCommand));
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

void addCheckCommand(CLI::App& app, const GlobalOptions&, Action& action) {
  CLI::App* command = app.add_subcommand("check", "compare a run with a stored baseline");
  const auto options = std::make_shared<GateOptions>();
  addRunAndBaseline(*command, *options);
  command->add_option("--junit", options->junit, "write a JUnit XML file");
  command->add_flag("--json", options->json, "print one JSON object");
  command->callback([&action, options] { action = [options] { return checkRun(*options); }; });
}

void addBlessCommand(CLI::App& app, const GlobalOptions&, Action& action) {
  CLI::App* command = app.add_subcommand("bless", "store a run as the baseline");
  const auto options = std::make_shared<GateOptions>();
  addRunAndBaseline(*command, *options);
  command->add_option("--reason", options->reason, "why the numbers may change; stored")->required();
  command->add_flag("--force", options->force,
                    "also over a baseline of another GL driver, and with references noisier than max_noise");
  command->callback([&action, options] { action = [options] { return blessRun(*options); }; });
}

}  // namespace pb
