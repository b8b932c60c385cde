// Refresh policies choose (probe, face) pairs from the history alone.
#include "raster/refresh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "scenes/environment.h"
#include "scenes/error.h"

namespace pb {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

// Moves an instance and the probe that it owns.
void place(Snapshot& snapshot, std::size_t instance, const glm::vec3& position) {
  SnapshotInstance& placed = snapshot.instances[instance];
  placed.worldFromObject = glm::translate(glm::mat4(1.0f), position);
  placed.worldBounds = transformed(placed.mesh->bounds, placed.worldFromObject);
  if (placed.probe >= 0) snapshot.probes[static_cast<std::size_t>(placed.probe)].position = position;
}

// `count` probes 1 m apart along X, each owned by an instance of 0.5 m; one more instance, behind the last one, owns
// none. The camera looks at them along -Z from a distance of 4 m.
Snapshot makeProbes(int count) {
  auto scene = std::make_shared<Scene>();
  scene->materials.push_back(makeMirrorMaterial("mirror"));
  scene->materials.push_back(makeDiffuseMaterial("matte", glm::vec3(0.5f)));
  scene->environment = makeConstantEnvironment(glm::vec3(1.0f));
  auto mesh = std::make_shared<Mesh>();
  mesh->bounds = {glm::vec3(-0.25f), glm::vec3(0.25f)};
  Snapshot snapshot;
  snapshot.scene = scene;
  for (int i = 0; i <= count; ++i) {
    SnapshotInstance& instance = snapshot.instances.emplace_back();
    instance.mesh = mesh;
    instance.material = i < count ? 0 : 1;
    instance.probe = i < count ? i : -1;
    if (i < count) snapshot.probes.push_back({{}, {i}, 0.01f});
    place(snapshot, static_cast<std::size_t>(i), {static_cast<float>(i), 0.0f, 0.0f});
  }
  snapshot.camera = cubeFaceView({0.0f, 0.0f, 4.0f}, 5, 0.1f);
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
  Snapshot snapshot = makeProbes(2);
  snapshot.camera = cubeFaceView({0.0f, 0.0f, 4.0f}, 4, 0.1f);  // looks away: all owners are alike
  const Spec spec = parseSpec(GetParam());
  const int cycle = refreshPolicy(spec).cycle(spec, 12);
  const auto captures = capturesOf(GetParam(), snapshot, 2 * cycle + 1);
  for (std::size_t f = 1; f <= static_cast<std::size_t>(cycle); ++f)
    EXPECT_EQ(captures[f], captures[f + static_cast<std::size_t>(cycle)]) << "frame " << f;
}

// All of the table as they are without parameters, and with some.
std::vector<std::string> policiesToTest() {
  std::vector<std::string> policies = {
      "every-n?n=3",   "faces?k=5", "faces?k=100", "every-n?n=3&together=1", "distance-scaled?near=0.5&longest=8",
      "budget?faces=5"};
  for (const RefreshPolicy& policy : refreshPolicies()) policies.push_back(policy.name);
  return policies;
}

INSTANTIATE_TEST_SUITE_P(Refresh, EveryPolicy, testing::ValuesIn(policiesToTest()));

TEST(EveryFrame, CapturesEverythingAlways) {
  for (const auto& faces : capturesOf("every-frame", makeProbes(2), 3)) EXPECT_THAT(faces, SizeIs(12));
}

TEST_P(EveryPolicy, NeverCapturesWhatTheTechniqueLeavesOut) {
  const Snapshot snapshot = makeProbes(2);
  for (const CapturedFaces kept : {CapturedFaces::noTopBottom, CapturedFaces::topHalf}) {
    RefreshHistory history;
    history.technique.faces = kept;
    for (int f = 0; f < 9; ++f) {
      const std::vector<ProbeFace> due = dueFaces(parseSpec(GetParam()), history, snapshot);
      if (f == 0) {
        EXPECT_THAT(due, SizeIs(kept == CapturedFaces::topHalf ? 10 : 8));
      }
      EXPECT_EQ(std::ranges::count(due, 3, &ProbeFace::face), 0);
      if (kept == CapturedFaces::noTopBottom) {
        EXPECT_EQ(std::ranges::count(due, 2, &ProbeFace::face), 0);
      }
      advance(history, due, snapshot);
    }
  }
}

TEST(EveryN, CapturesOneProbeAfterTheOther) {
  const auto captures = capturesOf("every-n?n=3", makeProbes(2), 10);
  for (std::size_t f = 1; f < captures.size(); ++f)
    for (const int probe : {0, 1})
      EXPECT_EQ(std::ranges::count(captures[f], probe, &ProbeFace::probe),
                (static_cast<int>(f) + probe) % 3 == 0 ? 6 : 0)
          << f;
}

TEST(EveryN, Together_CapturesAllProbesInEveryNthFrame) {
  const auto captures = capturesOf("every-n?n=3&together=1", makeProbes(2), 7);
  for (std::size_t f = 0; f < captures.size(); ++f) EXPECT_THAT(captures[f], SizeIs(f % 3 == 0 ? 12 : 0)) << f;
}

TEST(Faces, DontSpendTheirTurnOnFacesThatAreNeverCaptured) {
  const Snapshot snapshot = makeProbes(1);
  RefreshHistory history;
  history.technique.faces = CapturedFaces::noTopBottom;
  std::vector<int> order;
  for (int f = 0; f < 6; ++f) {
    const std::vector<ProbeFace> due = dueFaces(parseSpec("faces?k=1"), history, snapshot);
    if (f > 0) order.push_back(due.at(0).face);
    advance(history, due, snapshot);
  }
  EXPECT_THAT(order, testing::ElementsAre(0, 1, 4, 5, 0));
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

// Faces that are due after `change` was made to captured probes.
template <class Change>
std::vector<ProbeFace> dueAfter(const Change& change, Snapshot snapshot = makeProbes(2),
                                const Technique& technique = {}) {
  RefreshHistory history;
  history.technique = technique;
  advance(history, dueFaces(parseSpec("on-change"), history, snapshot), snapshot);
  change(snapshot);
  return dueFaces(parseSpec("on-change"), history, snapshot);
}

glm::mat4 turned(const glm::mat4& matrix) { return glm::rotate(matrix, 0.5f, glm::vec3(0.0f, 1.0f, 0.0f)); }

constexpr int kPlusX = 0, kMinusX = 1, kPlusY = 2, kPlusZ = 4;

TEST(OnChange, CapturesTheFacesThatSeeWhatHasMoved) {
  // One probe at the origin, the other instance at x = 1.
  EXPECT_THAT(dueAfter(
                  [](Snapshot& s) {
                    place(s, 1, {2.0f, 0.1f, 0.0f});
                  },
                  makeProbes(1)),
              testing::ElementsAre(ProbeFace{0, kPlusX}));
}

TEST(OnChange, CapturesTheFacesThatSawWhatHasLeft) {
  EXPECT_THAT(dueAfter(
                  [](Snapshot& s) {
                    place(s, 1, {0.0f, 0.0f, 5.0f});
                  },
                  makeProbes(1)),
              testing::ElementsAre(ProbeFace{0, kPlusX}, ProbeFace{0, kPlusZ}));
}

TEST(OnChange, LooksBeyondNoFarPlane) {
  const auto moveFarAway = [](Snapshot& s) { place(s, 1, {0.0f, 0.0f, 5.0f}); };
  Technique nearOnly;
  nearOnly.captureFar = 4.0f;
  EXPECT_THAT(dueAfter(moveFarAway, makeProbes(1), nearOnly), testing::ElementsAre(ProbeFace{0, kPlusX}));
}

TEST(OnChange, LooksAtTheCapturedHalfOfAFaceOnly) {
  const auto moveBelow = [](Snapshot& s) { place(s, 1, {2.0f, -0.4f, 0.0f}); };
  Snapshot below = makeProbes(1);
  place(below, 1, {1.5f, -0.4f, 0.0f});
  EXPECT_THAT(dueAfter(moveBelow, below), testing::ElementsAre(ProbeFace{0, kPlusX}));
  Technique topHalf;
  topHalf.faces = CapturedFaces::topHalf;
  EXPECT_THAT(dueAfter(moveBelow, below, topHalf), IsEmpty());
}

TEST(OnChange, CapturesTheFacesThatSeeAMirrorWhoseMapChanges) {
  // Three in a row: the first sees the second at +X, the second sees what moves at +Y, and so does no face of the
  // first.
  Snapshot snapshot = makeProbes(2);
  place(snapshot, 2, {1.0f, 2.0f, 0.0f});
  const std::vector<ProbeFace> due = dueAfter([](Snapshot& s) { place(s, 2, {1.1f, 2.5f, 0.0f}); }, snapshot);
  EXPECT_THAT(due, testing::Contains(ProbeFace{1, kPlusY}));
  EXPECT_THAT(due, testing::Contains(ProbeFace{0, kPlusX}));
  EXPECT_THAT(due, testing::Contains(ProbeFace{1, kMinusX})) << "which shows the first one's map again";
  EXPECT_THAT(due, testing::Not(testing::Contains(ProbeFace{0, kPlusZ})));
}

// Two probes 10 m apart, and a mirror without one: the first is nearer, the second sees the mirror at +Z and the first
// one's owner at -X. What moves above is seen at +Y by both.
Snapshot makeMirrorWithoutProbe() {
  Snapshot snapshot = makeProbes(2);
  snapshot.instances.push_back(snapshot.instances[0]);
  snapshot.instances[3].probe = -1;
  place(snapshot, 1, {10.0f, 0.0f, 0.0f});
  place(snapshot, 2, {0.0f, 20.0f, 0.0f});
  place(snapshot, 3, {4.0f, 0.0f, 8.0f});
  findNearestProbes(snapshot);
  return snapshot;
}

TEST(OnChange, CapturesTheFacesThatSeeAMirrorWithoutProbeIfItShowsAMapThatChanges) {
  const Snapshot snapshot = makeMirrorWithoutProbe();
  const auto moveAbove = [](Snapshot& s) { place(s, 2, {0.0f, 21.0f, 0.0f}); };
  const auto dueWith = [&](WithoutProbe shown) {
    Technique technique;
    technique.withoutProbe = shown;
    return dueAfter(moveAbove, snapshot, technique);
  };
  EXPECT_THAT(dueWith(WithoutProbe::environment), testing::Not(testing::Contains(ProbeFace{1, kPlusZ})));
  EXPECT_THAT(dueWith(WithoutProbe::nearestProbe), testing::Contains(ProbeFace{1, kPlusZ}));
  EXPECT_THAT(dueWith(WithoutProbe::blendedProbes), testing::Contains(ProbeFace{1, kPlusZ}));
}

TEST(OnChange, CapturesTheFacesThatSeeAMirrorWhoseNearestProbeBecomesAnother) {
  const Snapshot snapshot = makeMirrorWithoutProbe();
  const auto moveFirst = [](Snapshot& s) {
    s.probes[0].position = {-100.0f, 0.0f, 0.0f};
    findNearestProbes(s);
  };
  Technique technique;
  technique.captureFar = 9.5f;  // the second probe sees the mirror, 7.75 m away, but not the first one's owner
  EXPECT_EQ(std::ranges::count(dueAfter(moveFirst, snapshot, technique), 1, &ProbeFace::probe), 0);
  technique.withoutProbe = WithoutProbe::nearestProbe;
  EXPECT_THAT(dueAfter(moveFirst, snapshot, technique), testing::Contains(ProbeFace{1, kPlusZ}));
}

TEST(OnChange, DoesNotCaptureAProbeWhoseOwnerTurnsOnTheSpot) {
  const auto turnOwner = [](Snapshot& s) { s.instances[0].worldFromObject = turned(s.instances[0].worldFromObject); };
  EXPECT_THAT(dueAfter(turnOwner, makeProbes(1)), IsEmpty());
  EXPECT_THAT(dueAfter(turnOwner), testing::Contains(ProbeFace{1, kMinusX})) << "the other probe sees the owner";
}

TEST(OnChange, CapturesAProbeThatMoves) {
  const std::vector<ProbeFace> due = dueAfter([](Snapshot& s) { s.probes[0].position.y += 1.0f; });
  EXPECT_EQ(std::ranges::count(due, 0, &ProbeFace::probe), 6);
  EXPECT_THAT(due, testing::Contains(ProbeFace{1, kMinusX})) << "the other probe sees its map";
}

TEST(OnChange, CapturesAllProbesWhenALightChanges) {
  EXPECT_THAT(dueAfter([](Snapshot& s) { s.lights.push_back({}); }), SizeIs(12));
}

TEST(OnChange, CapturesAllProbesWhenAnAreaLightChanges) {
  EXPECT_THAT(dueAfter([](Snapshot& s) { s.areaLights.push_back({}); }), SizeIs(12));
}

TEST(OnChange, CapturesAllFacesWhenSomethingMovesThatMayThrowShadows) {
  Snapshot snapshot = makeProbes(1);
  auto scene = std::make_shared<Scene>(*snapshot.scene);
  scene->castsShadows = true;
  snapshot.scene = scene;
  snapshot.lights.emplace_back();
  EXPECT_THAT(dueAfter([](Snapshot& s) { place(s, 1, {2.0f, 0.0f, 0.0f}); }, snapshot), SizeIs(6));
}

TEST(OnChange, CapturesTheFacesThatSeeAScreenWhenItsTimeChanges) {
  Snapshot snapshot = makeProbes(1);
  auto scene = std::make_shared<Scene>(*snapshot.scene);
  scene->materials[1].screen = 0;
  snapshot.scene = scene;
  snapshot.screens.emplace_back();
  EXPECT_THAT(dueAfter([](Snapshot&) {}, snapshot), IsEmpty());
  EXPECT_THAT(dueAfter([](Snapshot& s) { s.timeSeconds += 0.5; }, snapshot),
              testing::ElementsAre(ProbeFace{0, kPlusX}));
}

TEST(OnChange, CapturesNothingWhileNothingMoves) {
  const auto captures = capturesOf("on-change", makeProbes(2), 4);
  for (std::size_t f = 1; f < captures.size(); ++f) EXPECT_THAT(captures[f], IsEmpty());
}

// Frames of 64 in which a probe of 0.5 m (0.866 m across its diagonal) is captured `distance` from the camera.
int capturesAtDistance(float distance) {
  Snapshot snapshot = makeProbes(1);
  snapshot.camera = cubeFaceView({0.0f, 0.0f, distance}, 5, 0.1f);
  const auto captures = capturesOf("distance-scaled?near=2&longest=16", snapshot, 65);
  return static_cast<int>(
      std::count_if(captures.begin() + 1, captures.end(), [](const auto& c) { return !c.empty(); }));
}

TEST(DistanceScaled, HalvesTheRateWithEachDoublingOfTheDistance) {
  const float near = 2.0f * std::sqrt(0.75f);
  EXPECT_EQ(capturesAtDistance(0.5f * near), 64);
  EXPECT_EQ(capturesAtDistance(0.99f * near), 64);
  EXPECT_EQ(capturesAtDistance(1.01f * near), 32);
  EXPECT_EQ(capturesAtDistance(2.01f * near), 16);
  EXPECT_EQ(capturesAtDistance(4.01f * near), 8);
  EXPECT_EQ(capturesAtDistance(100.0f * near), 4) << "longest";
}

TEST(CameraVisible, CapturesWhatTheCameraSeesAsSoonAsItDoes) {
  Snapshot snapshot = makeProbes(2);
  snapshot.camera = cubeFaceView({0.0f, 0.0f, 0.3f}, 5, 0.01f);  // x = 1 is out of its 90 degrees
  RefreshHistory history;
  advance(history, dueFaces(parseSpec("camera-visible"), history, snapshot), snapshot);
  std::vector<ProbeFace> due = dueFaces(parseSpec("camera-visible"), history, snapshot);
  EXPECT_EQ(std::ranges::count(due, 0, &ProbeFace::probe), 6);
  EXPECT_EQ(std::ranges::count(due, 1, &ProbeFace::probe), 0);
  snapshot.camera = cubeFaceView({1.0f, 0.0f, 2.0f}, 5, 0.1f);
  EXPECT_THAT(dueFaces(parseSpec("camera-visible"), history, snapshot), SizeIs(12));
}

TEST(CameraVisible, CapturesTheProbeThatAMirrorWithoutOneShows) {
  Snapshot snapshot = makeMirrorWithoutProbe();
  snapshot.camera = cubeFaceView({4.0f, 0.0f, 10.0f}, 5, 0.1f);  // the mirror hides everything else
  snapshot.camera.right *= 0.05f;
  snapshot.camera.down *= 0.05f;
  const auto capturedInLaterFrames = [&](WithoutProbe shown) {
    RefreshHistory history;
    history.technique.withoutProbe = shown;
    const Spec policy = parseSpec("camera-visible");
    advance(history, dueFaces(policy, history, snapshot), snapshot);
    return dueFaces(policy, history, snapshot);
  };
  EXPECT_THAT(capturedInLaterFrames(WithoutProbe::environment), IsEmpty());
  const std::vector<ProbeFace> due = capturedInLaterFrames(WithoutProbe::nearestProbe);
  EXPECT_EQ(std::ranges::count(due, 0, &ProbeFace::probe), 6);
  EXPECT_THAT(due, SizeIs(6));
}

TEST(CameraVisible, CapturesTheProbeNearestToACoatInView) {
  Snapshot snapshot = makeProbes(1);
  auto scene = std::make_shared<Scene>(*snapshot.scene);
  scene->materials[1].constants.kind.x = shading::kSurfaceGlossy;
  snapshot.scene = scene;
  snapshot.instances[1].nearestProbe = 0;
  snapshot.camera = cubeFaceView({5.0f, 0.0f, 0.0f}, 0, 0.1f);  // looks away from both
  RefreshHistory history;
  advance(history, dueFaces(parseSpec("camera-visible"), history, snapshot), snapshot);
  EXPECT_THAT(dueFaces(parseSpec("camera-visible"), history, snapshot), IsEmpty());
  place(snapshot, 1, {7.0f, 0.0f, 0.0f});
  EXPECT_THAT(dueFaces(parseSpec("camera-visible"), history, snapshot), SizeIs(6));
}

// Runs the budget over a scene that `change` changes before each frame; the ages of faces at their captures.
template <class Change>
std::map<std::pair<int, int>, std::vector<std::int64_t>> agesUnderBudget(const std::string& policy, Snapshot snapshot,
                                                                         int frames, const Change& change) {
  std::map<std::pair<int, int>, std::vector<std::int64_t>> ages;
  RefreshHistory history;
  for (int frame = 0; frame < frames; ++frame) {
    change(snapshot, frame);
    const std::vector<ProbeFace> due = dueFaces(parseSpec(policy), history, snapshot);
    for (const ProbeFace& f : due)
      if (frame > 0)
        ages[{f.probe, f.face}].push_back(
            frame - history.lastCapturedFrame[static_cast<std::size_t>(f.probe)][static_cast<std::size_t>(f.face)]);
    advance(history, due, snapshot);
  }
  return ages;
}

TEST(Budget, CapturesThatManyFacesAFrame) {
  const auto captures = capturesOf("budget?faces=5", makeProbes(3), 20);
  for (std::size_t f = 1; f < captures.size(); ++f) EXPECT_THAT(captures[f], SizeIs(5));
}

// K = 5 rounds of ceil(36 / 5) = 8 frames. Everything is made as unfair as can be: one large probe before the camera
// whose surroundings move in every frame, the others out of sight and in peace; then the tables turn.
TEST(Budget, CapturesEveryFaceAtLeastEveryFiveRounds) {
  constexpr int kRounds = 5, kRound = 8;
  const auto ages = agesUnderBudget("budget?faces=5", makeProbes(6), 600, [](Snapshot& s, int frame) {
    const float x = frame / 100 % 2 == 0 ? 0.0f : 5.0f;
    s.camera = cubeFaceView({x, 0.0f, 0.3f}, 5, 0.01f);
    place(s, 6, {x, 0.4f, 0.1f + 0.01f * static_cast<float>(frame % 7)});
  });
  ASSERT_THAT(ages, SizeIs(36));
  std::int64_t oldest = 0;
  for (const auto& [face, captured] : ages) oldest = std::max(oldest, *std::ranges::max_element(captured));
  EXPECT_LT(oldest, kRounds * kRound);
  EXPECT_GT(oldest, kRound) << "weights make a difference";
}

TEST(Budget, CapturesWhatMovesAndWhatIsLargeMoreOften) {
  Snapshot snapshot = makeProbes(3);
  snapshot.camera = cubeFaceView({0.0f, 0.0f, 1.0f}, 5, 0.1f);  // before probe 0; probe 2 is out of sight
  const auto ages = agesUnderBudget("budget?faces=3", snapshot, 300, [](Snapshot& s, int frame) {
    place(s, 3, {0.0f, 1.0f + 0.01f * static_cast<float>(frame % 7), 0.0f});
  });
  const auto captures = [&](int probe, int face) { return ages.at({probe, face}).size(); };
  EXPECT_GT(captures(0, kPlusY), 2 * captures(0, kPlusZ)) << "it moves over probe 0";
  EXPECT_GT(captures(0, kPlusZ), 2 * captures(2, kPlusZ)) << "probe 0 is large in the picture";
}

TEST(Budget, CapturesProbesThatMoveMoreOften) {
  Snapshot snapshot = makeProbes(3);
  snapshot.camera = cubeFaceView({0.0f, 0.0f, 4.0f}, 4, 0.1f);  // looks away
  const auto ages = agesUnderBudget("budget?faces=3", snapshot, 300, [](Snapshot& s, int frame) {
    place(s, 0, {0.0f, 0.01f * static_cast<float>(frame % 7), 0.0f});
  });
  EXPECT_GT(ages.at({0, kPlusZ}).size(), 2 * ages.at({2, kPlusZ}).size());
}

TEST(Budget, IsRoundRobinWhileNothingMovesAndAllAreAlike) {
  Snapshot snapshot = makeProbes(2);
  snapshot.camera = cubeFaceView({0.0f, 0.0f, 4.0f}, 4, 0.1f);  // looks away
  const auto ages = agesUnderBudget("budget?faces=5", snapshot, 61, [](Snapshot&, int) {});
  for (const auto& [face, captured] : ages) EXPECT_THAT(captured, SizeIs(25)) << face.first << ' ' << face.second;
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
  for (const char* bad :
       {"sometimes", "every-n?n=0", "every-n?n=x", "every-n?k=2", "faces?k=0", "static?n=1", "every-n?together=2",
        "budget?faces=0", "budget?k=1", "distance-scaled?near=0", "distance-scaled?longest=0", "camera-visible?n=1"})
    EXPECT_THROW(refreshPolicy(parseSpec(bad)), Error) << bad;
  EXPECT_EQ(refreshPolicy(parseSpec("every-n")).name, "every-n");
}

}  // namespace
}  // namespace pb
