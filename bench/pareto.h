// Error against cost: which choices are worth their cost. Pure functions of numbers; smaller is better in both.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "bench/estimate.h"

namespace pb {

struct Tradeoff {
  Estimate error, cost;
};

// No worse in either value, and better in one of them by more than both intervals: differences that may be chance
// dominate nothing.
bool dominates(const Tradeoff& a, const Tradeoff& b);

// Indices of those that nothing dominates, by cost, then error, then index.
std::vector<std::size_t> paretoFront(std::span<const Tradeoff> choices);

// The choice of the front farthest below the straight line from its cheapest to its most exact one, in log(cost) and
// log(error), each scaled to [0, 1]: where paying more stops to pay (Satopaa et al., "Finding a Kneedle in a Haystack",
// 2011). nullopt if there are less than three, or none lies below the line. Errors of 0 count as a thousandth of the
// smallest other.
std::optional<std::size_t> kneeOf(std::span<const Tradeoff> choices, std::span<const std::size_t> front);

}  // namespace pb
