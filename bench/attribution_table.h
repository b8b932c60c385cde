// Attributions as tables of a report.
#pragma once

#include <string>
#include <vector>

#include "bench/attribution.h"
#include "bench/results.h"

namespace pb {

// Markdown: for each attribution the bars of its steps, over the mask where there is one, and those of the objects with
// the largest errors. Empty without attributions. `defaults`: of every axis; a technique is named by the others.
std::string attributionTables(const std::vector<Attribution>& attributions, const AxisValues& defaults);

}  // namespace pb
