// The report of a run for people: error and cost tables in Markdown, each question its own table, and the
// circumstances.
#pragma once

#include <string>

#include "bench/results.h"

namespace pb {

// What was found in a few lines, then all tables. defaults: of the axes; those that stand there in the whole run need
// no words.
std::string makeReport(const Results& results, const AxisValues& defaults = {});

// Makes the directory if it is absent; an environment Error if that fails.
void makeReportFolder(const std::string& directory);

// Writes report.md and report.csv into the directory (made if absent).
void writeReport(const Results& results, const std::string& directory, const AxisValues& defaults = {});

}  // namespace pb
