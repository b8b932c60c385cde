// What the gate's test of itself found, as Markdown.
#include <fmt/format.h>

#include <algorithm>

#include "bench/gate_words.h"
#include "bench/selftest_gate.h"
#include "bench/tables.h"

namespace pb {
namespace {

std::size_t countOf(const GateReport& report, FindingKind kind) {
  return static_cast<std::size_t>(std::ranges::count_if(
      report.findings, [&](const Finding& finding) { return finding.kind == kind && finding.level == Level::fail; }));
}

// Findings are sorted by excess.
std::string strongestError(const GateReport& report) {
  for (const Finding& finding : report.findings)
    if (finding.kind == FindingKind::changed && finding.level == Level::fail)
      return fmt::format("{} {} -> {}, {} times its limit", finding.quantity, formatGateValue(finding.before),
                         formatGateValue(finding.after), formatSignificant(finding.excess, 2));
  return "";
}

std::string count(std::size_t number) { return number > 0 ? fmt::format("{}", number) : "-"; }

}  // namespace

std::string printFaults(const std::vector<FaultOutcome>& outcomes, double smallestEnergy) {
  Table table{
      {{"fault", Align::left}, {"caught", Align::left}, {"counters"}, {"errors"}, {"strongest error", Align::left}},
      {}};
  for (const FaultOutcome& outcome : outcomes)
    table.rows.push_back({outcome.name, outcome.isCaught() ? "yes" : "NO",
                          count(countOf(outcome.report, FindingKind::counter)),
                          count(countOf(outcome.report, FindingKind::changed)), strongestError(outcome.report)});
  std::string text = toMarkdown(table);
  if (smallestEnergy > 0)
    text += fmt::format("\nSmallest change of the captures' energy that is caught: {:.2g} %.\n", 100 * smallestEnergy);
  return text;
}

std::string printRepeats(const RepeatOutcome& outcome) {
  std::string text = fmt::format("{} unchanged runs: {} alarms, {} costs measured again, {} runs with other bits.\n",
                                 outcome.runs, outcome.alarms, outcome.remeasured, outcome.differing);
  if (!outcome.costsCompared) text += "Costs were not compared: the baseline was made on another machine.\n";
  if (outcome.alarms == 0)
    text += fmt::format("With 95 % confidence an unchanged run raises an alarm in at most {:.1f} % of all cases.\n",
                        100 * outcome.alarmBound());
  for (const GateReport& report : outcome.bad)
    for (const Finding& finding : report.findings)
      if (finding.level != Level::warn)
        text += fmt::format("* {}: {} ({})\n", nameOf(finding.level), sentence(finding), finding.cell);
  return text;
}

}  // namespace pb
