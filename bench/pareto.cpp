#include "bench/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace pb {

bool dominates(const Tradeoff& a, const Tradeoff& b, std::optional<bool> hasSmallerError) {
  const bool noWorse = a.error.value <= b.error.value && a.cost.value <= b.cost.value;
  return noWorse && (hasSmallerError.value_or(unpairedDifference(a.error, b.error).isNegative()) ||
                     unpairedDifference(a.cost, b.cost).isNegative());
}

std::vector<std::size_t> paretoFront(std::span<const Tradeoff> choices, const ErrorOrder& hasSmallerError) {
  const auto isDominatedBy = [&](std::size_t i, std::size_t other) {
    return dominates(choices[other], choices[i],
                     hasSmallerError ? std::optional(hasSmallerError(other, i)) : std::nullopt);
  };
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    bool isDominated = false;
    for (std::size_t other = 0; other < choices.size() && !isDominated; ++other) isDominated = isDominatedBy(i, other);
    if (!isDominated) front.push_back(i);
  }
  std::ranges::sort(front, {},
                    [&](std::size_t i) { return std::tuple(choices[i].cost.value, choices[i].error.value, i); });
  return front;
}

std::optional<std::size_t> kneeOf(std::span<const Tradeoff> choices, std::span<const std::size_t> front) {
  if (front.size() < 3) return std::nullopt;
  double smallest = std::numeric_limits<double>::infinity();
  for (const std::size_t i : front)
    if (choices[i].error.value > 0) smallest = std::min(smallest, choices[i].error.value);
  const auto logCost = [&](std::size_t i) { return std::log(choices[i].cost.value); };
  const auto logError = [&](std::size_t i) { return std::log(std::max(choices[i].error.value, 1e-3 * smallest)); };
  const std::size_t cheapest = front.front();
  const std::size_t best = *std::ranges::min_element(front, {}, logError);
  const double width = logCost(best) - logCost(cheapest);
  const double height = logError(cheapest) - logError(best);
  if (!(width > 0) || !(height > 0) || !std::isfinite(width * height)) return std::nullopt;
  std::optional<std::size_t> knee;
  double farthest = 0;
  for (const std::size_t i : front) {
    // The line goes from (0, 1) to (1, 0).
    const double x = (logCost(i) - logCost(cheapest)) / width;
    const double y = (logError(i) - logError(best)) / height;
    if (const double below = 1 - x - y; below > farthest) {
      farthest = below;
      knee = i;
    }
  }
  return knee;
}

}  // namespace pb
