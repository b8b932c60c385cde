#include "reference/sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <set>

#include "reference/sobol.h"
#include "tests/statistics.h"

namespace pb {
namespace {

// Counts of `count` numbers in 64 equal bins, as a standard normal variable.
double uniformityScore(const std::function<float(std::uint32_t)>& number, std::uint32_t count = 64000) {
  std::vector<double> bins(64, 0.0);
  for (std::uint32_t i = 0; i < count; ++i) ++bins[static_cast<std::size_t>(number(i) * 64.0f)];
  return test::chiSquareScore(bins, std::vector<double>(64, count / 64.0));
}

// Two-sided: bins that are too even are no random numbers either.
const double kLimit = test::sidakScore(11);

float fraction(float x) { return x - std::floor(x); }

TEST(IndependentSampler, IsUniformAlongEveryArgument) {
  const auto first = [](std::uint64_t seed, std::uint32_t point, std::uint64_t sample) {
    return Sampler(seed, point, sample).next();
  };
  Sampler dimensions(1, 2, 3);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return first(i, 2, 3); })), kLimit);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return first(1, i, 3); })), kLimit);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return first(1, 2, i); })), kLimit);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t) { return dimensions.next(); })), kLimit);
}

// Neighbours along two arguments: the fractional part of their sum is uniform only if they are not tied together.
TEST(IndependentSampler, NeighboursAreNotCorrelated) {
  const auto pair = [](std::uint32_t point, std::uint64_t sample) { return Sampler(1, point, sample).next2(); };
  const auto sum = [](glm::vec2 p) { return fraction(p.x + p.y); };
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return sum(pair(i, 0)); })), kLimit);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return fraction(pair(i, 0).x + pair(i, 1).x); })), kLimit);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return fraction(pair(i, 0).x + pair(i + 1, 0).x); })),
            kLimit);
}

// Number `before` + 1 of point `index`.
float sobolNumber(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sequence, std::uint32_t index,
                  int before = 0) {
  SobolScrambles scrambles(seed, pixel, sequence);
  Sampler sampler(scrambles, index);
  for (int d = 0; d < before; ++d) sampler.next();
  return sampler.next();
}

// Every point by itself is uniform over the scrambles: over seeds, pixels, halves and dimensions.
TEST(SobolSampler, AnyPointIsUniformOverSeedsPixelsAndDimensions) {
  EXPECT_LT(std::abs(uniformityScore([](std::uint32_t i) { return sobolNumber(i, 7, 0, 5); })), kLimit);
  EXPECT_LT(std::abs(uniformityScore([](std::uint32_t i) { return sobolNumber(1, i, 1, 5); })), kLimit);
  SobolScrambles scrambles(1, 2, 0);
  Sampler dimensions(scrambles, 3);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t) { return dimensions.next(); })), kLimit);
}

// The same point of neighbouring pixels, of both halves, and of dimensions of different groups.
TEST(SobolSampler, ScramblesAreIndependent) {
  const auto number = [](std::uint32_t pixel, std::uint32_t half, int dimension) {
    return sobolNumber(1, pixel, half, 3, dimension);
  };
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return fraction(number(i, 0, 0) + number(i + 1, 0, 0)); })),
            kLimit);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return fraction(number(i, 0, 0) + number(i, 1, 0)); })),
            kLimit);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return fraction(number(i, 0, 0) + number(i, 0, 1)); })),
            kLimit);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return fraction(number(i, 0, 1) + number(i, 0, 5)); })),
            kLimit);
}

