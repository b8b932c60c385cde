#include "bench/significance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace pb {
namespace {

constexpr std::size_t kFewestRepetitions = 3;
// The smallest probability is 1 / (kResamples + 1): under Holm's correction 2,000 comparisons can still tell a change.
constexpr int kResamples = 39'999;
constexpr double kQuantile975 = 1.959963984540054;  // of the standard normal distribution

// SplitMix64 (Steele, Lea and Flood 2014): the standard's distributions differ between libraries.
class Random {
 public:
  std::size_t below(std::size_t count) {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return static_cast<std::size_t>((z ^ (z >> 31U)) % count);
  }

 private:
  std::uint64_t state_ = 1;
};

double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<double> logarithms(const std::vector<double>& values) {
  std::vector<double> logs(values.size());
  std::ranges::transform(values, logs.begin(), [](double value) { return std::log(value); });
  return logs;
}

// Deviations of resampled means from the mean. Blocks grow as n^(1/3), the rate that is best for a mean (Künsch 1989).
class BlockBootstrap {
 public:
  explicit BlockBootstrap(std::vector<double> values)
      : values_(std::move(values)),
        block_(static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(values_.size()))))) {
    const double mean = meanOf(values_);
    // A resample's variance is (n - 1) / n of what it stands for.
    const double n = static_cast<double>(values_.size());
    for (double& value : values_) value = (value - mean) * std::sqrt(n / (n - 1));
  }

  double draw(Random& random) const {
    double sum = 0;
    for (std::size_t taken = 0; taken < values_.size();) {
      const std::size_t start = random.below(values_.size());
      for (std::size_t i = 0; i < block_ && taken < values_.size(); ++i, ++taken)
        sum += values_[(start + i) % values_.size()];
    }
    return sum / static_cast<double>(values_.size());
  }

 private:
  std::vector<double> values_;
  std::size_t block_;
};

double fromRepetitions(const std::vector<double>& before, const std::vector<double>& after) {
  const double difference = std::abs(meanOf(after) - meanOf(before));
  const BlockBootstrap first(before), second(after);
  Random random;
  int asFar = 0;
  for (int i = 0; i < kResamples; ++i)
    if (std::abs(second.draw(random) - first.draw(random)) >= difference) ++asFar;
  return (1.0 + asFar) / (1.0 + kResamples);
}

double standardError(const RatioSample& sample) { return std::log(sample.high / sample.low) / (2 * kQuantile975); }

double fromIntervals(const RatioSample& before, const RatioSample& after) {
  const double difference = std::abs(std::log(after.median / before.median));
  const double error = std::hypot(standardError(before), standardError(after));
  if (!(error > 0)) return difference > 0 ? 0.0 : 1.0;
  return std::erfc(difference / error / std::sqrt(2.0));
}

}  // namespace

bool haveRepetitions(const RatioSample& a, const RatioSample& b) {
  return std::min(a.ratios.size(), b.ratios.size()) >= kFewestRepetitions;
}

double typicalRatio(const RatioSample& sample, bool byRepetitions) {
  if (!byRepetitions) return sample.median;
  std::vector<double> ordered = sample.ratios;
  std::ranges::sort(ordered);
  const std::size_t n = ordered.size();
  return n % 2 == 1 ? ordered[n / 2] : 0.5 * (ordered[n / 2 - 1] + ordered[n / 2]);
}

double equalCostProbability(const RatioSample& before, const RatioSample& after) {
  if (!haveRepetitions(before, after)) return fromIntervals(before, after);
  return fromRepetitions(logarithms(before.ratios), logarithms(after.ratios));
}

std::vector<double> holmAdjusted(const std::vector<double>& probabilities) {
  std::vector<std::size_t> order(probabilities.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return probabilities[i]; });
  std::vector<double> adjusted(probabilities.size());
  double largest = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double scaled = static_cast<double>(order.size() - rank) * probabilities[order[rank]];
    largest = std::max(largest, std::min(1.0, scaled));
    adjusted[order[rank]] = largest;
  }
  return adjusted;
}

}  // namespace pb
