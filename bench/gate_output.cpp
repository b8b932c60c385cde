// The gate's findings as Markdown, JSON and JUnit XML.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/gate.h"
#include "bench/json_document.h"
#include "bench/tables.h"

namespace pb {
namespace {

constexpr std::size_t kMaxShownFindings = 12;

// JUnit test cases that stand for no cell.
constexpr char kControlCase[] = "control";
constexpr char kCostCase[] = "cost";

constexpr char kNoisy[] = "within tolerance, but the reference is noisier than max_noise";

const char* nameOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::inconclusive:
      return "inconclusive";
    case Verdict::drift:
      return "drift";
  }
  return "";
}

const char* nameOf(FindingKind kind) {
  switch (kind) {
    case FindingKind::changed:
      return "changed";
    case FindingKind::missing:
      return "missing";
    case FindingKind::surplus:
      return "surplus";
    case FindingKind::counter:
      return "counter";
    case FindingKind::cost:
      return "cost";
    case FindingKind::control:
      return "control";
  }
  return "";
}

// Missing and surplus things and failed controls have no values before and after.
bool hasValues(const Finding& finding) {
  return finding.kind == FindingKind::changed || finding.kind == FindingKind::counter ||
         finding.kind == FindingKind::cost;
}

// Counters to the last digit, measured values to six.
std::string formatValue(const std::optional<double>& value) {
  if (!value) return "undefined";
  return std::trunc(*value) == *value ? fmt::format("{}", *value) : formatSignificant(*value, 6);
}

std::string sentence(const Finding& finding) {
  switch (finding.kind) {
    case FindingKind::control:
      return fmt::format("the control did not pass: {}", finding.quantity);
    case FindingKind::missing:
      return fmt::format("{} is missing in this run", finding.quantity);
    case FindingKind::surplus:
      return fmt::format("{} is not in the baseline", finding.quantity);
    default:
      return fmt::format("{} was {}, is {}, may change by {}", finding.quantity, formatValue(finding.before),
                         formatValue(finding.after), formatSignificant(finding.limit));
  }
}

std::vector<std::string> tableRow(const Finding& finding) {
  if (!hasValues(finding)) return {nameOf(finding.kind), finding.quantity, "", "", "", finding.cell};
  return {nameOf(finding.kind),
          finding.quantity,
          formatValue(finding.before),
          formatValue(finding.after),
          formatSignificant(finding.limit),
          finding.cell};
}

std::string findingsTable(const GateReport& report) {
  Table table{
      {{"kind", Align::left}, {"what", Align::left}, {"before"}, {"after"}, {"may change by"}, {"cell", Align::left}},
      {}};
  const std::size_t shown = std::min(report.findings.size(), kMaxShownFindings);
  for (std::size_t i = 0; i < shown; ++i) table.rows.push_back(tableRow(report.findings[i]));
  std::string text = toMarkdown(table);
  if (shown < report.findings.size()) text += fmt::format("\n... and {} more.\n", report.findings.size() - shown);
  return text;
}

Json encodeOptional(const std::optional<double>& value) { return value ? encodeNumber(*value) : nullptr; }

Json findingToJson(const Finding& finding) {
  Json json;
  json["kind"] = nameOf(finding.kind);
  json["cell"] = finding.cell;
  json["quantity"] = finding.quantity;
  json["before"] = encodeOptional(finding.before);
  json["after"] = encodeOptional(finding.after);
  json["limit"] = encodeNumber(finding.limit);
  json["excess"] = encodeNumber(finding.excess);
  return json;
}

// XML 1.0 knows no control characters but tab and line breaks.
std::string xmlEscaped(const std::string& text) {
  static const std::map<char, std::string> kEntities = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\n', "&#10;"}};
  std::string result;
  for (const char c : text) {
    if (const auto entity = kEntities.find(c); entity != kEntities.end())
      result += entity->second;
    else
      result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result;
}

// The test case that a finding fails; cells have one each, costs share one.
std::string testCaseOf(const Finding& finding) {
  if (finding.kind == FindingKind::control) return kControlCase;
  return finding.quantity.starts_with("cost") ? kCostCase : finding.cell;
}

std::string testCase(const std::string& name, const std::string& outcome) {
  const std::string head = fmt::format("  <testcase classname=\"probebench\" name=\"{}\"", xmlEscaped(name));
  return outcome.empty() ? head + "/>\n" : fmt::format("{}>\n    {}\n  </testcase>\n", head, outcome);
}

std::string failureOf(const std::vector<std::string>& sentences) {
  return fmt::format("<failure message=\"{}\">{}</failure>", xmlEscaped(sentences[0]),
                     xmlEscaped(fmt::format("{}", fmt::join(sentences, "; "))));
}

std::string skipped(const std::string& why) { return fmt::format("<skipped message=\"{}\"/>", xmlEscaped(why)); }

// Drift is neither a pass nor a failure: what would have compared the counters did not run.
std::string driverOutcome(const GateReport& report) {
  return report.sameDriver ? "" : skipped(fmt::format("{}", fmt::join(report.notes, " ")));
}

}  // namespace

std::string printGateReport(const GateReport& report, const std::string& blessCommand) {
  std::string text = fmt::format("{}: {} cells, {} differences; {} metrics, {} counters and {} costs compared\n",
                                 nameOf(report.verdict), report.cells.size(), report.findings.size(),
                                 report.metricsCompared, report.countersCompared, report.costsCompared);
  if (!report.findings.empty()) text += '\n' + findingsTable(report);
  if (!report.notes.empty()) text += '\n';
  for (const std::string& note : report.notes) text += fmt::format("* {}\n", note);
  // Noise is never as it should be: `bless` refuses it.
  if (report.verdict == Verdict::fail || report.verdict == Verdict::drift)
    text += fmt::format("\nIf this is as it should be: {}\n", blessCommand);
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
  head["noisy_cells"] = report.noisyCells;
  head["notes"] = report.notes;
  std::vector<Json> rows;
  for (const Finding& finding : report.findings) rows.push_back(findingToJson(finding));
  return printDocument(head, "findings", rows);
}

std::string toJUnit(const GateReport& report, const std::string& suiteName) {
  std::map<std::string, std::vector<std::string>> failures;
  for (const Finding& finding : report.findings) failures[testCaseOf(finding)].push_back(sentence(finding));

  std::vector<std::string> names = {kControlCase, kCostCase};
  names.insert(names.end(), report.cells.begin(), report.cells.end());
  std::string cases = testCase("same GL driver as the baseline", driverOutcome(report));
  std::size_t failed = 0, skippedCases = report.sameDriver ? 0 : 1;
  for (const std::string& name : names) {
    const bool fails = failures.contains(name), noisy = !fails && report.noisyCells.contains(name);
    failed += fails ? 1 : 0;
    skippedCases += noisy ? 1 : 0;
    cases += testCase(name, fails ? failureOf(failures[name]) : noisy ? skipped(kNoisy) : "");
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\">\n{}</testsuite>\n",
      xmlEscaped(suiteName), names.size() + 1, failed, skippedCases, cases);
}

}  // namespace pb
