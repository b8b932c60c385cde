#include "bench/pareto.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pb {
namespace {

using testing::ElementsAre;

Estimate exactly(double value) { return {value, value, value}; }
Estimate within(double value, double plusMinus) { return {value, value - plusMinus, value + plusMinus}; }

TEST(Dominance, NeedsADifferenceBeyondBothIntervals) {
  const Tradeoff a{within(1.0, 0.2), exactly(1)};
  EXPECT_TRUE(dominates(a, {within(1.5, 0.2), exactly(1)}));
  EXPECT_FALSE(dominates(a, {within(1.3, 0.2), exactly(1)}));        // 1.2 > 1.1
  EXPECT_TRUE(dominates(a, {within(1.3, 0.2), within(1.5, 0.1)}));   // the cost decides
  EXPECT_FALSE(dominates(a, {within(1.3, 0.2), within(1.5, 0.6)}));  // nothing does
}

TEST(Dominance, IsLostByAWorseValueHoweverSmallTheDifference) {
  const Tradeoff better{within(1.0, 0.1), within(1.01, 0.5)};
  EXPECT_FALSE(dominates(better, {within(2.0, 0.1), within(1.0, 0.5)}));
}

TEST(Dominance, OfEqualsIsNone) {
  const Tradeoff a{exactly(1), exactly(2)};
  EXPECT_FALSE(dominates(a, a));
}

TEST(Dominance, OfUnknownErrors_IsThatOfTheCostAlone) {
  const Tradeoff a{Estimate::unknown(1), exactly(1)};
  EXPECT_FALSE(dominates(a, {Estimate::unknown(2), exactly(1)}));
  EXPECT_TRUE(dominates(a, {Estimate::unknown(2), exactly(2)}));
  EXPECT_FALSE(dominates(a, {Estimate::unknown(0.5), exactly(2)}));
}

TEST(ParetoFront, AsksForTheOrderOfErrors) {
  const std::vector<Tradeoff> choices = {{within(1.0, 0.3), exactly(2)}, {within(1.2, 0.3), exactly(2)}};
  EXPECT_THAT(paretoFront(choices, [](std::size_t i, std::size_t j) { return i == 0 && j == 1; }), ElementsAre(0));
}

TEST(ParetoFront, HoldsWhatNothingDominates_CheapestFirst) {
  const std::vector<Tradeoff> choices = {{exactly(1), exactly(9)},     // most exact
                                         {exactly(3), exactly(3)},     // between
                                         {exactly(4), exactly(4)},     // dominated by it
                                         {exactly(8), exactly(1)},     // cheapest
                                         {within(8, 1), exactly(3)}};  // dominated in error beyond both intervals
  EXPECT_THAT(paretoFront(choices), ElementsAre(3, 1, 0));
}

TEST(ParetoFront, KeepsWhatMayBeChance) {
  const std::vector<Tradeoff> choices = {{within(1.0, 0.3), exactly(2)}, {within(1.2, 0.3), exactly(2)}};
  EXPECT_THAT(paretoFront(choices), ElementsAre(0, 1));
}

TEST(Knee, IsFarthestBelowTheLineBetweenTheEnds) {
  // Straight in logarithms from (1, 100) to (100, 1), but for (2, 5) and (20, 4).
  const std::vector<Tradeoff> choices = {
      {exactly(100), exactly(1)}, {exactly(5), exactly(2)}, {exactly(4), exactly(20)}, {exactly(1), exactly(100)}};
  const std::vector<std::size_t> front = paretoFront(choices);
  EXPECT_EQ(kneeOf(choices, front), 1u);
}

TEST(Knee, OfAStraightLineOrOfTwo_IsNone) {
  const std::vector<Tradeoff> two = {{exactly(2), exactly(1)}, {exactly(1), exactly(2)}};
  EXPECT_EQ(kneeOf(two, paretoFront(two)), std::nullopt);
  // Above the line.
  const std::vector<Tradeoff> bulge = {
      {exactly(100), exactly(1)}, {exactly(90), exactly(50)}, {exactly(1), exactly(100)}};
  EXPECT_EQ(kneeOf(bulge, paretoFront(bulge)), std::nullopt);
}

TEST(Knee, WithAnErrorOfZero_Exists) {
  const std::vector<Tradeoff> choices = {
      {exactly(1), exactly(1)}, {exactly(0.01), exactly(2)}, {exactly(0), exactly(50)}};
  EXPECT_EQ(kneeOf(choices, paretoFront(choices)), 1u);
}

}  // namespace
}  // namespace pb
