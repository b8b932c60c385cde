// Verdicts as the reports give them: only where the noise of both errors is known.
#pragma once

#include <optional>
#include <string>

#include "bench/results.h"
#include "bench/sections.h"
#include "bench/verdict.h"

namespace pb {

// Whether the reference's noise leaves nothing to ask about the value: its interval is known, or there is no noise, so
// that every value is exact.
bool isNoiseKnown(const CellResult& cell, Region region, const std::string& metric);

// verdictOf() of a, seen from b; equal where the values are the same; nullopt where the noise of one is not known or
// the metric is undefined.
std::optional<Verdict> knownVerdict(const CellResult& a, const CellResult& b, const std::string& metric, Region region);

}  // namespace pb
