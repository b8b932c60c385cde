// Under which circumstances two runs were made, as far as they differ.
#pragma once

#include <map>
#include <set>
#include <string>

#include "bench/results.h"

namespace pb {

// Of the techniques of a run.
using ValuesByAxis = std::map<std::string, std::set<std::string>>;
ValuesByAxis valuesByAxis(const Results& results);

// A sentence or a table, Markdown. Axes that stand at one value in a whole run count as circumstances.
std::string circumstancesText(const Results& before, const Results& after);

}  // namespace pb
