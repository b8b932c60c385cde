// Verdicts of statistical tests.
#pragma once

#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pb::test {

// Pearson's chi-square of counts against their expectations (of the same sum), as a standard normal variable: Wilson
// and Hilferty, "The Distribution of Chi-Square" (1931). Bins that expect fewer than 20 are pooled; any count where
// none is expected gives infinity.
inline double chiSquareScore(const std::vector<double>& observed, const std::vector<double>& expected) {
  constexpr double kLeast = 20.0;
  double chiSquare = 0.0, pooledObserved = 0.0, pooledExpected = 0.0;
  int bins = 0;
  const auto add = [&](double o, double e) {
    chiSquare += (o - e) * (o - e) / e;
    ++bins;
  };
  for (std::size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] == 0.0 && observed[i] > 0.0) return INFINITY;
    if (expected[i] >= kLeast) {
      add(observed[i], expected[i]);
    } else {
      pooledObserved += observed[i];
      pooledExpected += expected[i];
    }
  }
  if (pooledExpected >= kLeast) add(pooledObserved, pooledExpected);
  assert(bins > 1);
  const double freedom = bins - 1, variance = 2.0 / (9.0 * freedom);
  return (std::cbrt(chiSquare / freedom) - (1.0 - variance)) / std::sqrt(variance);
}

// The size that a standard normal variable exceeds with such a probability that any of `tests` independent ones does so
// with 1 in 10000: two-sided, with the correction of Sidak, "Rectangular Confidence Regions for the Means of
// Multivariate Normal Distributions" (1967).
inline double sidakScore(int tests) {
  const double significance = -std::expm1(std::log1p(-1e-4) / tests);
  double low = 0.0, high = 10.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (std::erfc(middle / std::sqrt(2.0)) > significance ? low : high) = middle;
  }
  return low;
}

}  // namespace pb::test
