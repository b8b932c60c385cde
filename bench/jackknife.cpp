#include "bench/jackknife.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <numeric>

#include "bench/statistics.h"

namespace pb {

Interval jackknifeInterval(double value, std::span<const double> replicates) {
  assert(replicates.size() >= 2);
  const double n = static_cast<double>(replicates.size());
  const double mean = std::accumulate(replicates.begin(), replicates.end(), 0.0) / n;
  double squares = 0;
  for (const double replicate : replicates) squares += (replicate - mean) * (replicate - mean);
  const double reach = studentT975(replicates.size() - 1) * std::sqrt((n - 1) / n * squares);
  const double unbiased = value - (n - 1) * (mean - value);
  return {std::min(value, unbiased) - reach, std::max(value, unbiased) + reach};
}

Interval jackknifeDifference(double a, std::span<const double> replicatesA, double b,
                             std::span<const double> replicatesB) {
  assert(replicatesA.size() == replicatesB.size());
  std::vector<double> differences(replicatesA.size());
  std::ranges::transform(replicatesA, replicatesB, differences.begin(), std::minus());
  return jackknifeInterval(a - b, differences);
}

Image leaveOneOut(const Image& mean, const Image& batch, std::size_t batches) {
  assert(batches >= 2 && mean.size() == batch.size());
  const double n = static_cast<double>(batches);
  Image rest(mean.width(), mean.height());
  for (std::size_t i = 0; i < mean.size(); ++i)
    for (int channel = 0; channel < 3; ++channel)
      rest[i][channel] = static_cast<float>(
          (n * static_cast<double>(mean[i][channel]) - static_cast<double>(batch[i][channel])) / (n - 1));
  return rest;
}

bool areEqual(const std::vector<Image>& batches) {
  return std::ranges::all_of(batches, [&](const Image& batch) {
    for (std::size_t i = 0; i < batch.size(); ++i)
      if (batch[i] != batches.front()[i]) return false;
    return true;
  });
}

}  // namespace pb
