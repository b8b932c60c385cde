#include "bench/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace pb {
namespace {

std::vector<double> sorted(std::span<const double> values) {
  std::vector<double> result(values.begin(), values.end());
  std::ranges::sort(result);
  return result;
}

double medianOfSorted(const std::vector<double>& values) {
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

// P(Bin(n, 1/2) = k), through logarithms: 2^-n underflows for n > 1074.
double binomialHalf(std::size_t n, std::size_t k) {
  const double dn = static_cast<double>(n);
  const double dk = static_cast<double>(k);
  const double log2 = 0.69314718055994531;
  return std::exp(std::lgamma(dn + 1) - std::lgamma(dk + 1) - std::lgamma(dn - dk + 1) - dn * log2);
}

}  // namespace

double median(std::span<const double> values) {
  assert(!values.empty());
  return medianOfSorted(sorted(values));
}

double quantile(std::span<const double> values, double p) {
  assert(!values.empty() && p > 0 && p <= 1);
  const std::vector<double> ordered = sorted(values);
  // 0.95 * 20 is a little more than 19 in doubles: a rank within rounding of a whole number is that number.
  constexpr double kRounding = 1e-9;
  const double rank = std::ceil(p * static_cast<double>(ordered.size()) - kRounding);
  return ordered[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

MedianInterval medianInterval(std::span<const double> values, double confidence) {
  assert(!values.empty());
  const std::vector<double> ordered = sorted(values);
  const std::size_t n = ordered.size();
  std::size_t k = 1;
  double below = binomialHalf(n, 0);  // P(Bin < k)
  while (2 * (k + 1) <= n + 1 && 1 - 2 * (below + binomialHalf(n, k)) >= confidence) below += binomialHalf(n, k++);
  return {medianOfSorted(ordered), ordered[k - 1], ordered[n - k], std::max(0.0, 1 - 2 * below)};
}

}  // namespace pb
