#include "reference/alias_table.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>

namespace pb {
namespace {

constexpr std::uint32_t kFull = 1u << 24;

// A part of a column, as multiple of 2^-24. What has any weight keeps some of its own column.
std::uint32_t quantised(double share) {
  const auto rounded = static_cast<std::uint32_t>(std::lround(std::min(share, 1.0) * kFull));
  return share > 0.0 ? std::max(rounded, 1u) : 0u;
}

}  // namespace

AliasTable::AliasTable(const std::vector<double>& weights) {
  assert(!weights.empty() && weights.size() <= kMaxSize);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  assert(sum > 0.0 && std::isfinite(sum));
  bins_.resize(std::bit_ceil(weights.size()));
  std::vector<double> shares(bins_.size(), 0.0);  // in columns
  for (std::size_t i = 0; i < weights.size(); ++i) shares[i] = weights[i] / sum * static_cast<double>(bins_.size());

  std::vector<std::uint32_t> small, large;
  for (std::size_t i = 0; i < shares.size(); ++i)
    (shares[i] < 1.0 ? small : large).push_back(static_cast<std::uint32_t>(i));
  // Columns that rounding leaves over belong to something heavy, never to a weight of 0.
  const auto heaviest = static_cast<std::uint32_t>(std::ranges::max_element(weights) - weights.begin());
  while (!small.empty()) {
    const std::uint32_t s = small.back();
    small.pop_back();
    bins_[s] = {quantised(shares[s]), large.empty() ? heaviest : large.back()};
    if (large.empty()) continue;
    double& rest = shares[large.back()];
    rest -= 1.0 - shares[s];
    if (rest >= 1.0) continue;
    small.push_back(large.back());
    large.pop_back();
  }
  for (const std::uint32_t l : large) bins_[l] = {kFull, l};

  std::vector<std::uint64_t> counts(bins_.size(), 0);  // of the 2^24 bins_.size() equally probable outcomes
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    counts[i] += bins_[i].threshold;
    counts[bins_[i].alias] += kFull - bins_[i].threshold;
  }
  probabilities_.reserve(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i)
    probabilities_.push_back(
        static_cast<float>(static_cast<double>(counts[i]) / (static_cast<double>(bins_.size()) * kFull)));
}

AliasTable::Choice AliasTable::choose(float uBin, float uThreshold) const {
  const auto column = static_cast<std::uint32_t>(uBin * static_cast<float>(bins_.size()));
  const Bin bin = bins_[column];
  const float u = uThreshold * static_cast<float>(kFull);
  const auto threshold = static_cast<float>(bin.threshold);
  if (u < threshold) return {column, u / threshold};
  return {bin.alias, (u - threshold) / static_cast<float>(kFull - bin.threshold)};
}

}  // namespace pb
