// The gate's findings as Markdown and JSON.
#include <fmt/format.h>

#include <algorithm>

#include "bench/counted.h"
#include "bench/gate.h"
#include "bench/gate_words.h"
#include "bench/json_document.h"
#include "bench/tables.h"

namespace pb {
namespace {

constexpr std::size_t kMaxShownFindings = 12;

// Missing and surplus things and failed controls have no values before and after.
bool hasValues(const Finding& finding) {
  return finding.kind == FindingKind::changed || finding.kind == FindingKind::counter ||
         finding.kind == FindingKind::cost;
}

std::vector<std::string> tableRow(const Finding& finding) {
  std::vector<std::string> row = {nameOf(finding.level), nameOf(finding.kind), finding.quantity, "", "", "",
                                  finding.cell};
  if (!hasValues(finding)) return row;
  row[3] = formatGateValue(finding.before);
  row[4] = formatGateValue(finding.after);
  row[5] = formatSignificant(finding.limit);
  return row;
}

std::string findingsTable(const GateReport& report) {
  Table table{{{"level", Align::left},
               {"kind", Align::left},
               {"what", Align::left},
               {"before"},
               {"after"},
               {"may change by"},
               {"cell", Align::left}},
              {}};
  const std::size_t shown = std::min(report.findings.size(), kMaxShownFindings);
  for (std::size_t i = 0; i < shown; ++i) table.rows.push_back(tableRow(report.findings[i]));
  std::string text = toMarkdown(table);
  if (shown < report.findings.size()) text += fmt::format("\n... and {} more.\n", report.findings.size() - shown);
  return text;
}

std::string summaryLine(const GateReport& report) {
  const std::size_t warnings = report.count(Level::warn);
  const std::string warned = warnings > 0 ? ", " + counted(warnings, "warning") : "";
  return fmt::format("{}: {}, {}{}; {}, {} and {} compared\n", nameOf(report.verdict),
                     counted(report.cells.size(), "cell"), counted(report.findings.size() - warnings, "difference"),
                     warned, counted(report.metricsCompared, "metric"), counted(report.countersCompared, "counter"),
                     counted(report.costsCompared, "cost"));
}

Json encodeOptional(const std::optional<double>& value) { return value ? encodeNumber(*value) : nullptr; }

Json findingToJson(const Finding& finding) {
  Json json;
  json["level"] = nameOf(finding.level);
  json["kind"] = nameOf(finding.kind);
  json["cell"] = finding.cell;
  json["quantity"] = finding.quantity;
  json["before"] = encodeOptional(finding.before);
  json["after"] = encodeOptional(finding.after);
  json["limit"] = encodeNumber(finding.limit);
  json["excess"] = encodeNumber(finding.excess);
  return json;
}

}  // namespace

std::string printGateReport(const GateReport& report, const GateCommands& commands) {
  std::string text = summaryLine(report);
  if (!report.findings.empty()) text += '\n' + findingsTable(report);
  if (!report.notes.empty()) text += '\n';
  for (const std::string& note : report.notes) text += fmt::format("* {}\n", note);
  if (report.count(Level::unconfirmed) > 0)
    text += fmt::format("\nA changed cost counts once a second measurement confirms it: {}\n", commands.confirm);
  // Noise is never as it should be: `bless` refuses it.
  if (report.verdict == GateVerdict::fail || report.verdict == GateVerdict::drift)
    text += fmt::format("\nIf this is as it should be: {}\n", commands.bless);
  return text;
}

std::string toJson(const GateReport& report) {
  Json head;
  head["verdict"] = nameOf(report.verdict);
  head["exit_code"] = exitCode(report.verdict);
  head["cells"] = report.cells.size();
  head["metrics_compared"] = report.metricsCompared;
  head["counters_compared"] = report.countersCompared;
  head["costs_compared"] = report.costsCompared;
  head["same_platform"] = report.samePlatform;
  head["noisy_cells"] = report.noisyCells;
  head["notes"] = report.notes;
  std::vector<Json> rows;
  for (const Finding& finding : report.findings) rows.push_back(findingToJson(finding));
  return printDocument(head, "findings", rows);
}

}  // namespace pb
