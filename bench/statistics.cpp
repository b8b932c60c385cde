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

// Two-sided 95 % quantiles of Student's t with 1 to 15 degrees of freedom (any table).
constexpr double kStudentT975[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                                   2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131};

// From so many values on the extremes hold the median with at least 95 %: 1 - 2 / 2^6.
constexpr std::size_t kFewestOfOrderInterval = 6;

struct Moments {
  double mean = 0;
  double squaredError = 0;  // of the mean: the variance over the count
};

Moments momentsOf(std::span<const double> values) {
  const double n = static_cast<double>(values.size());
  Moments moments;
  for (const double value : values) moments.mean += value / n;
  for (const double value : values)
    moments.squaredError += (value - moments.mean) * (value - moments.mean) / (n * (n - 1));
  return moments;
}

// Where the logarithms are normal, their mean is the logarithm of the median.
MedianInterval intervalOfFew(const std::vector<double>& ordered) {
  const double middle = medianOfSorted(ordered);
  if (ordered.size() < 2) return {middle, middle, middle};
  assert(ordered.front() > 0);
  std::vector<double> logs(ordered.size());
  std::ranges::transform(ordered, logs.begin(), [](double value) { return std::log(value); });
  const Moments moments = momentsOf(logs);
  const double reach = studentT975(logs.size() - 1) * std::sqrt(moments.squaredError);
  return {middle, std::min(middle, std::exp(moments.mean - reach)), std::max(middle, std::exp(moments.mean + reach))};
}

// The regularised incomplete beta function I_x(a, b) by its continued fraction (DLMF 8.17.22), from the front by
// Lentz's method as Thompson and Barnett (1986) changed it.
double lowerBeta(double x, double a, double b) {
  constexpr double kTiny = 1e-300;
  constexpr int kMostTerms = 1000;
  const auto awayFromZero = [](double value) { return std::abs(value) < kTiny ? kTiny : value; };
  double fraction = 1, c = 1, d = 0;
  for (int i = 1; i <= kMostTerms; ++i) {
    const double m = i / 2;
    const double term = i % 2 == 1 ? -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
                                   : m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / awayFromZero(1 + term * d);
    c = awayFromZero(1 + term / c);
    fraction *= c * d;
    if (std::abs(c * d - 1) < 1e-15) break;
  }
  const double logFront = std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x);
  return std::exp(logFront) / (a * fraction);
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

MedianInterval medianInterval(std::span<const double> values) {
  assert(!values.empty());
  const std::vector<double> ordered = sorted(values);
  if (ordered.size() < kFewestOfOrderInterval) return intervalOfFew(ordered);
  const std::size_t n = ordered.size();
  std::size_t k = 1;
  double below = binomialHalf(n, 0);  // P(Bin < k)
  while (2 * (k + 1) <= n + 1 && 1 - 2 * (below + binomialHalf(n, k)) >= 0.95) below += binomialHalf(n, k++);
  return {medianOfSorted(ordered), ordered[k - 1], ordered[n - k]};
}

double studentT975(std::size_t degreesOfFreedom) {
  return kStudentT975[std::clamp<std::size_t>(degreesOfFreedom, 1, std::size(kStudentT975)) - 1];
}

double studentTProbability(double t, double degreesOfFreedom) {
  assert(degreesOfFreedom > 0);
  const double a = 0.5 * degreesOfFreedom, b = 0.5, x = degreesOfFreedom / (degreesOfFreedom + t * t);
  if (x >= 1) return 1;
  // The fraction converges fast below the mean of the beta distribution: beyond, that of the other tail.
  if (x < (a + 1) / (a + b + 2)) return lowerBeta(x, a, b);
  return 1 - lowerBeta(t * t / (degreesOfFreedom + t * t), b, a);
}

double welchProbability(std::span<const double> a, std::span<const double> b) {
  assert(a.size() >= 2 && b.size() >= 2);
  const Moments first = momentsOf(a), second = momentsOf(b);
  const double u = first.squaredError, v = second.squaredError, difference = first.mean - second.mean;
  if (!(u + v > 0)) return difference == 0 ? 1 : 0;
  const double degrees =
      (u + v) * (u + v) / (u * u / static_cast<double>(a.size() - 1) + v * v / static_cast<double>(b.size() - 1));
  return studentTProbability(difference / std::sqrt(u + v), degrees);
}

}  // namespace pb
