#include "bench/significance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/statistics.h"

namespace pb {
namespace {

std::vector<double> logarithms(const std::vector<double>& values) {
  std::vector<double> logs(values.size());
  std::ranges::transform(values, logs.begin(), [](double value) { return std::log(value); });
  return logs;
}

}  // namespace

bool haveRepetitions(const std::vector<double>& a, const std::vector<double>& b) {
  return std::min(a.size(), b.size()) >= kFewestRepetitions;
}

double equalCostProbability(const std::vector<double>& before, const std::vector<double>& after) {
  if (!haveRepetitions(before, after)) return 1;
  return welchProbability(logarithms(before), logarithms(after));
}

std::vector<double> holmAdjusted(const std::vector<double>& probabilities) {
  std::vector<std::size_t> order(probabilities.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return probabilities[i]; });
  std::vector<double> adjusted(probabilities.size());
  double largest = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double scaled = static_cast<double>(order.size() - rank) * probabilities[order[rank]];
    largest = std::max(largest, std::min(1.0, scaled));
    adjusted[order[rank]] = largest;
  }
  return adjusted;
}

}  // namespace pb
