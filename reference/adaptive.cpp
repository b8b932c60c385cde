#include "reference/adaptive.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace pb {
namespace {

// Noise is estimated from few batches a pixel, whose distribution has a long tail: the mean over this many pixels to
// each side keeps one that was lucky from getting too few samples.
constexpr int kSmoothingPx = 2;
// The estimate may be too low: what it says is enough is exceeded by as much as rarely to need another picture.
constexpr double kSafety = 1.15;

double weight(float reference) {
  const auto r = static_cast<double>(reference);
  return 1.0 / (r * r + 0.01);
}

// Squared deviation of the mean of the batches over r^2 + 0.01, mean over the channels. Batches of a half are strata of
// one sequence, so that this is too large by much the same factor everywhere.
Grid<double> batchNoise(const ReferenceImage& image, const Image& mean) {
  Grid<double> noise(mean.width(), mean.height(), 0.0);
  const auto count = static_cast<double>(image.batches.size());
  for (const Image& batch : image.batches)
    for (std::size_t i = 0; i < noise.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double d = static_cast<double>(batch[i][c]) - static_cast<double>(mean[i][c]);
        noise[i] += d * d * weight(mean[i][c]) / (3.0 * count * (count - 1.0));
      }
  return noise;
}

// relMSE of the noise floor by the halves, which are independent.
double floorOf(const ReferenceImage& image, const Image& mean) {
  const Image half = image.half(0);
  double sum = 0.0;
  for (std::size_t i = 0; i < mean.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double d = static_cast<double>(half[i][c]) - static_cast<double>(mean[i][c]);
      sum += d * d * weight(mean[i][c]);
    }
  return sum / (3.0 * static_cast<double>(mean.size()));
}

// Mean over the window as far as it is inside.
Grid<double> smoothed(const Grid<double>& values) {
  Grid<double> result(values.width(), values.height());
  for (int y = 0; y < values.height(); ++y)
    for (int x = 0; x < values.width(); ++x) {
      double sum = 0.0;
      int count = 0;
      for (int j = std::max(y - kSmoothingPx, 0); j <= std::min(y + kSmoothingPx, values.height() - 1); ++j)
        for (int i = std::max(x - kSmoothingPx, 0); i <= std::min(x + kSmoothingPx, values.width() - 1); ++i, ++count)
          sum += values(i, j);
      result(x, y) = sum / count;
    }
  return result;
}

// Noise of one sample per primary point, by pixel: it falls as 1 / n.
Grid<double> noiseOfOneSample(const ReferenceImage& pilot, const SampleMap& samples) {
  const Image mean = pilot.mean();
  Grid<double> noise = smoothed(batchNoise(pilot, mean));
  double sum = 0.0;
  for (const double v : noise) sum += v;
  const double scale = sum > 0.0 ? floorOf(pilot, mean) * static_cast<double>(noise.size()) / sum : 0.0;
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] *= scale * samples[i];
  return noise;
}

// `least` times the power of two nearest to `wanted` (by ratio), at most the limit.
int roundedSamples(double wanted, int least, int limit) {
  int samples = least;
  while (2 * samples <= limit && wanted > samples * std::sqrt(2.0)) samples *= 2;
  return samples;
}

SampleMap inProportion(double factor, const Grid<double>& noise, const SampleMap& least, int limit) {
  SampleMap samples(noise.width(), noise.height());
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = roundedSamples(factor * std::sqrt(noise[i]), least[i], limit);
  return samples;
}

double expectedNoise(const Grid<double>& noise, const SampleMap& samples) {
  double sum = 0.0;
  for (std::size_t i = 0; i < noise.size(); ++i) sum += noise[i] / samples[i];
  return sum / static_cast<double>(noise.size());
}

}  // namespace

SampleMap planSamples(const ReferenceImage& pilot, const SampleMap& pilotSamples, const AdaptiveGoal& goal) {
  assert(pilotSamples.size() == pilot.batches.front().size());
  const Grid<double> noise = noiseOfOneSample(pilot, pilotSamples);
  const auto planned = [&](double factor) { return inProportion(factor, noise, pilotSamples, goal.maxSpp); };
  const auto isEnough = [&](const SampleMap& samples) {
    return expectedNoise(noise, samples) * kSafety <= goal.maxNoise;
  };
  // Twice the pilot's number where that is the least noisy: at least some pixels get more.
  const double largest = std::sqrt(*std::ranges::max_element(noise));
  if (!(largest > 0.0)) return pilotSamples;
  double low = std::log(1.0 / largest), high = low + std::log(1e9);
  if (!isEnough(planned(std::exp(high)))) {
    SampleMap all = pilotSamples;
    for (int& n : all) n = roundedSamples(goal.maxSpp, n, goal.maxSpp);
    return all;
  }
  constexpr int kSteps = 24;  // to 1e-6 of the factor
  for (int i = 0; i < kSteps; ++i) {
    const double middle = 0.5 * (low + high);
    (isEnough(planned(std::exp(middle))) ? high : low) = middle;
  }
  SampleMap samples = planned(std::exp(high));
  if (samples != pilotSamples) return samples;
  // The estimate says that the pilot was enough, which its halves denied: twice the samples.
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (noise[i] > 0.0 && 2 * samples[i] <= goal.maxSpp) samples[i] *= 2;
  return samples;
}

}  // namespace pb
