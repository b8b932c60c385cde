// Probes that are joined and part while a sequence runs: which map belongs to whom, on both GL backends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "raster/probe_layout.h"
#include "raster/probe_owners.h"
#include "raster/probe_resolution.h"
#include "raster/scheduled_faces.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;
using testing::Each;
using testing::ElementsAre;
using testing::SizeIs;

TEST(ProbeOwners, KeepTheirProbeAsLongAsNoneIsJoinedToThem) {
  const std::vector<std::vector<int>> apart = {{0}, {1}, {2}}, joined = {{0, 1}, {2}};
  EXPECT_THAT(probesBefore(apart, joined), ElementsAre(kNewProbe, 2));
  EXPECT_THAT(probesBefore(joined, apart), ElementsAre(kNewProbe, kNewProbe, 1));
  EXPECT_THAT(probesBefore(apart, apart), ElementsAre(0, 1, 2));
}

TEST(ProbeOwners, TakeAlongWhatIsKnownOfTheirProbe) {
  EXPECT_THAT(reordered(std::vector<int>{7, 8, 9}, {kNewProbe, 2}, 0), ElementsAre(0, 9));
  EXPECT_THAT(reordered(std::vector<int>{}, {1, kNewProbe}, 0), ElementsAre(0, 0)) << "nothing was known yet";
}

