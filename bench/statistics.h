// Statistics of repeated measurements: pure functions of numbers.
#pragma once

#include <cstddef>
#include <span>

namespace pb {

// Mean of the two middle values if their number is even. `values` must not be empty.
double median(std::span<const double> values);

// The smallest of the values that at least a share p of them doesn't exceed (nearest rank); the largest for p = 1.
// 0 < p <= 1; `values` must not be empty.
double quantile(std::span<const double> values, double p);

// The median with its 95 % confidence interval. From six values on it is free of assumptions about their distribution:
// of n independent values, the k-th smallest and the k-th largest enclose the true median with probability
// 1 - 2 P(Bin(n, 1/2) < k) (David and Nagaraja, Order Statistics, 2003, section 7.1); k is the largest for which that
// is at least 95 %. Of two to five, whose extremes do not reach that, it is Student's interval of the mean logarithm,
// which holds the median with 95 % if the logarithms are normal; these values must be positive. Of one value nothing is
// known: low = median = high.
struct MedianInterval {
  double median = 0, low = 0, high = 0;
};
MedianInterval medianInterval(std::span<const double> values);

// Two-sided 95 % quantile of Student's t. Beyond 15 degrees of freedom that of 15, which is on the safe side.
double studentT975(std::size_t degreesOfFreedom);

// P(|T| >= |t|) of Student's t.
double studentTProbability(double t, double degreesOfFreedom);

// Two-sided probability of means so far apart if both are the same: Welch's t test with Satterthwaite's degrees of
// freedom (Welch, Biometrika 34, 1947). At least two values a side; without any spread 1 or 0.
double welchProbability(std::span<const double> a, std::span<const double> b);

}  // namespace pb
