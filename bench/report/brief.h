// A run in a few lines of Markdown: for a pull request or the end of a terminal session.
#pragma once

#include <string>
#include <vector>

#include "bench/results.h"

namespace pb {

// `answer` first, then one line a scene: the technique of smallest error and the cheapest one.
std::string makeBrief(const Results& results, const std::vector<std::string>& answer);

}  // namespace pb