// Mirrors A, B and C 4 m apart, each before a wall of its own colour behind the camera. A goes to B until frame 30,
// nearer than 2 m from frame 22 on, and back until frame 60. B and C stand still, and C sees A and B on its side -X.
std::shared_ptr<const Scene> makeThreeMirrors() {
  Scene scene = makeEmptyScene(vec3(0.2f, 0.3f, 0.4f));
  const int mirror = addMaterial(scene, makeMirrorMaterial("mirror"));
  const auto mesh = finishMesh(makeBoxMesh(vec3(1.0f)));
  const std::array<vec3, 3> colors = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Track track;
  for (int i = 0; i < 3; ++i) {
    Node node;
    node.translation = vec3(4.0f * static_cast<float>(i - 1), 0.0f, 0.0f);
    if (i == 0) track.node = static_cast<int>(scene.nodes.size());
    addInstance(scene, "mirror", mesh, mirror, node);
    addBox(scene, node.translation + vec3(0, 0, 6.5f), vec3(3.6f, 3.6f, 0.2f),
           makeUnlit(colors[static_cast<std::size_t>(i)]));
  }
  track.timesSeconds = {0.0f, 1.0f, 2.0f};
  track.values = {{-4, 0, 0, 0}, {-1.2f, 0, 0, 0}, {-4, 0, 0, 0}};
  scene.tracks.push_back(track);
  finishScene(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

constexpr int kSize = 48, kApart = 0, kJoined = 27, kApartAgain = 58;

std::shared_ptr<const Snapshot> at(const std::shared_ptr<const Scene>& scene, int frame) {
  return makeSnapshot(scene, frame, "", 1.0);
}

Technique sharing(const char* refresh) {
  Technique technique = withResolution(32);
  technique.sharing = parseSpec("distance?metres=2");
  technique.refresh = parseSpec(refresh);
  return technique;
}

using RasterSharing = RasterTest;
INSTANTIATE_TEST_SUITE_P(Gl, RasterSharing, kBackends, nameOfBackend);

TEST_P(RasterSharing, WhoStandsStill_KeepsItsMapWhileOthersAreJoinedAndPart) {
  const auto scene = makeThreeMirrors();
  RasterSequence sequence(device(), sharing("static"), kSize, kSize, 1);
  sequence.renderFrame(*at(scene, kApart));
  const auto before = sequence.readProbe(2);
  EXPECT_NE(before, sequence.readProbe(1)) << "the maps can be told apart";

  const auto joined = sequence.renderFrame(*at(scene, kJoined)).faceAgeFrames;
  ASSERT_THAT(joined, SizeIs(2));
  EXPECT_THAT(joined[0], Each(0)) << "a new probe is captured at once";
  EXPECT_THAT(joined[1], Each(1));
  EXPECT_EQ(sequence.readProbe(1), before);

  const auto parted = sequence.renderFrame(*at(scene, kApartAgain)).faceAgeFrames;
  ASSERT_THAT(parted, SizeIs(3));
  EXPECT_THAT(parted[0], Each(0));
  EXPECT_THAT(parted[1], Each(0));
  EXPECT_THAT(parted[2], Each(2));
  EXPECT_EQ(sequence.readProbe(2), before);
}

// Its side +Z sees nothing that moves or reflects: any average of its own captures is the capture.
TEST_P(RasterSharing, WhoStandsStill_IsBlendedWithItsOwnHistory) {
  const auto scene = makeThreeMirrors();
  Technique technique = sharing("every-frame");
  technique.hysteresis = 0.5f;
  RasterSequence sequence(device(), technique, kSize, kSize, 1);
  sequence.renderFrame(*at(scene, kApart));
  const Image before = sequence.readProbe(2)[4];
  sequence.renderFrame(*at(scene, kJoined));
  EXPECT_EQ(sequence.readProbe(1)[4], before);
  sequence.renderFrame(*at(scene, kApartAgain));
  EXPECT_EQ(sequence.readProbe(2)[4], before);
}

// Captured anew in every frame from maps that show the sky, a frame shows nothing of those before.
TEST_P(RasterSharing, WithAllFacesInEveryFrame_IsWhatAFreshSequenceShows) {
  const auto scene = makeThreeMirrors();
  for (const Iterations iterations : {Iterations::bruteForce, Iterations::incremental})
    for (const Storage storage : {Storage::cube, Storage::octahedral})
      for (const ResolutionScale scale : {ResolutionScale::fixed, ResolutionScale::distance}) {
        Technique technique = sharing("every-frame");
        technique.feedback = Feedback::sky;
        technique.bounces = 3;
        technique.iterations = iterations;
        technique.storage = storage;
        technique.resolutionScale = scale;
        RasterSequence sequence(device(), technique, kSize, kSize, 1);
        for (const int frame : {kApart, kJoined, kApartAgain}) {
          sequence.renderFrame(*at(scene, frame));
          const Image expected = render(*at(scene, frame), technique, kSize, kSize);
          EXPECT_EQ(sequence.readImage(), expected) << "frame " << frame;
        }
      }
}

// --- Plans

using Ages = std::vector<std::array<std::int64_t, 6>>;

// FrameStats::faceAgeFrames by what ScheduledFaces says.
class PlannedAges {
 public:
  PlannedAges(const Technique& technique, int heightPx) : layout_(technique), schedule_(technique, heightPx) {}

  const Ages& advance(const Snapshot& given) {
    constexpr std::array<std::int64_t, 6> kNever = {-1, -1, -1, -1, -1, -1};
    const Snapshot& snapshot = layout_.apply(given);
    const std::vector<ProbeFace> due = schedule_.advance(snapshot);
    if (schedule_.probesBefore()) ages_ = reordered(std::move(ages_), *schedule_.probesBefore(), kNever);
    ages_.resize(snapshot.probes.size(), kNever);
    for (auto& probe : ages_)
      for (std::int64_t& age : probe) age += age < 0 ? 0 : 1;
    for (const ProbeFace& f : due) ages_[static_cast<std::size_t>(f.probe)][static_cast<std::size_t>(f.face)] = 0;
    return ages_;
  }

 private:
  ProbeLayout layout_;
  ScheduledFaces schedule_;
  Ages ages_;
};

constexpr std::array kFramesOfPlans = {0, 8, 15, 22, 27, 30, 40, 58};
constexpr int kSizeOfPlans = 16;  // A wants 8 texels at first, 16 near B

Technique planned(const std::string& refresh, ResolutionScale scale, const char* sharing) {
  Technique technique = withResolution(kSizeOfPlans);
  technique.refresh = parseSpec(refresh);
  technique.resolutionScale = scale;
  technique.sharing = parseSpec(sharing);
  return technique;
}

// Keys of captures and depths of bounces follow plans, and stand for what is rendered.
TEST_P(RasterSharing, FacesAreCapturedAsPlanned) {
  const auto scene = makeThreeMirrors();
  std::vector<std::string> policies = {"every-n?n=3", "every-n?n=3&together=1", "faces?k=5", "budget?faces=5",
                                       "distance-scaled?near=0.5&longest=8"};
  for (const RefreshPolicy& policy : refreshPolicies()) policies.push_back(policy.name);
  for (const std::string& policy : policies)
    for (const ResolutionScale scale : {ResolutionScale::fixed, ResolutionScale::distance})
      for (const char* sharing : {"none", "distance?metres=2", "count?probes=2"}) {
        const Technique technique = planned(policy, scale, sharing);
        RasterSequence sequence(device(), technique, kSizeOfPlans, kSizeOfPlans, 1);
        PlannedAges plan(technique, kSizeOfPlans);
        for (const int frame : kFramesOfPlans)
          EXPECT_EQ(sequence.renderFrame(*at(scene, frame)).faceAgeFrames, plan.advance(*at(scene, frame)))
              << policy << ", " << sharing << ", frame " << frame;
      }
}

TEST(PlansToTest, HaveProbesThatAreJoinedAndChangeTheirResolution) {
  const auto scene = makeThreeMirrors();
  std::set<std::vector<int>> resolutions;
  for (const char* sharing : {"none", "distance?metres=2"})
    for (const int frame : kFramesOfPlans) {
      const Technique technique = planned("static", ResolutionScale::distance, sharing);
      ProbeLayout layout(technique);
      resolutions.insert(probeResolutions(technique, layout.apply(*at(scene, frame)), kSizeOfPlans));
    }
  EXPECT_THAT(resolutions, testing::IsSupersetOf({std::vector{8, 16, 8}, std::vector{16, 16, 8}}));
  EXPECT_THAT(resolutions, testing::Contains(SizeIs(2)));
}

}  // namespace
}  // namespace pb
