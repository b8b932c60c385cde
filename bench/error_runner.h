// The errors of a plan's cells: references, then rasterising on the calling thread with the metrics of earlier cells
// beside it. Sequences with equal captures are rendered together, equal pictures of a frame are scored once. What the
// run keeps rendered (bench/kept_pictures.h) is taken from there.
#pragma once

#include "bench/cell_finisher.h"
#include "bench/runner.h"

namespace pb {

// Measures what is not finished and adds it to `finished` and to the run's journal. skipped: external techniques that
// are not asked. Returns these and those that were skipped here.
SkippedExternals measureErrors(const RunContext& context, FinishedCells& finished, const SkippedExternals& skipped);

}  // namespace pb
