// Renders and scores the chains of images of a suite's attributions (docs/attribution.md).
#pragma once

#include <vector>

#include "bench/attribution.h"
#include "bench/runner.h"

namespace pb {

// Throws the input Errors with which images of the suite's attributions would be refused, before anything is rendered.
void checkAttribution(const Suite& suite, const Scenes& scenes, const Plan& plan, RasterDevice& device);

// Of those of the plan's cells that the suite asks it for, in their order; nothing if it doesn't. Finished ones are
// kept in the run's folder, and taken from there where they are. Cells without cube maps (external techniques, lookup
// single-view) have none, which is said. Throws Error(Failure::interrupted) at the next image after an interrupt.
std::vector<Attribution> attribute(const RunContext& context, const std::vector<CellResult>& cells);

}  // namespace pb
