#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/metrics/checks.h"
#include "bench/metrics/metrics.h"

namespace pb {
namespace {

// Keeps the relative errors of black pixels finite: 1 % of white, the usual choice (relMSE) and our unit of SMAPE.
constexpr double kRelativeEpsilon = 0.01;

// Sums over the channels of some pixels.
struct Sums {
  double signedError = 0, squared = 0, absolute = 0, maxAbsolute = 0, relativeSquared = 0, symmetric = 0;
  std::size_t pixels = 0;

  void addChannel(double r, double t) {
    const double d = t - r;
    signedError += d;
    squared += d * d;
    absolute += std::abs(d);
    maxAbsolute = std::max(maxAbsolute, std::abs(d));
    relativeSquared += d * d / (r * r + kRelativeEpsilon);
    symmetric += std::abs(d) / (std::abs(r) + std::abs(t) + kRelativeEpsilon);
  }

  void addPixel(const glm::vec3& r, const glm::vec3& t) {
    for (int channel = 0; channel < 3; ++channel) addChannel(double{r[channel]}, double{t[channel]});
    ++pixels;
  }

  void add(const Sums& other) {
    signedError += other.signedError;
    squared += other.squared;
    absolute += other.absolute;
    maxAbsolute = std::max(maxAbsolute, other.maxAbsolute);
    relativeSquared += other.relativeSquared;
    symmetric += other.symmetric;
    pixels += other.pixels;
  }
};

Sums sumRow(const Image& reference, const Image& test, const Mask* mask, int y) {
  Sums sums;
  for (int x = 0; x < reference.width(); ++x) {
    if (!mask || (*mask)(x, y)) sums.addPixel(reference(x, y), test(x, y));
  }
  return sums;
}

// Rows in parallel, then added from top to bottom: the order does not depend on the threads.
Sums sumImage(const Image& reference, const Image& test, const Mask* mask) {
  std::vector<Sums> rows(static_cast<std::size_t>(reference.height()));
  tbb::parallel_for(0, reference.height(),
                    [&](int y) { rows[static_cast<std::size_t>(y)] = sumRow(reference, test, mask, y); });
  Sums total;
  for (const Sums& row : rows) total.add(row);
  return total;
}

}  // namespace

ErrorSums computeErrorSums(const Image& reference, const Image& test, const Mask* mask) {
  requireComparable(reference, test);
  if (mask) requireMaskSize(*mask, reference.width(), reference.height());
  const Sums sums = sumImage(reference, test, mask);
  if (sums.pixels == 0) throwEmptyMask(*mask);

  const double count = 3.0 * static_cast<double>(sums.pixels);
  ErrorSums result;
  result.bias = sums.signedError / count;
  result.mse = sums.squared / count;
  result.rmse = std::sqrt(result.mse);
  result.mae = sums.absolute / count;
  result.maxAbs = sums.maxAbsolute;
  result.psnr = -10.0 * std::log10(result.mse);  // +infinity for mse 0
  result.relmse = sums.relativeSquared / count;
  result.smape = sums.symmetric / count;
  return result;
}

}  // namespace pb
