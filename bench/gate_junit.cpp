// The gate's findings as JUnit XML.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "bench/gate.h"
#include "bench/gate_words.h"

namespace pb {
namespace {

// Test cases that stand for no cell.
constexpr char kControlCase[] = "control";
constexpr char kCostCase[] = "cost";
constexpr char kPlatformCase[] = "same platform as the baseline";

constexpr char kNoisy[] = "within tolerance, but the reference is noisier than max_noise";

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

// Cells have a test case each, costs share one.
std::string testCaseOf(const Finding& finding) {
  if (finding.kind == FindingKind::control) return kControlCase;
  return finding.quantity.starts_with("cost") ? kCostCase : finding.cell;
}

// What a test case came to, by level.
struct TestCase {
  std::map<Level, std::vector<std::string>> sentences;
  std::string skipped;  // why it says nothing, though nothing failed
};

std::string joined(const std::vector<std::string>& sentences) {
  return xmlEscaped(fmt::format("{}", fmt::join(sentences, "; ")));
}

std::string bodyOf(const TestCase& testCase) {
  const auto ofLevel = [&](Level level) {
    const auto found = testCase.sentences.find(level);
    return found == testCase.sentences.end() ? std::vector<std::string>() : found->second;
  };
  std::string body;
  if (const auto failures = ofLevel(Level::fail); !failures.empty())
    body += fmt::format("    <failure message=\"{}\">{}</failure>\n", xmlEscaped(failures[0]), joined(failures));
  else if (!testCase.skipped.empty())
    body += fmt::format("    <skipped message=\"{}\"/>\n", xmlEscaped(testCase.skipped));
  if (const auto warnings = ofLevel(Level::warn); !warnings.empty())
    body += fmt::format("    <system-out>{}</system-out>\n", joined(warnings));
  return body;
}

// Neither passes nor failures: they say why nothing can be said.
std::string reasonToSkip(const GateReport& report, const std::string& name, const TestCase& testCase) {
  for (const Level level : {Level::drift, Level::unconfirmed})
    if (const auto found = testCase.sentences.find(level); found != testCase.sentences.end())
      return fmt::format("{}: {}", nameOf(level), fmt::join(found->second, "; "));
  if (report.noisyCells.contains(name)) return kNoisy;
  if (name == kPlatformCase && !report.samePlatform) return fmt::format("{}", fmt::join(report.notes, " "));
  return "";
}

}  // namespace

std::string toJUnit(const GateReport& report, const std::string& suiteName) {
  std::map<std::string, TestCase> testCases;
  for (const Finding& finding : report.findings)
    testCases[testCaseOf(finding)].sentences[finding.level].push_back(sentence(finding));

  std::vector<std::string> names = {kPlatformCase, kControlCase, kCostCase};
  names.insert(names.end(), report.cells.begin(), report.cells.end());
  std::string text;
  std::size_t failed = 0, skipped = 0;
  for (const std::string& name : names) {
    TestCase& testCase = testCases[name];
    testCase.skipped = reasonToSkip(report, name, testCase);
    const bool fails = testCase.sentences.contains(Level::fail);
    failed += fails ? 1 : 0;
    skipped += !fails && !testCase.skipped.empty() ? 1 : 0;
    const std::string body = bodyOf(testCase);
    text += fmt::format("  <testcase classname=\"probebench\" name=\"{}\"{}", xmlEscaped(name),
                        body.empty() ? "/>\n" : ">\n" + body + "  </testcase>\n");
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\">\n{}</testsuite>\n",
      xmlEscaped(suiteName), names.size(), failed, skipped, text);
}

}  // namespace pb