// Every elementary interval of area 2^-m holds one of 2^m points: the (0,m,2)-net of the first two Sobol dimensions,
// which scrambling keeps. 2^m consecutive points from any multiple of 2^m on, in every group of dimensions.
TEST(SobolSampler, PairsAreStratifiedInEveryElementaryInterval) {
  constexpr unsigned m = 6;
  SobolScrambles scrambles(3, 11, 1);
  for (const std::uint32_t begin : {0u, 64u, 1024u, 999936u})
    for (const int group : {0, 1, 5})
      for (unsigned columns = 0; columns <= m; ++columns) {
        std::set<std::pair<int, int>> cells;
        for (std::uint32_t i = 0; i < 1u << m; ++i) {
          Sampler sampler(scrambles, begin + i);
          for (int d = 0; d < 4 * group; ++d) sampler.next();
          const glm::vec2 p = sampler.next2();
          cells.emplace(static_cast<int>(p.x * static_cast<float>(1u << columns)),
                        static_cast<int>(p.y * static_cast<float>(1u << (m - columns))));
        }
        EXPECT_EQ(cells.size(), 1u << m) << begin << " " << group << " " << columns;
      }
}

TEST(SobolSampler, PairsAreNeverSplitBetweenGroups) {
  SobolScrambles scrambles(3, 11, 1);
  for (const int before : {3, 7}) {
    std::set<std::pair<int, int>> cells;
    for (std::uint32_t i = 0; i < 64; ++i) {
      Sampler sampler(scrambles, i);
      for (int d = 0; d < before; ++d) sampler.next();
      const glm::vec2 p = sampler.next2();
      cells.emplace(static_cast<int>(8.0f * p.x), static_cast<int>(8.0f * p.y));
    }
    EXPECT_EQ(cells.size(), 64u) << before;
  }
}

// Scrambles are kept for the first numbers of a sequence and hashed anew for the rest: the points that come first must
// not decide.
TEST(SobolSampler, NumbersDontDependOnWhatWasDrawnBefore) {
  SobolScrambles scrambles(3, 11, 1);
  for (const int drawn : {2, 7, 40, 5, 70}) {
    Sampler sampler(scrambles, 9);
    for (int d = 0; d < drawn; ++d) EXPECT_EQ(sampler.next(), sobolNumber(3, 11, 1, 9, d)) << drawn << " " << d;
  }
}

TEST(SobolSampler, TellsWhetherItWasUsed) {
  SobolScrambles scrambles(1, 2, 3);
  Sampler sampler(scrambles, 4);
  EXPECT_FALSE(sampler.used());
  sampler.next();
  EXPECT_TRUE(sampler.used());
}

// Points 0 to 3 of any Sobol sequence with m_1 = 1 are 0, 1/2 and m_2 / 4 with its exclusive or with 1/2: m_2 is 1, 3,
// 3 in the first three dimensions of Joe and Kuo's table.
TEST(Sobol, FirstPoints_AreThePublishedOnes) {
  const auto coordinate = [](std::uint32_t index, int dimension) {
    return static_cast<float>(reverseBits(reversedSobol(index, dimension)) >> 8) * 0x1p-24f;
  };
  const std::array<std::array<float, 3>, 4> expected = {
      {{0.0f, 0.0f, 0.0f}, {0.5f, 0.5f, 0.5f}, {0.25f, 0.75f, 0.75f}, {0.75f, 0.25f, 0.25f}}};
  for (std::uint32_t i = 0; i < 4; ++i)
    for (int d = 0; d < 3; ++d) EXPECT_EQ(coordinate(i, d), expected[i][static_cast<std::size_t>(d)]) << i << " " << d;
  // m_3 / 8: m is 1, 1, 1 and 1, 3, 5 in the first two dimensions.
  EXPECT_EQ(coordinate(4, 0), 0.125f);
  EXPECT_EQ(coordinate(4, 1), 0.625f);
}

// Each digit of the result depends on higher digits of the number alone (the bits below it, as numbers are reversed).
TEST(Scrambling, IsNested) {
  for (const std::uint32_t seed : {1u, 0x12345678u, 0xffffffffu})
    for (unsigned bit = 0; bit < 31; ++bit) {
      const std::uint32_t x = 0x2f3a91c5u, mask = (2u << bit) - 1u;
      EXPECT_EQ(scrambleReversed(x, seed) & mask, scrambleReversed(x ^ (mask + 1u), seed) & mask);
      EXPECT_NE(scrambleReversed(x, seed) & mask, scrambleReversed(x ^ 1u << bit, seed) & mask);
    }
}

}  // namespace
}  // namespace pb
