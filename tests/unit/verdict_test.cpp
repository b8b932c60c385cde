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

// Replicates that go up and down together by `common`, and by `own` of each cell's own; at +-d/15 about the value their
// standard error is d / sqrt(15).
CellResult withReplicates(CellResult cell, double common, double own) {
  std::vector<double> flip, ssim;
  for (int b = 0; b < 16; ++b) {
    const double noise = ((b % 2 == 0 ? common : -common) + (b % 4 < 2 ? own : -own)) / 15;
    flip.push_back(cell.maskMetrics->flipHdr->mean + noise);
    ssim.push_back(cell.maskMetrics->ssim->mean - noise);
  }
  cell.maskReplicates = {{"flip_hdr", flip}, {"ssim", ssim}};
  cell.referenceHash = "the same";
  return cell;
}

TEST(PairedVerdict, IsDecidedThoughTheIntervalsOverlap) {
  const CellResult a = withReplicates(cellOf("64", 0.190, 0.01), 0.02, 0.001);
  const CellResult b = withReplicates(cellOf("128", 0.195, 0.01), 0.02, -0.001);
  for (const char* metric : {"flip_hdr", "ssim"}) {
    EXPECT_EQ(verdictOf(a, b, metric, Region::mask), Verdict::better) << metric;
    EXPECT_EQ(verdictOf(b, a, metric, Region::mask), Verdict::worse) << metric;
  }
  EXPECT_EQ(rankingState({a, b}, "flip_hdr").undecided, 0u);
}

TEST(PairedVerdict, WithinTheIntervalOfTheDifference_IsEqual) {
  const CellResult a = withReplicates(cellOf("64", 0.1900, 0.01), 0.02, 0.001);
  const CellResult b =
      withReplicates(cellOf("128", 0.1905, 0.01), 0.02, -0.001);  // +- 2.131 * 0.002 / sqrt(15) = 0.0011
  EXPECT_EQ(verdictOf(a, b, "flip_hdr", Region::mask), Verdict::equal);
  EXPECT_EQ(rankingState({a, b}, "flip_hdr").undecided, 1u);
}

TEST(PairedVerdict, OfTechniquesThatDoTheSame_IsEqual) {
  const CellResult a = withReplicates(cellOf("64", 0.19, 0.01), 0.02, 0.001);
  CellResult b = a;
  EXPECT_EQ(verdictOf(a, b, "flip_hdr", Region::mask), Verdict::equal);
  b.maskFloor = {{"relmse", 1e9}};
  EXPECT_EQ(verdictOf(b, b, "flip_hdr", Region::mask), Verdict::equal);  // below the floor, too
}

TEST(PairedVerdict, WantsTheSameReference) {
  const CellResult a = withReplicates(cellOf("64", 0.190, 0.01), 0.02, 0.001);
  const CellResult b = withReplicates(cellOf("128", 0.195, 0.01), 0.02, -0.001);
  CellResult other = b;
  other.referenceHash = "another";
  EXPECT_EQ(verdictOf(a, other, "flip_hdr", Region::mask), Verdict::equal);
  other = b;
  other.maskReplicates.front().second.pop_back();  // of fewer batches
  EXPECT_EQ(verdictOf(a, other, "flip_hdr", Region::mask), Verdict::equal);
  other = b;
  other.maskReplicates.clear();  // of an older run
  EXPECT_EQ(verdictOf(a, other, "flip_hdr", Region::mask), Verdict::equal);
}

// Where both errors are mostly noise, the noise is the same.
TEST(PairedVerdict, BelowTheFloor_IsDecidedIfTheDifferenceIsClear) {
  const auto noisy = [](CellResult cell) {
    cell.maskFloor = {{"relmse", 1e9}};
    return cell;
  };
  const CellResult a = noisy(withReplicates(cellOf("64", 0.1900, 0.01), 0.02, 0.001));
  const CellResult far = noisy(withReplicates(cellOf("128", 0.1950, 0.01), 0.02, -0.001));
  const CellResult near = noisy(withReplicates(cellOf("128", 0.1905, 0.01), 0.02, -0.001));
  EXPECT_EQ(verdictOf(a, far, "flip_hdr", Region::mask), Verdict::better);
  EXPECT_EQ(verdictOf(a, near, "flip_hdr", Region::mask), Verdict::belowFloor);
  CellResult unpaired = far;
  unpaired.maskReplicates.clear();
  EXPECT_EQ(verdictOf(a, unpaired, "flip_hdr", Region::mask), Verdict::belowFloor);
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
