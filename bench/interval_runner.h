// 95 % intervals of the errors of a run's cells, from the batches of their references (bench/jackknife.h).
#pragma once

#include <vector>

#include "bench/runner.h"

namespace pb {

// The metrics that get an interval.
inline constexpr const char* kIntervalMetrics[] = {"flip_hdr", "flip_ldr", "ssim", "mse", "relmse"};

// Sets `intervals`, `replicates` and their like of the cells whose pictures the run keeps (the last measured frame of
// every sequence, or all frames): scores each picture against the reference without each of its batches. A reference
// without noise costs nothing and gives intervals of no width.
void addIntervals(const RunContext& context, std::vector<CellResult>& cells);

// Scores the kept pictures anew, whole image and mask with floors and intervals, against the references that the suite
// asks for now; what else the cells hold stays.
void rescore(const RunContext& context, std::vector<CellResult>& cells);

}  // namespace pb
