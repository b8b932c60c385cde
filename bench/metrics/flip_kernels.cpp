#include "bench/metrics/flip_kernels.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace pb::flip {
namespace {

using Half = std::vector<double>;  // samples at offsets 0, 1, ... radius of an even or odd kernel

constexpr double kPi = std::numbers::pi;

// Weights of less than this at the end of an even kernel are below the rounding of a float sum and dropped.
constexpr double kNegligibleWeight = 1e-8;

// A Gaussian of the contrast sensitivity function, a sqrt(pi / b) exp(-pi^2 r^2 / b), r in degrees.
struct CsfGaussian {
  double a, b;
};
constexpr CsfGaussian kCsfAchromatic{1, 0.0047}, kCsfRedGreen{1, 0.0053}, kCsfBlueYellow1{34.1, 0.04},
    kCsfBlueYellow2{13.5, 0.025};
constexpr double kWidestCsf = 0.04;

constexpr double kFeatureWidthDegrees = 0.082;

template <class Function>
Half sampleHalf(int radius, Function function) {
  Half samples;
  for (int i = 0; i <= radius; ++i) samples.push_back(function(static_cast<double>(i)));
  return samples;
}

double sumOfBothSides(const Half& half) { return 2.0 * std::accumulate(half.begin(), half.end(), 0.0) - half[0]; }

// The factor of the separable form: a two-dimensional Gaussian is the product of two of these.
Half sampleCsf(const CsfGaussian& gaussian, double ppd) {
  const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidestCsf / (2.0 * kPi * kPi)) * ppd));
  const double amplitude = std::sqrt(gaussian.a * std::sqrt(kPi / gaussian.b));
  return sampleHalf(radius, [&](double i) {
    const double degrees = i / ppd;
    return amplitude * std::exp(-kPi * kPi * degrees * degrees / gaussian.b);
  });
}

Kernel evenKernel(Half samples, double scale) {
  for (double& sample : samples) sample *= scale;
  while (samples.back() < kNegligibleWeight) samples.pop_back();
  samples[0] *= 0.5;
  return {Symmetry::even, 0, {samples.begin(), samples.end()}};
}

Kernel normalizedKernel(const Half& samples) { return evenKernel(samples, 1.0 / sumOfBothSides(samples)); }

// Positive samples are divided by their sum, negative ones by that of their absolute values, where each sum is over
// both sides of the whole kernel.
Kernel derivativeKernel(Symmetry symmetry, const Half& samples) {
  double positive = 0, negative = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double sides = i == 0 ? 1.0 : 2.0;
    (samples[i] > 0 ? positive : negative) += sides * std::abs(samples[i]);
  }
  // An odd kernel has each of its samples once with either sign.
  if (symmetry == Symmetry::odd) positive = negative = 0.5 * (positive + negative);
  Kernel kernel{symmetry, 1, {}};
  for (std::size_t i = 1; i < samples.size(); ++i) {
    kernel.weights.push_back(static_cast<float>(samples[i] / (samples[i] > 0 ? positive : negative)));
  }
  return kernel;
}

}  // namespace

Kernels makeKernels(double ppd) {
  Kernels result;
  auto& kernels = result.kernels;
  kernels[kAchromatic] = normalizedKernel(sampleCsf(kCsfAchromatic, ppd));
  kernels[kRedGreen] = normalizedKernel(sampleCsf(kCsfRedGreen, ppd));
  const Half blueYellow1 = sampleCsf(kCsfBlueYellow1, ppd), blueYellow2 = sampleCsf(kCsfBlueYellow2, ppd);
  const double norm = 1.0 / std::hypot(sumOfBothSides(blueYellow1), sumOfBothSides(blueYellow2));
  kernels[kBlueYellow1] = evenKernel(blueYellow1, norm);
  kernels[kBlueYellow2] = evenKernel(blueYellow2, norm);

  const double sigma = 0.5 * kFeatureWidthDegrees * ppd;
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  const auto gaussian = [&](double i) { return std::exp(-i * i / (2.0 * sigma * sigma)); };
  kernels[kSmooth] = normalizedKernel(sampleHalf(radius, gaussian));
  kernels[kEdge] = derivativeKernel(Symmetry::odd, sampleHalf(radius, [&](double i) { return -i * gaussian(i); }));
  kernels[kPoint] = derivativeKernel(
      Symmetry::curvature, sampleHalf(radius, [&](double i) { return (i * i / (sigma * sigma) - 1.0) * gaussian(i); }));
  for (const Kernel& kernel : kernels) result.radius = std::max(result.radius, kernel.radius());
  return result;
}

}  // namespace pb::flip
