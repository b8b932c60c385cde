#include "reference/alias_table.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "tests/statistics.h"

namespace pb {
namespace {

// Weights over twelve orders of magnitude with zeros between them.
std::vector<double> makeUnevenWeights(std::size_t count) {
  std::mt19937 generator(1);
  std::vector<double> weights(count);
  for (double& w : weights) {
    const auto random = static_cast<unsigned>(generator());
    w = random % 5 == 0 ? 0.0 : std::pow(10.0, random % 13) / 1e6;
  }
  return weights;
}

TEST(AliasTable, ProbabilitiesAreTheWeightsShares) {
  const std::vector<double> weights = makeUnevenWeights(1000);
  const AliasTable table(weights);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  double total = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    total += table.probability(i);
    // Columns hold multiples of 2^-24 of a 1024th. What a heavy number gets is short of all columns' roundings.
    EXPECT_NEAR(table.probability(i), weights[i] / sum, 0x1p-24 + 1e-6 * weights[i] / sum) << i;
    EXPECT_EQ(table.probability(i) == 0.0, weights[i] == 0.0) << i;
  }
  EXPECT_NEAR(total, 1.0, 1e-6);  // sum of a thousand floats
}

// All 2^24 thresholds of every column would take long: every 2^12th, in the middle of its interval.
TEST(AliasTable, ChoosesWithTheProbabilitiesThatItTells) {
  const std::vector<double> weights = {0.0, 3.0, 1.0, 0.0, 0.25, 9.0, 1e-3};
  const AliasTable table(weights);
  std::vector<double> shares(weights.size(), 0.0);
  constexpr int kThresholds = 4096;
  for (int bin = 0; bin < 8; ++bin)
    for (int t = 0; t < kThresholds; ++t)
      ++shares[table.choose(static_cast<float>(bin) / 8.0f, (static_cast<float>(t) + 0.5f) / kThresholds).index];
  for (std::size_t i = 0; i < weights.size(); ++i)
    // A threshold between two grid points is found to half a step, in each of the columns that may point here.
    EXPECT_NEAR(shares[i] / (8.0 * kThresholds), table.probability(i), 0.5 / kThresholds) << i;
}

TEST(AliasTable, FrequenciesPassChiSquare) {
  const std::vector<double> weights = makeUnevenWeights(300);
  const AliasTable table(weights);
  std::mt19937 generator(2);
  const auto uniform = [&] { return static_cast<float>(generator() >> 8) * 0x1p-24f; };
  std::vector<double> observed(weights.size(), 0.0), expected(weights.size());
  constexpr int kCount = 1000000;
  for (int i = 0; i < kCount; ++i) {
    const float uBin = uniform();
    ++observed[table.choose(uBin, uniform()).index];
  }
  for (std::size_t i = 0; i < weights.size(); ++i) expected[i] = kCount * table.probability(i);
  EXPECT_LT(std::abs(test::chiSquareScore(observed, expected)), test::sidakScore(1));
}

// Given the choice, what is left of the threshold is uniform again.
TEST(AliasTable, RestOfTheThresholdIsUniform) {
  const AliasTable table({0.2, 3.0, 1.0, 0.25, 9.0});
  std::mt19937 generator(3);
  const auto uniform = [&] { return static_cast<float>(generator() >> 8) * 0x1p-24f; };
  std::vector<std::vector<double>> bins(5, std::vector<double>(16, 0.0));
  for (int i = 0; i < 500000; ++i) {
    const float uBin = uniform();
    const AliasTable::Choice choice = table.choose(uBin, uniform());
    ASSERT_GE(choice.u, 0.0f);
    ASSERT_LT(choice.u, 1.0f);
    ++bins[choice.index][static_cast<std::size_t>(16.0f * choice.u)];
  }
  for (const std::vector<double>& b : bins) {
    const std::vector<double> expected(16, std::accumulate(b.begin(), b.end(), 0.0) / 16.0);
    EXPECT_LT(std::abs(test::chiSquareScore(b, expected)), test::sidakScore(5));
  }
}

TEST(AliasTable, OfOneNumber_AlwaysChoosesIt) {
  const AliasTable table({42.0});
  EXPECT_EQ(table.probability(0), 1.0);
  EXPECT_EQ(table.choose(0.999f, 0.5f).index, 0u);
  EXPECT_EQ(table.choose(0.0f, 0.25f).u, 0.25f);
}

}  // namespace
}  // namespace pb
