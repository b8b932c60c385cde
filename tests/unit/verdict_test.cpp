#include "bench/verdict.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/unit/sample_results.h"

namespace pb {
namespace {

Estimate within(double value, double plusMinus) { return {value, value - plusMinus, value + plusMinus}; }

TEST(Verdict, IsDecidedWhereIntervalsDontTouch) {
  EXPECT_EQ(verdictOf(within(1, 0.1), within(2, 0.1)), Verdict::better);
  EXPECT_EQ(verdictOf(within(2, 0.1), within(1, 0.1)), Verdict::worse);
  EXPECT_EQ(verdictOf(within(1, 0.6), within(2, 0.5)), Verdict::equal);
}

TEST(Verdict, OfExactErrors_IsThatOfTheValues) {
  EXPECT_EQ(verdictOf(within(1, 0), within(1.001, 0)), Verdict::better);
  EXPECT_EQ(verdictOf(within(1, 0), within(1, 0)), Verdict::equal);
}

TEST(Verdict, OfUnknownErrors_IsNotDecided) {
  EXPECT_EQ(verdictOf(Estimate::unknown(1), Estimate::unknown(2)), Verdict::equal);
  EXPECT_EQ(verdictOf(Estimate::unknown(1), within(2, 0.1)), Verdict::equal);
  EXPECT_FALSE(unpairedDifference(Estimate::unknown(1), within(2, 0.1)).isKnown());
}

TEST(VerdictBelowTheFloor, WantsThePairedDifferenceOfMseOnTheSameSide) {
  const Difference less{within(-1, 0.1), true}, more{within(1, 0.1), true}, open{within(-1, 2), true};
  EXPECT_EQ(verdictBelowFloor(less, less), Verdict::better);
  EXPECT_EQ(verdictBelowFloor(more, more), Verdict::worse);
  EXPECT_EQ(verdictBelowFloor(less, more), Verdict::belowFloor);
  EXPECT_EQ(verdictBelowFloor(less, open), Verdict::belowFloor);
  EXPECT_EQ(verdictBelowFloor(open, less), Verdict::belowFloor);
  EXPECT_EQ(verdictBelowFloor(less, Difference{less.loss}), Verdict::belowFloor);
  EXPECT_EQ(verdictBelowFloor(Difference{less.loss}, less), Verdict::belowFloor);
  EXPECT_EQ(verdictBelowFloor({within(0, 0), true}, less), Verdict::equal);  // they do the same
}

CellResult cellOf(const std::string& resolution, double flip, double plusMinus) {
  CellResult cell = samples::makeCell("a", 0, resolution, "static", 0.1);
  cell.maskMetrics->flipHdr->mean = flip;
  cell.maskMetrics->ssim->mean = 1 - flip;
  cell.maskMetrics->sums.mse = flip;
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
  std::vector<double> flip, ssim, mse;
  for (int b = 0; b < 16; ++b) {
    const double noise = ((b % 2 == 0 ? common : -common) + (b % 4 < 2 ? own : -own)) / 15;
    flip.push_back(cell.maskMetrics->flipHdr->mean + noise);
    ssim.push_back(cell.maskMetrics->ssim->mean - noise);
    mse.push_back(cell.maskMetrics->sums.mse + noise);
  }
  cell.maskReplicates = {{"flip_hdr", flip}, {"ssim", ssim}, {"mse", mse}};
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
TEST(PairedVerdict, BelowTheFloor_IsDecidedIfTheDifferenceIsClearAndThatOfMseToo) {
  const auto noisy = [](CellResult cell) {
    cell.maskFloor = {{"relmse", 1e9}};
    return cell;
  };
  const CellResult a = noisy(withReplicates(cellOf("64", 0.1900, 0.01), 0.02, 0.001));
  const CellResult far = noisy(withReplicates(cellOf("128", 0.1950, 0.01), 0.02, -0.001));
  const CellResult near = noisy(withReplicates(cellOf("128", 0.1905, 0.01), 0.02, -0.001));
  EXPECT_EQ(verdictOf(a, far, "flip_hdr", Region::mask), Verdict::better);
  EXPECT_EQ(verdictOf(a, near, "flip_hdr", Region::mask), Verdict::belowFloor);
  CellResult withoutMse = far;
  withoutMse.maskReplicates.pop_back();
  EXPECT_EQ(verdictOf(a, withoutMse, "flip_hdr", Region::mask), Verdict::belowFloor);
  CellResult unpaired = far;
  unpaired.maskReplicates.clear();
  EXPECT_EQ(verdictOf(a, unpaired, "flip_hdr", Region::mask), Verdict::belowFloor);
}

// A picture of one value, `factor` times the truth of 0.5 in every pixel, against 16 batches of exponential noise
// (skewed, with its median 31 % below its mean, as path tracing has it): 25 % of the mean of the batches. In place of
// HDR-FLIP, an error that is its like: |I - R|^0.7.
CellResult flatPicture(const std::string& name, double factor, std::uint32_t seed) {
  constexpr double kTruth = 0.5, kPixels = 10000;
  constexpr std::size_t kBatches = 16;
  std::mt19937 generator(seed);
  const auto noise = [&] { return -std::log((static_cast<double>(generator()) + 0.5) / 0x1p32); };  // of mean 1
  std::vector<double> flip(kBatches + 1), mse(kBatches + 1);  // without each batch; with all
  for (int pixel = 0; pixel < static_cast<int>(kPixels); ++pixel) {
    double batches[kBatches], sum = 0;
    for (double& batch : batches) sum += batch = kTruth * noise();
    for (std::size_t b = 0; b <= kBatches; ++b) {
      const double reference = b == kBatches ? sum / kBatches : (sum - batches[b]) / (kBatches - 1);
      const double error = factor * kTruth - reference;
      flip[b] += std::pow(std::abs(error), 0.7) / kPixels;
      mse[b] += error * error / kPixels;
    }
  }
  CellResult cell = cellOf(name, flip.back(), 0.01);
  cell.maskMetrics->sums.mse = mse.back();
  cell.maskMetrics->sums.relmse = 1;
  cell.maskFloor = {{"relmse", 1}};
  flip.pop_back(), mse.pop_back();
  cell.maskReplicates = {{"flip_hdr", flip}, {"mse", mse}};
  cell.referenceHash = std::to_string(seed);
  return cell;
}

// 5 % too dark is worse than 4 % too bright, but nearer to the median of the noise. The paired difference alone says
// "better" for sure in some of the trials. Only mse has no preference for the median.
TEST(PairedVerdict, BelowTheFloor_IsNotThatOfSkewedNoise) {
  int misled = 0;
  Selection selection;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    const CellResult dark = flatPicture("dark", 0.95, seed), bright = flatPicture("bright", 1.04, seed);
    EXPECT_NE(verdictOf(dark, bright, "flip_hdr", Region::mask), Verdict::better) << seed;
    EXPECT_NE(verdictOf(dark, bright, "mse", Region::mask), Verdict::better) << seed;
    misled += differenceOf(dark, bright, selection, Region::mask)->loss.isNegative();
  }
  EXPECT_GT(misled, 0) << "the trials don't show what they are for";
}

// 5 % too dark is better than 30 % too bright by both metrics, for sure.
TEST(PairedVerdict, BelowSkewedNoise_KnowsWhatIsMuchWorse) {
  for (std::uint32_t seed = 1; seed <= 8; ++seed)
    EXPECT_EQ(verdictOf(flatPicture("dark", 0.95, seed), flatPicture("bright", 1.3, seed), "flip_hdr", Region::mask),
              Verdict::better);
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
