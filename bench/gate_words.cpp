#include "bench/gate_words.h"

#include <fmt/format.h>

#include <cmath>

#include "bench/tables.h"

namespace pb {

const char* nameOf(GateVerdict verdict) {
  switch (verdict) {
    case GateVerdict::pass:
      return "pass";
    case GateVerdict::fail:
      return "fail";
    case GateVerdict::inconclusive:
      return "inconclusive";
    case GateVerdict::drift:
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

const char* nameOf(Level level) {
  switch (level) {
    case Level::fail:
      return "fail";
    case Level::drift:
      return "drift";
    case Level::unconfirmed:
      return "unconfirmed";
    case Level::warn:
      return "warn";
  }
  return "";
}

std::string formatGateValue(const std::optional<double>& value) {
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
      return fmt::format("{} was {}, is {}, may change by {}{}", finding.quantity, formatGateValue(finding.before),
                         formatGateValue(finding.after), formatSignificant(finding.limit),
                         finding.level == Level::warn ? " without a warning" : "");
  }
}

}  // namespace pb
