// Of which of a plan's cells a suite wants to know where the error comes from.
#pragma once

#include <vector>

#include "bench/plan.h"
#include "bench/suite.h"

namespace pb {

// Throws an input Error if the suite asks for the attribution of cells of which it has none.
void requireAttributedCells(const Suite& suite, const std::vector<PlannedSequence>& sequences);

// Sets attributedFrames of the sequences; does nothing for a suite without attribution.
void chooseAttributedCells(const Suite& suite, std::vector<PlannedSequence>& sequences);

}  // namespace pb
