#include "bench/significance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pb {
namespace {

RatioSample sampleOf(std::vector<double> ratios) { return {0, 0, 0, std::move(ratios)}; }

// `count` ratios about `ratio` whose logarithms have a standard deviation of 0.1.
RatioSample drawn(std::mt19937& random, int count, double ratio) {
  std::normal_distribution<double> logarithm(std::log(ratio), 0.1);
  std::vector<double> ratios;
  for (int i = 0; i < count; ++i) ratios.push_back(std::exp(logarithm(random)));
  return sampleOf(std::move(ratios));
}

TEST(EqualCosts, EqualSamples_AreCertain) {
  const RatioSample sample = sampleOf({2.9, 3.0, 3.1, 3.0});
  EXPECT_EQ(equalCostProbability(sample, sample), 1.0);
}

TEST(EqualCosts, FarApart_ReachTheSmallestProbability) {
  EXPECT_EQ(equalCostProbability(sampleOf({2.9, 3.0, 3.1, 3.0}), sampleOf({5.9, 6.0, 6.1, 6.0})), 1.0 / 40'000);
}

TEST(EqualCosts, Probability_IsSymmetricInBothSides) {
  const RatioSample a = sampleOf({2.8, 3.0, 3.3, 3.0}), b = sampleOf({2.9, 3.2, 3.4, 3.1});
  EXPECT_NEAR(equalCostProbability(a, b), equalCostProbability(b, a), 0.02);  // 4 sd of 40,000 resamples are 0.01
}

// Equal costs shall be called different in 5 % of all cases. Of ten repetitions the bootstrap's tails are a little
// short: the bound catches one that is wrong by more than a factor of three either way.
TEST(EqualCosts, FalseAlarms_AreAboutAsRareAsTheySay) {
  std::mt19937 random(1);
  int alarms = 0;
  for (int i = 0; i < 200; ++i)
    if (equalCostProbability(drawn(random, 10, 3.0), drawn(random, 10, 3.0)) < 0.05) ++alarms;
  EXPECT_GT(alarms, 3);
  EXPECT_LT(alarms, 30);
}

TEST(EqualCosts, ChangeByAHalf_IsSeenInEightRepetitions) {
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) EXPECT_LT(equalCostProbability(drawn(random, 8, 3.0), drawn(random, 8, 4.5)), 0.001);
}

TEST(EqualCosts, WithoutRepetitions_AreThoseOfANormalDistribution) {
  const RatioSample a{3, 3 / 1.1, 3 * 1.1, {}}, b{4.5, 4.5 / 1.1, 4.5 * 1.1, {}};
  const double z = std::log(1.5) / (std::sqrt(2.0) * std::log(1.21) / (2 * 1.959963984540054));
  EXPECT_NEAR(equalCostProbability(a, b), std::erfc(z / std::sqrt(2.0)), 1e-15);
  EXPECT_EQ(equalCostProbability(a, a), 1.0);
}

TEST(EqualCosts, WithoutAnySpread_DifferOrNot) {
  EXPECT_EQ(equalCostProbability({3, 3, 3, {}}, {3, 3, 3, {}}), 1.0);
  EXPECT_EQ(equalCostProbability({3, 3, 3, {}}, {4, 4, 4, {}}), 0.0);
}

// Holm (1979): the smallest is multiplied by their number, the next by one less, and none is below the one before.
TEST(Holm, AdjustsInSteps) {
  const std::vector<double> adjusted = holmAdjusted({0.04, 0.01, 0.03, 0.005});
  ASSERT_EQ(adjusted.size(), 4u);
  EXPECT_NEAR(adjusted[3], 0.02, 1e-15);
  EXPECT_NEAR(adjusted[1], 0.03, 1e-15);
  EXPECT_NEAR(adjusted[2], 0.06, 1e-15);
  EXPECT_NEAR(adjusted[0], 0.06, 1e-15);
}

TEST(Holm, StaysWithinOne) {
  EXPECT_EQ(holmAdjusted({0.9, 0.8}), (std::vector<double>{1.0, 1.0}));
  EXPECT_TRUE(holmAdjusted({}).empty());
}

}  // namespace
}  // namespace pb
