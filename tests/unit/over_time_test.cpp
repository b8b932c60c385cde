#include "bench/over_time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "bench/cost.h"
#include "bench/flicker.h"
#include "bench/statistics.h"
#include "tests/unit/sample_results.h"

namespace pb {
namespace {

std::vector<double> oneTo(int n) {
  std::vector<double> values(static_cast<std::size_t>(n));
  std::iota(values.begin(), values.end(), 1.0);
  return values;
}

TEST(Quantile, IsTheSmallestValueThatTheShareDoesNotExceed) {
  EXPECT_EQ(quantile(oneTo(20), 0.95), 19.0);
  EXPECT_EQ(quantile(oneTo(21), 0.95), 20.0);  // 19 of 21 are 90.5 %
  EXPECT_EQ(quantile(oneTo(19), 0.95), 19.0);
  EXPECT_EQ(quantile(oneTo(100), 0.99), 99.0);
  EXPECT_EQ(quantile(std::vector{3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantile(std::vector{7.0}, 0.01), 7.0);
}

// A policy that works in every 30th frame: the median doesn't show it, the peaks do.
TEST(CostPeaks, ShowWhatAmortisedWorkCosts) {
  std::vector<double> frames(100, 4.0);
  frames[0] = frames[30] = frames[60] = frames[90] = 12.0;
  frames[95] = 9.0;
  const CostPeaks peaks = peaksOf(frames);
  EXPECT_EQ(peaks, (CostPeaks{4.0, 4.0, 12.0, 12.0}));
}

// One pixel of the mask; the error changes by +0.1 in it and by -0.3 in red beside it. What changes in both renderers,
// and an error that stays, don't flicker.
TEST(Flicker, IsTheChangeThatOnlyOneRendererShows) {
  const Image reference(4, 1, glm::vec3(1.0f)), referenceBefore(4, 1, glm::vec3(5.0f));
  Image image = reference, imageBefore = referenceBefore;
  image[0] += 0.1f;
  image[1].x -= 0.3f;
  image[2] += 2.0f;
  imageBefore[2] += 2.0f;
  Mask mask(4, 1), maskBefore(4, 1);
  mask[0] = 1;
  maskBefore[2] = 1;
  const Flicker flicker = computeFlicker({image, reference, mask}, {imageBefore, referenceBefore, maskBefore}, 1);
  constexpr double kRounding = 1e-6;
  EXPECT_NEAR(flicker.whole, (3 * 0.1 + 0.3) / 12, kRounding);
  EXPECT_NEAR(flicker.mask.value(), 3 * 0.1 / 6, kRounding);
  EXPECT_FALSE(computeFlicker({image, reference, {}}, {image, reference, {}}, 1).mask);
  // The same change over four frames is a quarter of it a frame.
  const Flicker slow = computeFlicker({image, reference, mask}, {imageBefore, referenceBefore, maskBefore}, 4);
  EXPECT_DOUBLE_EQ(slow.whole, flicker.whole / 4);
  EXPECT_DOUBLE_EQ(slow.mask.value(), flicker.mask.value() / 4);
}

// Frames 0 to 3 with these relMSE (which samples::makeMetrics makes a tenth of) and ages.
struct Frames {
  std::vector<CellResult> cells;
  Sequence sequence() const {
    Sequence sequence;
    for (const CellResult& cell : cells) sequence.push_back(&cell);
    return sequence;
  }
};
Frames makeFrames() {
  Frames frames;
  const double errors[] = {0.1, 0.4, 0.2, 0.3};
  const std::int64_t ages[] = {0, 2, 0, 2};
  for (int f = 0; f < 4; ++f) {
    frames.cells.push_back(samples::makeCell("a", f, "64", "static", errors[f]));
    frames.cells.back().faceAgeFrames = {{ages[f], ages[f], ages[f], ages[f], ages[f], ages[f]}};
    if (f > 0) frames.cells.back().flicker = Flicker{errors[f] / 2, std::nullopt};
  }
  return frames;
}

TEST(FrameSummary, HasMeanQuantileAndWorstFrame) {
  const Frames frames = makeFrames();
  const FrameSummary summary = summarizeErrors(frames.sequence(), Region::whole, "relmse").value();
  EXPECT_NEAR(summary.mean, 0.025, 1e-12);
  EXPECT_EQ(summary.worst, 0.4 / 10);
  EXPECT_EQ(summary.p95, summary.worst);
  EXPECT_EQ(summary.worstFrame, 1);
  EXPECT_EQ(summary.frames, 4);
}

TEST(FrameSummary, OfAMetricOfLikeness_TakesTheLowestForTheWorst) {
  Frames frames = makeFrames();
  frames.cells[2].metrics.ssim->mean = 0.25;
  const FrameSummary summary = summarizeErrors(frames.sequence(), Region::whole, "ssim").value();
  EXPECT_EQ(summary.worst, 0.25);
  EXPECT_EQ(summary.p95, 0.25);
  EXPECT_EQ(summary.worstFrame, 2);
}

TEST(FrameSummary, OfFlicker_LeavesOutTheFirstFrame) {
  const Frames frames = makeFrames();
  EXPECT_EQ(summarizeFlicker(frames.sequence(), Region::whole)->frames, 3);
  EXPECT_EQ(summarizeFlicker(frames.sequence(), Region::whole)->worst, 0.2);
  EXPECT_FALSE(summarizeFlicker(frames.sequence(), Region::mask));
}

TEST(Staleness, GroupsErrorsByAge) {
  const Frames frames = makeFrames();
  const std::vector<StalePoint> points = errorsByStaleness(frames.sequence(), Region::whole, "relmse");
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[1].largestAge, 2);
  EXPECT_EQ(points[1].meanAge, 2.0);
  const std::vector<StaleMean> means = meansByAge(points);
  ASSERT_EQ(means.size(), 2u);
  EXPECT_EQ(means[0].age, 0);
  EXPECT_NEAR(means[0].error, 0.015, 1e-12);
  EXPECT_EQ(means[1].age, 2);
  EXPECT_NEAR(means[1].error, 0.035, 1e-12);
  EXPECT_EQ(means[1].frames, 2);
}

}  // namespace
}  // namespace pb
