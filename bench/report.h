// The report of a run for people: error and cost tables in Markdown, each question its own table, and the
// circumstances.
#pragma once

#include <string>

#include "bench/results.h"

namespace pb {

std::string makeReport(const Results& results);

// Writes report.md and report.csv into the directory (made if absent).
void writeReport(const Results& results, const std::string& directory);

}  // namespace pb
