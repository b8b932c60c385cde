// A second measurement of costs, which the gate asks for before it believes that one has changed.
#pragma once

#include <string>
#include <vector>

#include "bench/progress.h"
#include "bench/results.h"
#include "bench/runner.h"

namespace pb {

struct CostPlace {
  const Suite& suite;
  const Scenes& scenes;
  RasterDevice& device;
};

// One cell a sequence, with nothing but its cost. `sequences`: by shortKey(); those that the suite doesn't have are
// left out.
std::vector<CellResult> remeasureCosts(const CostPlace& place, const std::vector<std::string>& sequences,
                                       const AxisValues& defaults, Progress& progress);

// An input Error if the run is of another suite than the one of this file or name.
void requireRunOf(const Results& run, const std::string& suite);

// The costs from a suite's file or name, for a run of it. An input Error if the run is of another suite or of scenes
// that have changed since.
Results remeasureRun(const Results& run, const std::string& suite, const std::vector<std::string>& sequences,
                     GlBackend backend, int threads);

}  // namespace pb
