#include "bench/cost.h"
#include "bench/cost_model.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes/scene.h"

namespace pb {
namespace {

Technique techniqueOf(const char* refresh, int bounces = 1) {
  Technique technique;
  technique.refresh = parseSpec(refresh);
  technique.bounces = bounces;
  return technique;
}

// The first frame and `frames` more of a scene with five mirrors that stand still.
std::vector<std::shared_ptr<const Snapshot>> fiveMirrors(int frames) {
  const auto snapshot = makeSnapshot(loadScene("builtin:mirrors?count=5"), 0, "", 1.0);
  return std::vector(static_cast<std::size_t>(frames) + 1, snapshot);
}

TEST(CostBlock, IsWholeCyclesThatCoverTheMeasuredFrames) {
  EXPECT_EQ(blockFrames(techniqueOf("every-frame"), 5, 1), 1);
  EXPECT_EQ(blockFrames(techniqueOf("every-frame"), 5, 8), 8);
  EXPECT_EQ(blockFrames(techniqueOf("static"), 5, 8), 8);
  EXPECT_EQ(blockFrames(techniqueOf("every-n?n=4"), 5, 1), 4);
  EXPECT_EQ(blockFrames(techniqueOf("every-n?n=4"), 5, 6), 8);
  EXPECT_EQ(blockFrames(techniqueOf("faces?k=1"), 5, 1), 30);  // 5 probes of 6 faces
  EXPECT_EQ(blockFrames(techniqueOf("faces?k=1"), 1, 8), 12);
}

TEST(CostBlock, OfASlowPolicy_IsLimited) {
  EXPECT_EQ(blockFrames(techniqueOf("every-n?n=1000"), 5, 1), kMaxBlockFrames);
}

TEST(CostModel, OfEveryFrame_Is6NBPlus1) {
  for (const int bounces : {1, 2, 3}) {
    const RenderCount count = modelRenders(techniqueOf("every-frame", bounces), fiveMirrors(2));
    EXPECT_EQ(count.perFrame, 6 * 5 * bounces + 1);
    EXPECT_EQ(count.formula, fmt::format("6*N*B+1 = {}", 30 * bounces + 1));
  }
}

TEST(CostModel, OfOtherPolicies_IsOnePlusBTimesTheScheduledFaces) {
  EXPECT_EQ(modelRenders(techniqueOf("faces?k=2", 3), fiveMirrors(15)).perFrame, 1 + 3 * 2);
  EXPECT_EQ(modelRenders(techniqueOf("faces?k=1"), fiveMirrors(30)).formula, "1+B*faces = 2");
  EXPECT_EQ(modelRenders(techniqueOf("static", 3), fiveMirrors(4)).perFrame, 1);
  EXPECT_EQ(modelRenders(techniqueOf("on-change", 3), fiveMirrors(4)).perFrame, 1);  // nothing moves
  EXPECT_EQ(modelRenders(techniqueOf("every-n?n=4", 2), fiveMirrors(4)).perFrame, 1 + 2 * 30 / 4.0);
}

}  // namespace
}  // namespace pb
