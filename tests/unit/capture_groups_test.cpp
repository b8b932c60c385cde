// Which sequences of a scene are rendered together: groups, without rendering anything.
#include "bench/capture_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/builtin.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using testing::ElementsAre;

// One mirror among matte surfaces: its captures show no mirror. Counts the snapshots that are asked for.
class MirrorCube {
 public:
  CaptureGroups groups(const std::vector<Technique>& techniques, int last = 0) {
    return captureGroups(
        techniques, 0, last,
        [&](int) {
          ++asked_;
          return snapshot_;
        },
        64);
  }
  int asked() const { return asked_; }

 private:
  std::shared_ptr<const Snapshot> snapshot_ = snapshotOf("mirror-cube");
  int asked_ = 0;
};

Technique withLookup(const char* lookup, int resolution = 16, int bounces = 1) {
  Technique technique = withResolution(resolution);
  technique.lookup = parseSpec(lookup);
  technique.bounces = bounces;
  return technique;
}

TEST(CaptureGroups, OfNothingAndOfOne_AreThat) {
  MirrorCube cube;
  EXPECT_THAT(cube.groups({}), ElementsAre());
  EXPECT_THAT(cube.groups({withResolution(16)}), ElementsAre(ElementsAre(0)));
}

TEST(CaptureGroups, StandByTheirFirstMember_MembersInOrder) {
  MirrorCube cube;
  const std::vector<Technique> techniques = {withLookup("infinite"), withLookup("infinite", 32),
                                             withLookup("box-proxy"), withLookup("box-proxy", 32),
                                             withLookup("sphere-proxy")};
  EXPECT_THAT(cube.groups(techniques), ElementsAre(ElementsAre(0, 2, 4), ElementsAre(1, 3)));
}

// Captures that show no map are the same after any number of iterations.
TEST(CaptureGroups, OfSeveralBounces_AreOneWhereCapturesShowNoMap) {
  MirrorCube cube;
  EXPECT_THAT(
      cube.groups({withLookup("infinite", 16, 2), withLookup("box-proxy", 16, 1), withLookup("infinite", 16, 3)}),
      ElementsAre(ElementsAre(0, 1, 2)));
}

TEST(CaptureGroups, OfSeveralBounces_AreSeveralWhereCapturesShowMaps) {
  const auto mirrors = snapshotOf("mirrors?count=2");
  const auto groups = captureGroups(
      {withLookup("infinite", 16, 2), withLookup("infinite", 16, 1)}, 0, 0, [&](int) { return mirrors; }, 64);
  EXPECT_THAT(groups, ElementsAre(ElementsAre(0), ElementsAre(1)));
}

// 2 kMostInGroup + 1 equal ones: two full groups and one of a single member.
TEST(CaptureGroups, HaveAMostNumberOfMembers) {
  MirrorCube cube;
  const CaptureGroups groups = cube.groups(std::vector<Technique>(2 * kMostInGroup + 1, withResolution(16)));
  ASSERT_EQ(groups.size(), 3u);
  std::size_t next = 0;
  for (const std::size_t size : {kMostInGroup, kMostInGroup, std::size_t{1}})
    for (std::size_t i = 0; i < size; ++i, ++next) EXPECT_EQ(groups[next / kMostInGroup].at(i), next);
}

// Frames are looked at only for techniques that may have company.
TEST(CaptureGroups, OfTechniquesThatNeverShare_LookAtNoFrames) {
  MirrorCube cube;
  EXPECT_THAT(cube.groups({withResolution(16), withResolution(32), withResolution(64)}, 99),
              ElementsAre(ElementsAre(0), ElementsAre(1), ElementsAre(2)));
  EXPECT_EQ(cube.asked(), 1) << "for the scene";
}

// Static and every-frame capture the same in the first frame, and not in the second one.
TEST(CaptureGroups, OfPoliciesThatDifferLater_EndWithTheFirstFrame) {
  Technique once = withResolution(16);
  once.refresh = Spec{"static", {}};
  MirrorCube cube;
  EXPECT_THAT(cube.groups({withResolution(16), once}, 0), ElementsAre(ElementsAre(0, 1)));
  EXPECT_THAT(cube.groups({withResolution(16), once}, 1), ElementsAre(ElementsAre(0), ElementsAre(1)));
}

// A planar lookup mirrors the view: it captures alone, whoever stands beside it.
TEST(CaptureGroups, OfPlanarLookups_AreOfOneMember) {
  MirrorCube cube;
  EXPECT_THAT(
      cube.groups({withLookup("planar"), withLookup("infinite"), withLookup("planar"), withLookup("box-proxy")}),
      ElementsAre(ElementsAre(0), ElementsAre(1, 3), ElementsAre(2)));
}

}  // namespace
}  // namespace pb
