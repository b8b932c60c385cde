#include "bench/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

namespace pb {
namespace {

TEST(Median, OfOddCount_IsTheMiddleValue) { EXPECT_EQ(median(std::vector{3.0, 1.0, 2.0}), 2.0); }

TEST(Median, OfEvenCount_IsTheMeanOfTheTwoMiddleValues) { EXPECT_EQ(median(std::vector{9.0, 1.0, 2.0, 4.0}), 3.0); }

TEST(MedianInterval, OfOneValue_HasNoWidth) {
  const MedianInterval interval = medianInterval(std::vector{5.0});
  EXPECT_EQ(interval.low, 5.0);
  EXPECT_EQ(interval.high, 5.0);
}

struct Case {
  int n, low, high;  // of the values 1..n
};

// k by hand: n = 6: k = 1 gives 1 - 2/64. n = 8: k = 1 gives 1 - 2/256, k = 2 1 - 18/256 < 95 %. n = 9: k = 2 gives
// 1 - 20/512. n = 10: k = 2 gives 1 - 22/1024, k = 3 1 - 112/1024 < 95 %.
TEST(MedianInterval, OfSmallCounts_MatchesTheBinomialByHand) {
  for (const Case c : {Case{6, 1, 6}, Case{8, 1, 8}, Case{9, 2, 8}, Case{10, 2, 9}}) {
    std::vector<double> values(static_cast<std::size_t>(c.n));
    std::iota(values.rbegin(), values.rend(), 1.0);
    const MedianInterval interval = medianInterval(values);
    EXPECT_EQ(interval.low, c.low) << c.n;
    EXPECT_EQ(interval.high, c.high) << c.n;
  }
}

// 4000 log-normal samples of n values: the share has a standard deviation of sqrt(0.95 * 0.05 / 4000) = 0.0034, of
// which four are allowed below 95 %. Extremes alone would reach 50, 75, 87.5 and 93.75 % for n = 2 to 5.
TEST(MedianInterval, HoldsTheMedianAsOftenAsItSays) {
  for (int n = 2; n <= 12; ++n) {
    std::mt19937 random(1);
    std::lognormal_distribution<double> distribution(0.5, 0.3);
    int held = 0;
    for (int i = 0; i < 4000; ++i) {
      std::vector<double> values(static_cast<std::size_t>(n));
      for (double& value : values) value = distribution(random);
      const MedianInterval interval = medianInterval(values);
      EXPECT_LE(interval.low, interval.median);
      EXPECT_GE(interval.high, interval.median);
      held += interval.low <= std::exp(0.5) && std::exp(0.5) <= interval.high ? 1 : 0;
    }
    EXPECT_GE(held / 4000.0, 0.95 - 0.0136) << n;
  }
}

// One degree: 1 - 2/pi atan t. Two: 1 - t / sqrt(2 + t^2). Many: those of the normal distribution; the terms of order
// 1 / degrees are below 1e-6 here.
TEST(StudentT, HasTheProbabilitiesThatAreKnownInClosedForm) {
  for (const double t : {0.01, 0.5, 1.0, 3.0, 40.0}) {
    EXPECT_NEAR(studentTProbability(t, 1), 1 - 2 / std::numbers::pi * std::atan(t), 1e-13) << t;
    EXPECT_NEAR(studentTProbability(-t, 2), 1 - t / std::sqrt(2 + t * t), 1e-13) << t;
    EXPECT_NEAR(studentTProbability(t, 1e6), std::erfc(t / std::sqrt(2.0)), 1e-6) << t;
  }
  EXPECT_EQ(studentTProbability(0, 7), 1.0);
}

TEST(StudentT, QuantilesLeaveFivePercent) {
  for (std::size_t degrees = 1; degrees <= 15; ++degrees)  // of three digits after the point
    EXPECT_NEAR(studentTProbability(studentT975(degrees), static_cast<double>(degrees)), 0.05, 1e-4) << degrees;
  EXPECT_EQ(studentT975(99), studentT975(15));
}

// By hand: means 2 and 5, squared errors 1/3 and 4/3, t = 3 / sqrt(5/3) = 2.3238, degrees
// (25/9) / ((1/9 + 16/9) / 2) = 50/17.
TEST(Welch, MatchesTheFormulaByHand) {
  const std::vector<double> a = {1, 2, 3}, b = {3, 5, 7};
  EXPECT_NEAR(welchProbability(a, b), studentTProbability(3 / std::sqrt(5.0 / 3), 50.0 / 17), 1e-14);
}

TEST(Welch, WithoutAnySpread_DifferOrNot) {
  const std::vector<double> three = {3, 3}, four = {4, 4};
  EXPECT_EQ(welchProbability(three, three), 1.0);
  EXPECT_EQ(welchProbability(three, four), 0.0);
}

TEST(MedianInterval, OfManyValues_DoesNotUnderflow) {
  std::vector<double> values(4001);
  std::iota(values.begin(), values.end(), 0.0);
  const MedianInterval interval = medianInterval(values);
  // The normal approximation puts the ends at n/2 -+ 1.96 sqrt(n)/2 = 2000 -+ 62.
  EXPECT_NEAR(interval.low, 2000 - 62, 2);
  EXPECT_NEAR(interval.high, 2000 + 62, 2);
}

}  // namespace
}  // namespace pb
