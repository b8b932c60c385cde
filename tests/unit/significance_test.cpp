#include "bench/significance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pb {
namespace {

// `count` ratios about `ratio` whose logarithms have the standard deviation `spread`.
std::vector<double> drawn(std::mt19937& random, int count, double ratio, double spread = 0.1) {
  std::normal_distribution<double> logarithm(std::log(ratio), spread);
  std::vector<double> ratios;
  for (int i = 0; i < count; ++i) ratios.push_back(std::exp(logarithm(random)));
  return ratios;
}

TEST(EqualCosts, EqualSamples_AreCertain) {
  const std::vector<double> sample = {2.9, 3.0, 3.1, 3.0, 3.05, 2.95};
  EXPECT_EQ(equalCostProbability(sample, sample), 1.0);
}

TEST(EqualCosts, OfFewerThanSixRepetitions_AreNotTold) {
  EXPECT_EQ(equalCostProbability({1, 1.1, 1, 1.1, 1}, {9, 9.1, 9, 9.1, 9, 9.1}), 1.0);
}

TEST(EqualCosts, Probability_IsSymmetricInBothSides) {
  const std::vector<double> a = {2.8, 3.0, 3.3, 3.0, 3.1, 2.9}, b = {3.2, 3.4, 3.1, 3.3, 3.0, 3.5};
  EXPECT_DOUBLE_EQ(equalCostProbability(a, b), equalCostProbability(b, a));
  const std::vector<double> inverse = {1 / 2.8, 1 / 3.0, 1 / 3.3, 1 / 3.0, 1 / 3.1, 1 / 2.9};
  EXPECT_LT(equalCostProbability(a, inverse), 1e-6);
}

struct Size {
  int count;
  double spread;  // of one side; the other has 0.1
};

// Equal costs shall be called different as often as the test says: at 5 % alone, and at 5 % over the 81 costs of a
// suite, which Holm's correction of the smallest asks for. Of n trials the count has the mean np and a standard
// deviation below sqrt(np): bounds are four of them off, rounded up.
TEST(EqualCosts, FalseAlarms_AreAsRareAsTheySay) {
  for (const Size size : {Size{6, 0.1}, Size{6, 0.3}, Size{8, 0.1}, Size{10, 0.2}}) {
    std::mt19937 random(1);
    constexpr int kTrials = 20'000;
    int alarms = 0, strongAlarms = 0;
    for (int i = 0; i < kTrials; ++i) {
      const double p =
          equalCostProbability(drawn(random, size.count, 3.0), drawn(random, size.count, 3.0, size.spread));
      alarms += p < 0.05 ? 1 : 0;
      strongAlarms += p < 0.05 / 81 ? 1 : 0;
    }
    EXPECT_NEAR(alarms, 1000, 130) << size.count << ' ' << size.spread;
    EXPECT_LE(strongAlarms, 27) << size.count << ' ' << size.spread;  // mean 12.3
  }
}

TEST(EqualCosts, ChangeByAHalf_IsSeenInEightRepetitions) {
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) EXPECT_LT(equalCostProbability(drawn(random, 8, 3.0), drawn(random, 8, 4.5)), 0.001);
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
