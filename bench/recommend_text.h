// Words for choices: shared by `recommend`, the summary of a run and the report.
#pragma once

#include <string>

#include "bench/recommend.h"

namespace pb {

// "0.0472 +- 0.0002" of a loss, as the metric, see formatUncertainty().
std::string errorText(const std::string& metric, const Estimate& loss);

// "3.41x" with its interval "3.41x [3.38, 3.45]" if asked for; "no cost measured" without one.
std::string ratioText(const Candidate& candidate, bool withInterval = false);

// "flip_hdr on mirrors and glass, mean over the frames".
std::string questionText(const Selection& selection, const CandidateSet& set);

// "resolution 256 -> 512 buys 0.002 +- 0.001 for 1.9x the time".
std::string stepText(const Step& step);

// The two that say most: the largest gain that is beyond its interval, and the largest saving of time that costs
// nothing or, failing that, least.
const Step* bestStepUp(const std::vector<Step>& steps);
const Step* bestStepDown(const std::vector<Step>& steps);

}  // namespace pb
