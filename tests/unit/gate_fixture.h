// Small runs and baselines for the tests of the gate.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "bench/gate.h"
#include "tests/unit/sample_results.h"

namespace pb {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

inline Tolerance plain(double absolute, double relative) { return {Tolerance::Kind::plain, absolute, relative, {}}; }
inline Tolerance any(std::vector<Tolerance> children) { return {Tolerance::Kind::any, 0, 0, std::move(children)}; }
inline Tolerance all(std::vector<Tolerance> children) { return {Tolerance::Kind::all, 0, 0, std::move(children)}; }

// One cell whose relMSE is `relmse` (the only gated metric) and that takes `ratio` plain frames of 4 ms.
inline Results runWith(double relmse, double ratio = 3.0) {
  Results run;
  run.provenance = samples::makeProvenance();
  run.tolerance = {{"relmse", plain(1e-3, 0.1)}};
  CellResult cell = samples::makeCell("builtin:a", 0, "64", "static", 0.1);
  cell.maskMetrics.reset();
  cell.metrics.sums.relmse = relmse;
  cell.cost = samples::makeCost(ratio);
  run.cells = {cell};
  return run;
}

// `noise` is the relMSE of the reference's floor; the samples' max_noise is 1e-5.
inline Results withNoise(Results run, double noise) {
  for (CellResult& cell : run.cells) cell.floor = {{"mse", noise}, {"relmse", noise}};
  return run;
}

inline Baseline baselineOf(const Results& run) { return makeBaseline(run, "because", "2026-01-31T12:00:00Z"); }

inline GateVerdict verdictOf(const Results& before, const Results& after) {
  return check(after, baselineOf(before)).verdict;
}

}  // namespace pb
