// Statistics of repeated measurements: pure functions of numbers.
#pragma once

#include <span>

namespace pb {

// Mean of the two middle values if their number is even. `values` must not be empty.
double median(std::span<const double> values);

// The smallest of the values that at least a share p of them doesn't exceed (nearest rank); the largest for p = 1.
// 0 < p <= 1; `values` must not be empty.
double quantile(std::span<const double> values, double p);

// The median with a distribution-free confidence interval between two order statistics: of n independent values, the
// k-th smallest and the k-th largest enclose the true median with probability 1 - 2 P(Bin(n, 1/2) < k) (David and
// Nagaraja, Order Statistics, 2003, section 7.1). k is the largest for which that is at least `confidence`; if even
// the extremes (k = 1) do not reach it, they are taken and `coverage` says what they reach.
struct MedianInterval {
  double median = 0, low = 0, high = 0;
  double coverage = 0;  // probability that [low, high] holds the true median
};
MedianInterval medianInterval(std::span<const double> values, double confidence = 0.95);

}  // namespace pb
