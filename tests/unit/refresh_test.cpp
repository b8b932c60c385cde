// Refresh policies choose (probe, face) pairs from the history alone.
#include "raster/refresh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "scenes/error.h"

namespace pb {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

// `count` probes, each owned by one instance; one more instance owns none.
Snapshot makeProbes(int count) {
  auto scene = std::make_shared<Scene>();
  scene->materials.push_back(makeMirrorMaterial("mirror"));
  auto mesh = std::make_shared<Mesh>();
  Snapshot snapshot;
  snapshot.scene = scene;
  for (int i = 0; i <= count; ++i) {
    SnapshotInstance instance;
    instance.mesh = mesh;
    instance.worldFromObject = glm::translate(glm::mat4(1.0f), glm::vec3(static_cast<float>(i), 0.0f, 0.0f));
    instance.probe = i < count ? i : -1;
    snapshot.instances.push_back(instance);
    if (i < count) snapshot.probes.push_back({glm::vec3(instance.worldFromObject[3]), {i}, 0.01f});
  }
  return snapshot;
}

// What the policy captures in each of `frames` frames of an unchanging snapshot.
std::vector<std::vector<ProbeFace>> capturesOf(const std::string& policy, const Snapshot& snapshot, int frames) {
  std::vector<std::vector<ProbeFace>> captures;
  RefreshHistory history;
  for (int f = 0; f < frames; ++f) {
    captures.push_back(dueFaces(parseSpec(policy), history, snapshot));
    advance(history, captures.back(), snapshot);
  }
  return captures;
}

class EveryPolicy : public testing::TestWithParam<std::string> {};

TEST_P(EveryPolicy, CapturesEveryFaceInTheFirstFrame) {
  const Snapshot snapshot = makeProbes(3);
  const std::vector<ProbeFace> faces = capturesOf(GetParam(), snapshot, 1).front();
  ASSERT_THAT(faces, SizeIs(18));
  for (int i = 0; i < 18; ++i) EXPECT_EQ(faces[static_cast<std::size_t>(i)], (ProbeFace{i / 6, i % 6}));
}

TEST_P(EveryPolicy, CapturesAProbeThatIsNewInALaterFrame) {
  RefreshHistory history;
  advance(history, dueFaces(parseSpec(GetParam()), history, makeProbes(1)), makeProbes(1));
  const std::vector<ProbeFace> faces = dueFaces(parseSpec(GetParam()), history, makeProbes(2));
  EXPECT_EQ(std::ranges::count(faces, 1, &ProbeFace::probe), 6);
}

TEST_P(EveryPolicy, OrdersFacesByProbeThenFace) {
  for (const std::vector<ProbeFace>& faces : capturesOf(GetParam(), makeProbes(2), 9))
    EXPECT_TRUE(std::ranges::is_sorted(faces, {}, [](const ProbeFace& f) { return std::pair(f.probe, f.face); }));
}

TEST_P(EveryPolicy, RepeatsItsWorkAfterItsCycle) {
  const Snapshot snapshot = makeProbes(2);
  const Spec spec = parseSpec(GetParam());
  const int cycle = refreshPolicy(spec).cycle(spec, 2);
  const auto captures = capturesOf(GetParam(), snapshot, 2 * cycle + 1);
  for (std::size_t f = 1; f <= static_cast<std::size_t>(cycle); ++f)
    EXPECT_EQ(captures[f], captures[f + static_cast<std::size_t>(cycle)]) << "frame " << f;
}

INSTANTIATE_TEST_SUITE_P(Refresh, EveryPolicy,
                         testing::Values("every-frame", "every-n?n=3", "faces?k=1", "faces?k=5", "faces?k=100",
                                         "on-change", "static"));

TEST(RefreshPolicies, AreAllTestedAbove) {
  std::vector<std::string> names;
  for (const RefreshPolicy& policy : refreshPolicies()) names.push_back(policy.name);
  EXPECT_THAT(names, testing::ElementsAre("every-frame", "every-n", "faces", "on-change", "static"));
}

TEST(EveryFrame, CapturesEverythingAlways) {
  for (const auto& faces : capturesOf("every-frame", makeProbes(2), 3)) EXPECT_THAT(faces, SizeIs(12));
}

TEST(EveryN, CapturesAllProbesTogetherInEveryNthFrame) {
  const auto captures = capturesOf("every-n?n=3", makeProbes(2), 7);
  for (std::size_t f = 0; f < captures.size(); ++f) EXPECT_THAT(captures[f], SizeIs(f % 3 == 0 ? 12 : 0)) << f;
}

TEST(Faces, GoRoundAllFacesEquallyOften) {
  // lcm(12, 5) = 60 captures in 12 frames: every face 5 times.
  const auto captures = capturesOf("faces?k=5", makeProbes(2), 13);
  std::map<std::pair<int, int>, int> count;
  for (std::size_t f = 1; f < captures.size(); ++f) {
    EXPECT_THAT(captures[f], SizeIs(5));
    for (const ProbeFace& face : captures[f]) ++count[{face.probe, face.face}];
  }
  ASSERT_THAT(count, SizeIs(12));
  for (const auto& [face, times] : count) EXPECT_EQ(times, 5);
}

TEST(Faces, StartWithTheFirstFaceAndGoOnWhereTheyStopped) {
  const auto captures = capturesOf("faces?k=4", makeProbes(1), 4);
  EXPECT_THAT(captures[1], testing::ElementsAre(ProbeFace{0, 0}, ProbeFace{0, 1}, ProbeFace{0, 2}, ProbeFace{0, 3}));
  EXPECT_THAT(captures[2], testing::ElementsAre(ProbeFace{0, 0}, ProbeFace{0, 1}, ProbeFace{0, 4}, ProbeFace{0, 5}));
}

TEST(Static, CapturesNothingAfterTheFirstFrame) {
  const auto captures = capturesOf("static", makeProbes(2), 4);
  for (std::size_t f = 1; f < captures.size(); ++f) EXPECT_THAT(captures[f], IsEmpty());
}

TEST(OnChange, CapturesNothingWhileNothingMoves) {
  const auto captures = capturesOf("on-change", makeProbes(2), 4);
  for (std::size_t f = 1; f < captures.size(); ++f) EXPECT_THAT(captures[f], IsEmpty());
}

// Faces that are due after `change` was made to two captured probes.
std::vector<ProbeFace> dueAfter(void (*change)(Snapshot&)) {
  Snapshot snapshot = makeProbes(2);
  RefreshHistory history;
  advance(history, dueFaces(parseSpec("on-change"), history, snapshot), snapshot);
  change(snapshot);
  return dueFaces(parseSpec("on-change"), history, snapshot);
}

glm::mat4 turned(const glm::mat4& matrix) { return glm::rotate(matrix, 0.5f, glm::vec3(0.0f, 1.0f, 0.0f)); }

TEST(OnChange, CapturesAllProbesWhenAnInstanceMoves) {
  EXPECT_THAT(dueAfter([](Snapshot& s) { s.instances[2].worldFromObject = turned(s.instances[2].worldFromObject); }),
              SizeIs(12));
}

TEST(OnChange, DoesNotCaptureAProbeWhoseOwnerTurnsOnTheSpot) {
  const std::vector<ProbeFace> due =
      dueAfter([](Snapshot& s) { s.instances[0].worldFromObject = turned(s.instances[0].worldFromObject); });
  EXPECT_EQ(std::ranges::count(due, 0, &ProbeFace::probe), 0);
  EXPECT_EQ(std::ranges::count(due, 1, &ProbeFace::probe), 6) << "the other probe sees the owner";
}

TEST(OnChange, CapturesAProbeThatMoves) {
  const std::vector<ProbeFace> due = dueAfter([](Snapshot& s) { s.probes[0].position.y += 1.0f; });
  EXPECT_EQ(std::ranges::count(due, 0, &ProbeFace::probe), 6);
  EXPECT_EQ(std::ranges::count(due, 1, &ProbeFace::probe), 0);
}

TEST(OnChange, CapturesAllProbesWhenALightChanges) {
  EXPECT_THAT(dueAfter([](Snapshot& s) { s.lights.push_back({}); }), SizeIs(12));
}

TEST(OnChange, CapturesAllProbesWhenAnAreaLightChanges) {
  EXPECT_THAT(dueAfter([](Snapshot& s) { s.areaLights.push_back({}); }), SizeIs(12));
}

TEST(OnChange, CapturesAllProbesWhenScreensShowAnotherTime) {
  Snapshot snapshot = makeProbes(2);
  snapshot.screens.emplace_back();
  RefreshHistory history;
  advance(history, dueFaces(parseSpec("on-change"), history, snapshot), snapshot);
  EXPECT_THAT(dueFaces(parseSpec("on-change"), history, snapshot), IsEmpty());
  snapshot.timeSeconds += 0.5;
  EXPECT_THAT(dueFaces(parseSpec("on-change"), history, snapshot), SizeIs(12));
}

TEST(Advance, RecordsFramesOfCapturedFacesOnly) {
  const Snapshot snapshot = makeProbes(1);
  RefreshHistory history;
  advance(history, dueFaces(parseSpec("static"), history, snapshot), snapshot);
  advance(history, {{0, 4}}, snapshot);
  EXPECT_EQ(history.frame, 2);
  EXPECT_EQ(history.lastCapturedFrame[0], (std::array<std::int64_t, 6>{0, 0, 0, 0, 1, 0}));
}

TEST(RefreshPolicy, RefusesUnknownNamesAndParameters) {
  for (const char* bad : {"sometimes", "every-n?n=0", "every-n?n=x", "every-n?k=2", "faces?k=0", "static?n=1"})
    EXPECT_THROW(refreshPolicy(parseSpec(bad)), Error) << bad;
  EXPECT_EQ(refreshPolicy(parseSpec("every-n")).name, "every-n");
}

}  // namespace
}  // namespace pb
