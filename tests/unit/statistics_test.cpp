#include "bench/statistics.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace pb {
namespace {

TEST(Median, OfOddCount_IsTheMiddleValue) { EXPECT_EQ(median(std::vector{3.0, 1.0, 2.0}), 2.0); }

TEST(Median, OfEvenCount_IsTheMeanOfTheTwoMiddleValues) { EXPECT_EQ(median(std::vector{9.0, 1.0, 2.0, 4.0}), 3.0); }

TEST(MedianInterval, OfOneValue_IsThatValueWithoutCoverage) {
  const MedianInterval interval = medianInterval(std::vector{5.0});
  EXPECT_EQ(interval.low, 5.0);
  EXPECT_EQ(interval.high, 5.0);
  EXPECT_EQ(interval.coverage, 0.0);
}

struct Case {
  int n, low, high;  // of the values 1..n
  double coverage;   // 1 - 2 sum_{i<k} C(n,i) / 2^n
};

// k by hand: n = 5: even k = 1 misses 95 % (1 - 2/32). n = 6: k = 1 gives 1 - 2/64. n = 8: k = 1 gives 1 - 2/256, k = 2
// 1 - 18/256 < 95 %. n = 9: k = 2 gives 1 - 20/512. n = 10: k = 2 gives 1 - 22/1024, k = 3 1 - 112/1024 < 95 %.
TEST(MedianInterval, OfSmallCounts_MatchesTheBinomialByHand) {
  for (const Case c : {Case{5, 1, 5, 30.0 / 32}, Case{6, 1, 6, 62.0 / 64}, Case{8, 1, 8, 254.0 / 256},
                       Case{9, 2, 8, 492.0 / 512}, Case{10, 2, 9, 1002.0 / 1024}}) {
    std::vector<double> values(static_cast<std::size_t>(c.n));
    std::iota(values.rbegin(), values.rend(), 1.0);
    const MedianInterval interval = medianInterval(values);
    EXPECT_EQ(interval.low, c.low) << c.n;
    EXPECT_EQ(interval.high, c.high) << c.n;
    EXPECT_NEAR(interval.coverage, c.coverage, 1e-12) << c.n;  // lgamma is good to about 1e-15
  }
}

TEST(MedianInterval, OfManyValues_DoesNotUnderflow) {
  std::vector<double> values(4001);
  std::iota(values.begin(), values.end(), 0.0);
  const MedianInterval interval = medianInterval(values);
  // The normal approximation puts the ends at n/2 -+ 1.96 sqrt(n)/2 = 2000 -+ 62.
  EXPECT_NEAR(interval.low, 2000 - 62, 2);
  EXPECT_NEAR(interval.high, 2000 + 62, 2);
  EXPECT_GE(interval.coverage, 0.95);
}

}  // namespace
}  // namespace pb
