#include "bench/jackknife.h"

#include <gtest/gtest.h>

#include <cmath>
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
