#include "bench/report.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "bench/axes.h"
#include "bench/commands/commands.h"
#include "bench/commands/validators.h"
#include "bench/recommend.h"
#include "bench/report/brief.h"
#include "bench/report/comparison.h"
#include "bench/report/page.h"
#include "scenes/files.h"

namespace pb {
namespace {

struct ReportOptions {
  std::string run, other, output;
  bool brief = false;
  double pageMb = kDefaultPageMb;
};

// A report without some pictures is still a report.
void warnOfMissing(const std::vector<std::string>& pictures) {
  if (pictures.empty()) return;
  fmt::print(stderr, "warning: {} {} missing or damaged and not in the page; the first: {}\n", pictures.size(),
             pictures.size() == 1 ? "picture is" : "pictures are", pictures.front());
}

int reportRun(const ReportOptions& options) {
  const Results results = readResults(options.run);
  const AxisValues defaults = describe(Technique());
  const std::vector<std::string> answer = summaryLines(results, {options.run, defaults});
  if (!options.output.empty()) makeReportFolder(options.output);  // before anything is printed
  fmt::print("{}", options.brief ? makeBrief(results, answer) : makeReport(results, defaults));
  if (options.output.empty()) return 0;
  writeReport(results, options.output, defaults);
  warnOfMissing(writePage({{"", options.run, results}}, answer, pageOfRun(options.output), options.pageMb));
  fmt::print(stderr, "report: {}\n", pageOfRun(options.output));
  return 0;
}

// The report of two runs is short enough for a pull request as it is.
int reportChange(const ReportOptions& options) {
  const Results before = readResults(options.run), after = readResults(options.other);
  const AxisValues defaults = describe(Technique());
  const std::string text = makeComparisonReport(before, after, defaults);
  if (!options.output.empty()) makeReportFolder(options.output);
  fmt::print("{}", text);
  if (options.output.empty()) return 0;
  writeFileAtomically(options.output + "/report.md", text);
  writeFileAtomically(options.output + "/report.csv", comparisonToCsv(before, after, defaults));
  warnOfMissing(writePage({{"before", options.run, before}, {"after", options.other, after}},
                          summaryLines(after, {options.other, defaults}), pageOfRun(options.output), options.pageMb));
  fmt::print(stderr, "report: {}\n", pageOfRun(options.output));
  return 0;
}

}  // namespace

void addReportCommand(CLI::App& app, const GlobalOptions&, Action& action) {
  CLI::App* command = app.add_subcommand("report", "tables and pictures of a run, or of two runs compared");
  const auto options = std::make_shared<ReportOptions>();
  command->add_option("RUN_DIR", options->run, "folder of a run")->required();
  command->add_option("OTHER", options->other, "folder of a later run: cell by cell, what changed from RUN_DIR to it");
  command->add_option("-o", options->output, "also write report.md, report.csv and the page report.html there")
      ->check(folderName());
  command->add_flag("--pull-request", options->brief, "print a few lines instead of all tables");
  command->add_option("--page-mb", options->pageMb, "largest report.html; beyond it the pictures stand beside it")
      ->check(numberFrom(0, 1e6))
      ->capture_default_str();
  command->callback([&action, options] {
    action = [options] { return options->other.empty() ? reportRun(*options) : reportChange(*options); };
  });
}

}  // namespace pb
