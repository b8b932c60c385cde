#include "bench/bounce_depth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"

namespace pb {
namespace {

using testing::ElementsAre;

// That many mirrors, each with a probe of its own.
Snapshot makeMirrors(int count, const Material& material = makeMirrorMaterial("mirror")) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material};
  scene->environment = makeConstantEnvironment(glm::vec3(1.0f));
  auto mesh = std::make_shared<Mesh>();
  mesh->bounds = {glm::vec3(-0.25f), glm::vec3(0.25f)};
  Snapshot snapshot;
  snapshot.scene = scene;
  for (int i = 0; i < count; ++i) {
    SnapshotInstance& instance = snapshot.instances.emplace_back();
    instance.mesh = mesh;
    instance.probe = i;
    instance.worldFromObject = glm::mat4(1.0f);
    instance.worldBounds = mesh->bounds;
    snapshot.probes.push_back({{static_cast<float>(i), 0, 0}, {i}, 0.01f});
  }
  snapshot.camera = cubeFaceView({0.0f, 0.0f, 4.0f}, 5, 0.1f);
  return snapshot;
}

Technique techniqueOf(int bounces, Feedback feedback, BounceOrder order, const char* refresh = "every-frame") {
  Technique technique;
  technique.bounces = bounces;
  technique.feedback = feedback;
  technique.bounceOrder = order;
  technique.refresh = parseSpec(refresh);
  return technique;
}

std::vector<int> depthsOf(const Technique& technique, const Snapshot& snapshot, int frames) {
  BounceDepth depth(technique, 64);
  std::vector<int> depths;
  for (int f = 0; f < frames; ++f) depths.push_back(depth.advance(snapshot));
  return depths;
}

constexpr auto kSky = Feedback::sky, kPrevious = Feedback::previousFrame;
constexpr auto kSimultaneous = BounceOrder::simultaneous, kSequential = BounceOrder::sequential;

TEST(BounceDepth, UnderSkyFeedback_IsBPlus1) {
  for (const int b : {1, 2, 3})
    EXPECT_THAT(depthsOf(techniqueOf(b, kSky, kSimultaneous), makeMirrors(3), 3), ElementsAre(b + 1, b + 1, b + 1));
}

// B (f + 1) + 1 at frame f.
TEST(BounceDepth, OfThePreviousFrame_GrowsWithTheFrames) {
  EXPECT_THAT(depthsOf(techniqueOf(1, kPrevious, kSimultaneous), makeMirrors(2), 4), ElementsAre(2, 3, 4, 5));
  EXPECT_THAT(depthsOf(techniqueOf(3, kPrevious, kSimultaneous), makeMirrors(5), 3), ElementsAre(4, 7, 10));
}

// Two mirrors hold 2 b - 1 and 2 b bounces after b iterations in turn: the deeper one counts.
TEST(BounceDepth, InSequence_IsThatOfTheLastProbe) {
  EXPECT_THAT(depthsOf(techniqueOf(1, kSky, kSequential), makeMirrors(2), 2), ElementsAre(3, 3));
  EXPECT_THAT(depthsOf(techniqueOf(2, kSky, kSequential), makeMirrors(2), 2), ElementsAre(5, 5));
  EXPECT_THAT(depthsOf(techniqueOf(1, kPrevious, kSequential), makeMirrors(5), 2), ElementsAre(6, 11));
}

// Its map never shows the mirror itself: nothing is gained.
TEST(BounceDepth, OfASingleProbe_IsTwo) {
  EXPECT_THAT(depthsOf(techniqueOf(3, kPrevious, kSequential), makeMirrors(1), 3), ElementsAre(2, 2, 2));
}

TEST(BounceDepth, OfPoliciesThatCaptureLessOften_GrowsWithTheirCaptures) {
  EXPECT_THAT(depthsOf(techniqueOf(2, kPrevious, kSimultaneous, "static"), makeMirrors(2), 3), ElementsAre(3, 3, 3));
  EXPECT_THAT(depthsOf(techniqueOf(1, kPrevious, kSimultaneous, "every-n?n=2&together=1"), makeMirrors(2), 5),
              ElementsAre(2, 2, 3, 3, 4));
  // One face of the first probe at frame 1 sees what the other holds, one bounce; frames 2 to 6 give its other faces as
  // much. At frame 7 a face of the second probe sees that.
  EXPECT_THAT(depthsOf(techniqueOf(1, kPrevious, kSimultaneous, "faces?k=1"), makeMirrors(2), 8),
              ElementsAre(2, 3, 3, 3, 3, 3, 3, 4));
}

// In and out of each glass: a passage is one lookup and two hits.
TEST(BounceDepth, OfGlass_CountsBothOfItsSides) {
  EXPECT_THAT(depthsOf(techniqueOf(1, kSky, kSimultaneous), makeMirrors(2, makeGlassMaterial("glass", 1.5f)), 1),
              ElementsAre(4));
  EXPECT_THAT(depthsOf(techniqueOf(1, kSky, kSimultaneous), makeMirrors(2, makeGlassMaterial("pane", 1.5f, 0.0f)), 1),
              ElementsAre(2));
}

// Three mirrors captured twice, at first: 1 + 2. Then two of them share a new probe, whose captures see the third one's
// map, 2 deep: 1 + 3. Then both have new probes of their own, which see that and, in the second iteration, each other.
TEST(BounceDepth, OfProbesThatAreJoinedAndPart_StartsAnewForThemOnly) {
  Technique technique = techniqueOf(2, kPrevious, kSimultaneous, "static");
  technique.sharing = parseSpec("distance?metres=0.5");
  const Snapshot apart = makeMirrors(3);
  Snapshot joined = apart;
  joined.probes[0].position.x = 0.8f;
  BounceDepth depth(technique, 64);
  EXPECT_EQ(depth.advance(apart), 3);
  EXPECT_EQ(depth.advance(joined), 4);
  EXPECT_EQ(depth.advance(joined), 4);
  EXPECT_EQ(depth.advance(apart), 5);
}

TEST(BounceDepth, WithoutCaptures_IsOne) {
  Technique technique;
  technique.probes = ProbeUse::environmentOnly;
  EXPECT_THAT(depthsOf(technique, makeMirrors(2), 2), ElementsAre(1, 1));
  EXPECT_THAT(depthsOf(Technique(), makeMirrors(0), 1), ElementsAre(1));
}

TEST(BounceDepths, OfSeveralTechniques_AreThoseOfEach) {
  const auto snapshot = std::make_shared<const Snapshot>(makeMirrors(2));
  Technique large = techniqueOf(1, kPrevious, kSimultaneous);
  large.resolution = 1024;
  const auto depths = bounceDepths(
      {techniqueOf(1, kPrevious, kSimultaneous), techniqueOf(2, kSky, kSimultaneous), large}, 3, 5,
      [&](int) { return snapshot; }, 64);
  EXPECT_THAT(depths, ElementsAre(ElementsAre(2, 3, 4), ElementsAre(3, 3, 3), ElementsAre(2, 3, 4)));
}

}  // namespace
}  // namespace pb
