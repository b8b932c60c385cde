#include "bench/report.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "bench/axes.h"
#include "bench/commands/commands.h"

namespace pb {
namespace {

int report(const std::string& run, const std::string& output) {
  const Results results = readResults(run);
  fmt::print("{}", makeReport(results, describe(Technique())));
  if (!output.empty()) writeReport(results, output, describe(Technique()));
  return 0;
}

}  // namespace

void addReportCommand(CLI::App& app, const GlobalOptions&, Action& action) {
  CLI::App* command = app.add_subcommand("report", "tables of a run");
  const auto run = std::make_shared<std::string>();
  const auto output = std::make_shared<std::string>();
  command->add_option("RUN_DIR", *run, "folder of a run")->required();
  command->add_option("-o", *output, "also write report.md and report.csv there");
  command->callback([&action, run, output] { action = [run, output] { return report(*run, *output); }; });
}

}  // namespace pb
