#include "bench/verdict.h"

#include <gtest/gtest.h>

#include "tests/unit/sample_results.h"

namespace pb {
namespace {

Estimate within(double value, double plusMinus) { return {value, value - plusMinus, value + plusMinus}; }

TEST(Verdict, IsDecidedWhereIntervalsDontTouch) {
  EXPECT_EQ(verdictOf(within(1, 0.1), within(2, 0.1)), Verdict::better);
  EXPECT_EQ(verdictOf(within(2, 0.1), within(1, 0.1)), Verdict::worse);
  EXPECT_EQ(verdictOf(within(1, 0.6), within(2, 0.5)), Verdict::equal);
}

TEST(Verdict, OfErrorsWithoutIntervals_IsThatOfTheValues) {
  EXPECT_EQ(verdictOf(within(1, 0), within(1.001, 0)), Verdict::better);
  EXPECT_EQ(verdictOf(within(1, 0), within(1, 0)), Verdict::equal);
}

TEST(Verdict, WhereBothAreNoise_IsBelowTheFloor) {
  EXPECT_EQ(verdictOf(within(1, 0), within(2, 0), false, false), Verdict::belowFloor);
  EXPECT_EQ(verdictOf(within(1, 0), within(2, 0), false, true), Verdict::better);
}

CellResult cellOf(const std::string& resolution, double flip, double plusMinus) {
  CellResult cell = samples::makeCell("a", 0, resolution, "static", 0.1);
  cell.maskMetrics->flipHdr->mean = flip;
  cell.maskMetrics->ssim->mean = 1 - flip;
  cell.maskIntervals = {{"flip_hdr", {flip - plusMinus, flip + plusMinus}},
                        {"ssim", {1 - flip - plusMinus, 1 - flip + plusMinus}}};
  return cell;
}

TEST(VerdictOfCells, KnowsInWhichMetricsMoreIsBetter) {
  const CellResult good = cellOf("64", 0.1, 0.01), bad = cellOf("128", 0.2, 0.01);
  EXPECT_EQ(verdictOf(good, bad, "flip_hdr", Region::mask), Verdict::better);
  EXPECT_EQ(verdictOf(good, bad, "ssim", Region::mask), Verdict::better);
}

TEST(RankingState, CountsPairsThatTheIntervalsLeaveOpen) {
  const std::vector<CellResult> cells = {cellOf("1", 0.10, 0.02), cellOf("2", 0.11, 0.02), cellOf("3", 0.30, 0.02),
                                         cellOf("4", 0.30, 0.02)};
  const RankingState state = rankingState(cells, "flip_hdr");
  EXPECT_EQ(state.pairs, 5u);      // the last two do the same
  EXPECT_EQ(state.undecided, 1u);  // the first two
}

TEST(RankingState, LeavesOutCellsWithoutAnInterval) {
  std::vector<CellResult> cells = {cellOf("1", 0.10, 0.02), cellOf("2", 0.11, 0.02)};
  cells[1].maskIntervals.clear();
  EXPECT_EQ(rankingState(cells, "flip_hdr").pairs, 0u);
}

}  // namespace
}  // namespace pb
