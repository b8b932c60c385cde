#include "bench/jackknife.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace pb {
namespace {

// Of a mean the jackknife is the classical interval: replicates are (n m - x_b) / (n - 1), without bias, and
// (n - 1)/n sum (F_b - m)^2 = s^2 / n.
TEST(Jackknife, OfAMean_IsTheClassicalInterval) {
  const std::vector<double> x = {1, 2, 4, 9};
  const double mean = 4, variance = (9 + 4 + 0 + 25) / 3.0;
  std::vector<double> replicates;
  for (const double value : x) replicates.push_back((4 * mean - value) / 3);
  const Interval interval = jackknifeInterval(mean, replicates);
  EXPECT_NEAR(interval.high - mean, 3.182 * std::sqrt(variance / 4), 1e-9);
  EXPECT_NEAR(mean - interval.low, interval.high - mean, 1e-9);
}

// F = m^2 overestimates mu^2 by sigma^2 / n; the jackknife's bias is s^2 / n exactly.
TEST(Jackknife, OfASquare_AllowsForItsBias) {
  const std::vector<double> x = {-1, 1, -1, 1};  // mean 0, s^2 = 4/3
  std::vector<double> replicates;
  for (const double value : x) replicates.push_back(value * value / 9);
  const Interval interval = jackknifeInterval(0, replicates);
  EXPECT_NEAR(interval.low, -4.0 / 3 / 4, 1e-12);  // all replicates are 1/9: no spread
  EXPECT_NEAR(interval.high, 0, 1e-12);
}

TEST(Jackknife, WithoutNoise_IsThePoint) {
  const std::vector<double> replicates(16, 0.25);
  const Interval interval = jackknifeInterval(0.25, replicates);
  EXPECT_EQ(interval.low, 0.25);
  EXPECT_EQ(interval.high, 0.25);
}

// Of 1000 sets of 16 normal batches, 95 % hold the truth; three standard deviations of that count are 0.021.
TEST(Jackknife, HoldsTheTruthInNinetyFivePercent) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal(3.0, 1.0);
  int held = 0;
  constexpr int kSets = 1000, kBatches = 16;
  for (int set = 0; set < kSets; ++set) {
    std::vector<double> x(kBatches), replicates(kBatches);
    double mean = 0;
    for (double& value : x) mean += (value = normal(generator)) / kBatches;
    for (int b = 0; b < kBatches; ++b)
      replicates[static_cast<std::size_t>(b)] = (kBatches * mean - x[static_cast<std::size_t>(b)]) / (kBatches - 1);
    const Interval interval = jackknifeInterval(mean, replicates);
    held += interval.low <= 3.0 && 3.0 <= interval.high;
  }
  EXPECT_NEAR(held / static_cast<double>(kSets), 0.95, 0.021);
}

// Errors that go up and down together: correlation 0.99, as those of two techniques against one reference. Of 2000 sets
// 95 % hold the true difference, within three standard deviations of that count, 3 sqrt(0.95 * 0.05 / 2000) = 0.0146.
// Two intervals of the single errors hardly ever part: they are 2 sqrt(2) / sqrt(2 (1 - 0.99)) = 20 times as wide.
TEST(JackknifeDifference, HoldsTheTruthInNinetyFivePercentAndIsNarrow) {
  constexpr double kCorrelation = 0.99, kMeanA = 3.1, kMeanB = 3.0;
  std::mt19937 generator(11);
  std::normal_distribution<double> normal;
  constexpr int kSets = 2000;
  constexpr std::size_t kBatches = 16;
  int held = 0, decided = 0, parted = 0;
  for (int set = 0; set < kSets; ++set) {
    std::vector<double> x(kBatches), y(kBatches), withoutX(kBatches), withoutY(kBatches);
    for (std::size_t b = 0; b < kBatches; ++b) {
      const double common = normal(generator);
      x[b] = kMeanA + common;
      y[b] = kMeanB + kCorrelation * common + std::sqrt(1 - kCorrelation * kCorrelation) * normal(generator);
    }
    const double meanX = std::accumulate(x.begin(), x.end(), 0.0) / kBatches;
    const double meanY = std::accumulate(y.begin(), y.end(), 0.0) / kBatches;
    for (std::size_t b = 0; b < kBatches; ++b) {
      withoutX[b] = (kBatches * meanX - x[b]) / (kBatches - 1);
      withoutY[b] = (kBatches * meanY - y[b]) / (kBatches - 1);
    }
    const Interval difference = jackknifeDifference(meanX, withoutX, meanY, withoutY);
    held += difference.low <= kMeanA - kMeanB && kMeanA - kMeanB <= difference.high;
    decided += difference.low > 0;
    parted += jackknifeInterval(meanX, withoutX).low > jackknifeInterval(meanY, withoutY).high;
  }
  EXPECT_NEAR(held / static_cast<double>(kSets), 0.95, 0.0146);
  EXPECT_GT(decided, kSets / 2);
  EXPECT_LT(parted, kSets / 100);
}

// MSE: noise adds sigma^2 / n to both. F_a = (m + 1)^2 and F_b = m^2 differ by 2 m + 1, which has no bias at all.
TEST(JackknifeDifference, LeavesOutTheBiasThatBothShare) {
  const std::vector<double> x = {-1, 1, -1, 1};  // mean 0
  std::vector<double> a, b;
  for (const double value : x) {
    a.push_back((1 - value / 3) * (1 - value / 3));
    b.push_back(value * value / 9);
  }
  const Interval difference = jackknifeDifference(1, a, 0, b);
  EXPECT_NEAR(difference.high - 1, 1 - difference.low, 1e-12);
  const Interval alone = jackknifeInterval(1, a);
  EXPECT_GT(1 - alone.low, alone.high - 1);
}

TEST(JackknifeDifference, OfTheSame_IsNothing) {
  const std::vector<double> replicates = {0.1, 0.3, 0.2, 0.25};
  EXPECT_EQ(jackknifeDifference(0.2, replicates, 0.2, replicates), (Interval{0, 0}));
}

Image uniform(float value) {
  Image image(2, 1);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = glm::vec3(value);
  return image;
}

TEST(LeaveOneOut, IsTheMeanOfTheOthers) {
  EXPECT_EQ(leaveOneOut(uniform(2), uniform(4), 3)[0], glm::vec3(1.0f));  // (3 * 2 - 4) / 2
}

TEST(Batches, AreEqualOnlyWhereAllPixelsAre) {
  std::vector<Image> batches(3, uniform(1));
  EXPECT_TRUE(areEqual(batches));
  batches[2][1].z = 1.5f;
  EXPECT_FALSE(areEqual(batches));
}

}  // namespace
}  // namespace pb
