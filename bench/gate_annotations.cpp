// The gate's findings as workflow commands of GitHub Actions:
// https://docs.github.com/actions/reference/workflow-commands-for-github-actions
#include <fmt/format.h>

#include "bench/gate.h"
#include "bench/gate_words.h"

namespace pb {
namespace {

constexpr std::size_t kMaxShown = 10;  // of each kind and step GitHub shows no more

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '%')
      result += "%25";
    else if (c == '\r')
      result += "%0D";
    else if (c == '\n')
      result += "%0A";
    else
      result += c;
  }
  return result;
}

// Only what fails is an error.
std::string annotationsOf(const GateReport& report, bool errors) {
  std::string text;
  std::size_t count = 0;
  for (const Finding& finding : report.findings) {
    if ((finding.level == Level::fail) != errors) continue;
    if (++count > kMaxShown) continue;
    const std::string place = finding.cell.empty() ? "" : fmt::format(" ({})", finding.cell);
    text += fmt::format("::{} title=probebench {}::{}\n", errors ? "error" : "warning", nameOf(finding.level),
                        escaped(sentence(finding) + place));
  }
  return text;
}

}  // namespace

std::string toGitHubAnnotations(const GateReport& report) {
  std::string text = annotationsOf(report, true) + annotationsOf(report, false);
  for (const std::string& note : report.notes) text += fmt::format("::notice title=probebench::{}\n", escaped(note));
  return text;
}

}  // namespace pb
