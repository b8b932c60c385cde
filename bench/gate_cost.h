// The part of the gate that compares costs, which chance takes part in.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/gate.h"

namespace pb {

// A cost counts as changed when all hold: chance alone gives such a change with less than this probability, corrected
// for all costs that are compared; it is larger than 25 % either way, also if this machine's plain frame took 0.2 ms
// more or less; and a second measurement says the same.
inline constexpr double kCostSignificance = 0.05;
inline constexpr double kCostRelativeFloor = 0.25;
inline constexpr double kPlainFrameErrorMs = 0.2;

struct CostFindings {
  std::vector<Finding> findings;  // levels `fail` and `unconfirmed`
  std::vector<std::string> notes;
  std::size_t compared = 0;
};

// Throws an input Error for a rerun by another program or of another suite.
CostFindings compareCosts(const Results& run, const Baseline& baseline, const AxisValues& defaults,
                          const Results* rerun);

}  // namespace pb
