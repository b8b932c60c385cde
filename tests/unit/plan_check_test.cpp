// What is refused of a whole suite before anything is rendered.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/plan_check.h"
#include "tests/error_message.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;
using testing::HasSubstr;

constexpr char kSuite[] = R"(
schema = 1
name = "small"
image = {{ size = [16, 16], samples = 1 }}
[[scene]]
use = "builtin:mirrors?count=2"
frames = {}
{}
)";

Suite suiteWith(const std::string& frames, const std::string& more = "") {
  return parseSuite(fmt::format(kSuite, frames, more), "test", "");
}

// A flat mirror of which a corner is bent forwards from frame 15 on.
std::shared_ptr<const Scene> makeFlap() {
  Scene scene = makeEmptyScene(kBlack);
  Mesh mesh = makeQuadMesh(vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0));
  mesh.targets.push_back({.positions = {vec3(0), vec3(0), vec3(0), vec3(0, 0, 0.5f)}, .normals = {}, .tangents = {}});
  Node node;
  node.morphWeights = {0.0f};
  addInstance(scene, "flap", finishMesh(std::move(mesh)), addMaterial(scene, makeMirrorMaterial("mirror")), node);
  Track track;
  track.node = scene.instances.front().node;
  track.target = TrackTarget::morphWeights;
  track.timesSeconds = {0.5f, 1.0f};
  track.weights = {0.0f, 1.0f};
  scene.tracks.push_back(track);
  finishScene(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

class PlanCheck : public RasterTest {
 protected:
  std::string messageOfCheck(const Suite& given, const std::shared_ptr<const Scene>& scene) {
    Suite suite = given;
    suite.scenes.front().camera = scene->cameras.front().name;
    return messageOf([&] { checkPlan(suite, {scene}, makePlan(suite), device()); });
  }
};
INSTANTIATE_TEST_SUITE_P(Gl, PlanCheck, testing::Values(GlBackend::egl), nameOfBackend);

TEST_P(PlanCheck, RefusesMirroredViewsOfAReflectorThatBendsInALaterFrame) {
  const std::string planar = "[grid]\nlookup = [\"infinite\", \"planar\"]";
  EXPECT_EQ(messageOfCheck(suiteWith("[0, 14]", planar), makeFlap()), "no error");
  EXPECT_THAT(messageOfCheck(suiteWith("[0, 20]", planar), makeFlap()), HasSubstr("'flap' is not flat"));
}

TEST_P(PlanCheck, RefusesOnePictureForSeveralFramesOfAnExternalTechnique) {
  const auto scene = makeFlap();
  const std::string external = "[[external]]\nname = \"saved\"\nimages = \"{}\"";
  EXPECT_THAT(messageOfCheck(suiteWith("[0, 1]", fmt::format(fmt::runtime(external), "a.exr")), scene),
              HasSubstr("external technique 'saved' has"));
  EXPECT_EQ(messageOfCheck(suiteWith("[0, 1]", fmt::format(fmt::runtime(external), "a{frame}.exr")), scene),
            "no error");
  EXPECT_EQ(messageOfCheck(suiteWith("1", fmt::format(fmt::runtime(external), "a.exr")), scene), "no error");
}

}  // namespace
}  // namespace pb
