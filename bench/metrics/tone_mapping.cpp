#include "bench/metrics/tone_mapping.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "scenes/error.h"
#include "scenes/luminance.h"

namespace pb::flip {
namespace {

// The level that the brightest and the median pixel reach at the first and the last exposure.
constexpr double kTargetLevel = 0.85;

// Beyond this many stops the gain 2^exposure nears the limits of floats.
constexpr double kMaxStops = 120;
constexpr int kMaxExposures = 1000;

std::vector<double> positiveLuminances(const Image& image) {
  std::vector<double> luminances;
  luminances.reserve(image.size());
  for (const glm::vec3& pixel : image) {
    const glm::dvec3 rgb(std::max(pixel.x, 0.0f), std::max(pixel.y, 0.0f), std::max(pixel.z, 0.0f));
    if (const double positive = luminance(rgb); positive > 0) luminances.push_back(positive);
  }
  return luminances;
}

double selectRank(std::vector<double>& values, std::size_t rank) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// The upper median of all `count` values, of which those not in `positive` are 0; where it would be 0, the upper median
// of the positive ones.
double positiveMedian(std::vector<double>& positive, std::size_t count) {
  const std::size_t zeros = count - positive.size();
  const std::size_t rank = count / 2;
  return selectRank(positive, rank >= zeros ? rank - zeros : positive.size() / 2);
}

double clampToLimits(double stops) { return std::clamp(stops, -kMaxStops, kMaxStops); }

ExposureRange automaticRange(const Image& reference, const FlipSettings& settings) {
  std::vector<double> luminances = positiveLuminances(reference);
  if (luminances.empty()) {
    const double only = settings.startExposure.value_or(settings.stopExposure.value_or(0.0));
    return {only, only, 0};
  }
  const double x = inverseToneCurve(toneCurve(settings.toneMapper), kTargetLevel);
  const double largest = *std::max_element(luminances.begin(), luminances.end());
  const double median = positiveMedian(luminances, reference.size());
  return {clampToLimits(std::log2(x / largest)), clampToLimits(std::log2(x / median)), 0};
}

void requireInLimits(const std::optional<double>& stops, std::string_view name) {
  if (!stops || std::abs(*stops) <= kMaxStops) return;
  throwInputError("the FLIP {} exposure must lie in [{}, {}] stops, got {}", name, -kMaxStops, kMaxStops, *stops);
}

}  // namespace

RationalCurve toneCurve(ToneMapper toneMapper) {
  switch (toneMapper) {
    case ToneMapper::aces:  // Narkowicz's fit, its input scaled by 0.6
      return {0.36 * 2.51, 0.6 * 0.03, 0.0, 0.36 * 2.43, 0.6 * 0.59, 0.14};
    case ToneMapper::hable:
      return {0.231683, 0.013791, 0.0, 0.18, 0.3, 0.018};
    case ToneMapper::reinhard:
      break;
  }
  return {0.0, 1.0, 0.0, 0.0, 1.0, 1.0};
}

double inverseToneCurve(const RationalCurve& curve, double level) {
  // Root of A x^2 + B x + C.
  const double a = curve.k0 - level * curve.k3;
  const double b = curve.k1 - level * curve.k4;
  const double c = curve.k2 - level * curve.k5;
  if (a == 0) return -c / b;
  const double half = b / (2 * a);
  return std::sqrt(half * half - c / a) - half;
}

ExposureRange chooseExposures(const Image& reference, const FlipSettings& settings) {
  requireInLimits(settings.startExposure, "start");
  requireInLimits(settings.stopExposure, "stop");
  if (settings.numExposures && (*settings.numExposures < 1 || *settings.numExposures > kMaxExposures)) {
    throwInputError("the FLIP number of exposures must lie in [1, {}], got {}", kMaxExposures, *settings.numExposures);
  }
  const bool allGiven = settings.startExposure && settings.stopExposure;
  ExposureRange range = allGiven ? ExposureRange{} : automaticRange(reference, settings);
  range.start = settings.startExposure.value_or(range.start);
  range.stop = settings.stopExposure.value_or(range.stop);
  if (range.start > range.stop) {
    throwInputError("the FLIP start exposure must not exceed the stop exposure, got {} and {}", range.start,
                    range.stop);
  }
  const int automaticCount = std::max(2, static_cast<int>(std::ceil(range.stop - range.start)));
  range.count = settings.numExposures.value_or(automaticCount);
  return range;
}

}  // namespace pb::flip
