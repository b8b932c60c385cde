// A sequence's errors and costs as they go on in time: the numbers behind the report's curves. Pure functions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/sections.h"

namespace pb {

// Over the measured frames that have a value. p95 is the smallest value that at least 95 % of them don't exceed, which
// is the worst of fewer than 20 frames.
struct FrameSummary {
  double mean = 0, p95 = 0, worst = 0;
  int worstFrame = 0;  // the first of several
  int frames = 0;
};
// nullopt if no frame has a value. Worst is the largest, of metrics for which higher is better the smallest; p95
// likewise.
std::optional<FrameSummary> summarizeErrors(const Sequence& sequence, Region region, const std::string& metric);
std::optional<FrameSummary> summarizeFlicker(const Sequence& sequence, Region region);

std::optional<double> flickerOf(const CellResult& cell, Region region);

// One measured frame: its error beside the age of the maps that it looked up.
struct StalePoint {
  int frame = 0;
  double meanAge = 0;  // frames since capture, over all faces that are captured
  std::int64_t largestAge = 0;
  double error = 0;
};
// Of the frames that have both, in their order.
std::vector<StalePoint> errorsByStaleness(const Sequence& sequence, Region region, const std::string& metric);

// Mean error of the frames of each age, by rising age: ages are rounded to whole frames.
struct StaleMean {
  std::int64_t age = 0;
  double error = 0;
  int frames = 0;
};
std::vector<StaleMean> meansByAge(const std::vector<StalePoint>& points);

}  // namespace pb
