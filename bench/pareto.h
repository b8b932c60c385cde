// Error against cost: which choices are worth their cost. Pure functions of numbers; smaller is better in both.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "bench/estimate.h"

namespace pb {

struct Tradeoff {
  Estimate error, cost;
};

// Whether the error of choice i is smaller than that of choice j for sure.
using ErrorOrder = std::function<bool(std::size_t i, std::size_t j)>;

// No worse in either value, and better in one of them by a difference that is sure: those that may be chance, or are
// not known, dominate nothing. hasSmallerError: a, for sure; without it errors have nothing in common that is known.
bool dominates(const Tradeoff& a, const Tradeoff& b, std::optional<bool> hasSmallerError = {});

// Indices of those that nothing dominates, by cost, then error, then index.
std::vector<std::size_t> paretoFront(std::span<const Tradeoff> choices, const ErrorOrder& hasSmallerError = {});

// The choice of the front farthest below the straight line from its cheapest to its most exact one, in log(cost) and
// log(error), each scaled to [0, 1]: where paying more stops to pay (Satopaa et al., "Finding a Kneedle in a Haystack",
// 2011). nullopt if there are less than three, or none lies below the line. Errors of 0 count as a thousandth of the
// smallest other.
std::optional<std::size_t> kneeOf(std::span<const Tradeoff> choices, std::span<const std::size_t> front);

}  // namespace pb
