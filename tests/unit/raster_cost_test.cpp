// What a frame is said to have cost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

class RasterCost : public RasterTest {};

INSTANTIATE_TEST_SUITE_P(Gl, RasterCost, kBackends, nameOfBackend);

TEST_P(RasterCost, CountersFollowTheCostModel) {
  Technique technique = withResolution(16);
  technique.bounces = 2;
  const auto snapshot = snapshotOf("mirrors?count=3");
  RasterSequence sequence(device(), technique, 32, 18, 1);
  const FrameCounters first = sequence.renderFrame(*snapshot).counters;
  EXPECT_EQ(first.facesCaptured, 6 * 3 * 2);
  EXPECT_EQ(first.probeBytes, 3 * 6 * 16 * 16 * 8);
  EXPECT_EQ(first.fragments, 0);
  FrameCounters counted = sequence.renderFrame(*snapshot, true).counters;
  // Every sample of the 36 faces and of the image is covered at least once, by the background if by nothing else.
  EXPECT_GE(counted.fragments, 36 * 16 * 16 + 32 * 18);
  counted.fragments = 0;
  EXPECT_EQ(counted, first);
}

TEST_P(RasterCost, BackgroundIsOneDrawOfOneTriangle) {
  Scene scene = makeEmptyScene(kBlue);
  addBox(scene, vec3(0, 0, 9), vec3(1.0f), makeUnlit(kRed));  // behind the camera
  RasterSequence sequence(device(), withResolution(8), 20, 10, 1);
  const FrameCounters counters = sequence.renderFrame(*snapshotOf(std::move(scene), 2.0), true).counters;
  EXPECT_EQ(counters.draws, 1);
  EXPECT_EQ(counters.triangles, 1);
  EXPECT_EQ(counters.fragments, 20 * 10);
  for (const vec3& pixel : sequence.readImage()) EXPECT_EQ(pixel, kBlue);
}

TEST_P(RasterCost, TimedFrameShowsTheSamePictureAndTimesEveryPass) {
  Technique technique = withResolution(16);
  technique.bounces = 3;
  const auto snapshot = snapshotOf("mirrors?count=2");
  RasterSequence timed(device(), technique, 32, 18, 1);
  const PassTimes times = timed.renderFrameTimed(*snapshot);
  ASSERT_THAT(times.captureMs, testing::SizeIs(3));
  for (const double ms : times.captureMs) EXPECT_GT(ms, 0.0);
  EXPECT_GT(times.finalMs, 0.0);
  EXPECT_EQ(timed.readImage(), render(*snapshot, technique, 32, 18));
}

}  // namespace
}  // namespace pb
