#include "bench/metrics/error_sums.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "bench/metrics/checks.h"
#include "bench/metrics/vector_clones.h"

namespace pb {
namespace {

// Keeps the relative errors of black pixels finite: 1 % of white, the usual choice (relMSE) and our unit of SMAPE.
constexpr double kRelativeEpsilon = 0.01;

// The channels of 64 pixels are summed side by side, so that sums vectorise in one order on every machine.
constexpr std::size_t kLanePixels = 64, kLanes = 3 * kLanePixels;
constexpr std::size_t kTaskPixels = 256 * kLanePixels;

using Lanes = std::array<double, kLanes>;

struct LaneSums {
  Lanes signedError{}, squared{}, absolute{}, largest{}, relativeSquared{}, symmetric{};
};

struct Sums {
  double signedError = 0, squared = 0, absolute = 0, maxAbsolute = 0, relativeSquared = 0, symmetric = 0;
  std::size_t pixels = 0;

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

// Weights are 1 inside of the mask and 0 outside. Both quotients come from one division, the slowest operation here.
PB_VECTOR_CLONES void addErrors(const float* reference, const float* test, const float* weights, std::size_t count,
                                LaneSums& sums) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const double r = double{reference[i]}, t = double{test[i]}, weight = double{weights[i]};
    const double d = (t - r) * weight, size = std::fabs(d), square = d * d;
    const double squareScale = r * r + kRelativeEpsilon, scale = std::fabs(r) + std::fabs(t) + kRelativeEpsilon;
    const double inverse = 1.0 / (squareScale * scale);
    sums.signedError[i] += d;
    sums.squared[i] += square;
    sums.absolute[i] += size;
    sums.largest[i] = sums.largest[i] > size ? sums.largest[i] : size;
    sums.relativeSquared[i] += square * (scale * inverse);
    sums.symmetric[i] += size * (squareScale * inverse);
  }
}

PB_VECTOR_CLONES void addSquares(const float* reference, const float* test, const float* weights, std::size_t count,
                                 LaneSums& sums) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const double d = (double{test[i]} - double{reference[i]}) * double{weights[i]};
    sums.squared[i] += d * d;
  }
}

using AddErrors = decltype(&addErrors);

// Pairwise, which rounds less than one after the other.
double sumOf(Lanes lanes) {
  std::size_t count = kLanes;
  for (; count % 2 == 0; count /= 2) {
    for (std::size_t i = 0; i < count / 2; ++i) lanes[i] += lanes[count / 2 + i];
  }
  return std::accumulate(lanes.begin(), lanes.begin() + static_cast<std::ptrdiff_t>(count), 0.0);
}

Sums sumOfLanes(const LaneSums& lanes) {
  return {sumOf(lanes.signedError),
          sumOf(lanes.squared),
          sumOf(lanes.absolute),
          *std::max_element(lanes.largest.begin(), lanes.largest.end()),
          sumOf(lanes.relativeSquared),
          sumOf(lanes.symmetric),
          0};
}

// The weights of the channels of some pixels; how many of them are inside.
std::size_t readMask(const unsigned char* mask, std::size_t pixels, std::array<float, kLanes>& weights) {
  std::size_t inside = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const bool isInside = mask[i] != 0;
    std::fill_n(&weights[3 * i], 3, isInside ? 1.0f : 0.0f);
    inside += isInside ? 1 : 0;
  }
  return inside;
}

Sums sumPixels(const Image& reference, const Image& test, const Mask* mask, std::size_t first, std::size_t end,
               AddErrors addAll) {
  LaneSums lanes;
  std::array<float, kLanes> weights;
  weights.fill(1.0f);
  std::size_t inside = 0;
  for (std::size_t i = first; i < end; i += kLanePixels) {
    const std::size_t pixels = std::min(kLanePixels, end - i);
    const std::size_t pixelsInside = mask ? readMask(&(*mask)[i], pixels, weights) : pixels;
    if (pixelsInside > 0) addAll(&reference[i].x, &test[i].x, weights.data(), 3 * pixels, lanes);
    inside += pixelsInside;
  }
  Sums sums = sumOfLanes(lanes);
  sums.pixels = inside;
  return sums;
}

// Parts in parallel, then added from top to bottom: the order does not depend on the threads.
Sums sumImage(const Image& reference, const Image& test, const Mask* mask, AddErrors addAll) {
  std::vector<Sums> parts((reference.size() + kTaskPixels - 1) / kTaskPixels);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::size_t first = part * kTaskPixels, end = std::min(first + kTaskPixels, reference.size());
    parts[part] = sumPixels(reference, test, mask, first, end, addAll);
  });
  Sums total;
  for (const Sums& part : parts) total.add(part);
  if (total.pixels == 0) throwEmptyMask(*mask);
  return total;
}

double channelCount(const Sums& sums) { return 3.0 * static_cast<double>(sums.pixels); }

double psnrOfMse(double mse) { return -10.0 * std::log10(mse); }  // +infinity for mse 0

}  // namespace

ErrorSums errorSumsOf(const Image& reference, const Image& test, const Mask* mask) {
  const Sums sums = sumImage(reference, test, mask, addErrors);
  const double count = channelCount(sums);
  ErrorSums result;
  result.bias = sums.signedError / count;
  result.mse = sums.squared / count;
  result.rmse = std::sqrt(result.mse);
  result.mae = sums.absolute / count;
  result.maxAbs = sums.maxAbsolute;
  result.psnr = psnrOfMse(result.mse);
  result.relmse = sums.relativeSquared / count;
  result.smape = sums.symmetric / count;
  return result;
}

double psnrOf(const Image& reference, const Image& test, const Mask* mask) {
  const Sums sums = sumImage(reference, test, mask, addSquares);
  return psnrOfMse(sums.squared / channelCount(sums));
}

ErrorSums computeErrorSums(const Image& reference, const Image& test, const Mask* mask) {
  requireComparable(reference, test);
  if (mask) requireMaskSize(*mask, reference.width(), reference.height());
  return errorSumsOf(reference, test, mask);
}

}  // namespace pb
