// The gate's findings in words, shared by its outputs.
#pragma once

#include <optional>
#include <string>

#include "bench/gate.h"

namespace pb {

const char* nameOf(GateVerdict verdict);
const char* nameOf(FindingKind kind);
const char* nameOf(Level level);

// Counters to the last digit, measured values to six.
std::string formatGateValue(const std::optional<double>& value);

// Without its cell.
std::string sentence(const Finding& finding);

}  // namespace pb
