// What changes with time in the rasteriser: shapes of deforming meshes, and environments, on both GL backends.
#include <gtest/gtest.h>

#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

using RasterMotion = RasterTest;
INSTANTIATE_TEST_SUITE_P(Gl, RasterMotion, kBackends, nameOfBackend);

constexpr int kSize = 64;

Technique withRefresh(const std::string& policy) {
  Technique technique = withResolution(16);
  technique.refresh = parseSpec(policy);
  return technique;
}

Image rendered(RasterSequence& sequence, const Snapshot& snapshot) {
  sequence.renderFrame(snapshot);
  return sequence.readImage();
}

Image freshlyRendered(RasterDevice& device, const Snapshot& snapshot) {
  RasterSequence sequence(device, withResolution(16), kSize, kSize, 1);
  return rendered(sequence, snapshot);
}

// A red sheet before black, which waves, and a mirror ball behind the camera that sees it.
std::shared_ptr<const Scene> makeWavingScene() {
  Scene scene = makeEmptyScene(kBlack);
  Node node;
  node.translation = vec3(-0.8f, -0.5f, 0.0f);
  node.rotation = glm::angleAxis(0.6f, vec3(0, 1, 0));
  node.wave = Wave{.amplitude = 0.5f, .length = 1.6f, .wavelength = 1.0f, .skew = 0.3f, .periodSeconds = 1.0f};
  Material material = makeUnlit(kRed);
  material.doubleSided = true;
  Mesh sheet;
  for (int i = 0; i <= 20; ++i)
    for (const float y : {0.0f, 1.0f}) {
      sheet.positions.emplace_back(0.08f * static_cast<float>(i), y, 0.0f);
      sheet.normals.emplace_back(0, 0, 1);
    }
  for (std::uint32_t i = 0; i < 40; i += 2)
    sheet.indices.insert(sheet.indices.end(), {i, i + 2, i + 1, i + 1, i + 2, i + 3});
  addInstance(scene, "sheet", finishMesh(std::move(sheet)), addMaterial(scene, material), node);
  Node ball;
  ball.translation = vec3(0.7f, 0.6f, 0.5f);
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.3f, 32, 16)), addMaterial(scene, makeMirrorMaterial("mirror")),
              ball);
  finishScene(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

TEST_P(RasterMotion, ShowsTheShapeOfTheSnapshotsTime) {
  const auto scene = makeWavingScene();
  const auto first = makeSnapshot(scene, 0, "", 1.0), later = makeSnapshot(scene, 10, "", 1.0);
  const Image expectedFirst = freshlyRendered(device(), *first), expectedLater = freshlyRendered(device(), *later);
  ASSERT_GT(largestDifference(expectedFirst, expectedLater), 0.5f);
  RasterSequence sequence(device(), withResolution(16), kSize, kSize, 1),
      other(device(), withResolution(16), kSize, kSize, 1);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(largestDifference(rendered(sequence, *first), expectedFirst), 0.0f);
    EXPECT_EQ(largestDifference(rendered(other, *later), expectedLater), 0.0f);  // shares the device's buffers
    EXPECT_EQ(largestDifference(rendered(sequence, *later), expectedLater), 0.0f);
  }
  EXPECT_EQ(sequence.renderIds(*first), other.renderIds(*first));
  EXPECT_NE(sequence.renderIds(*first), other.renderIds(*later));
}

TEST_P(RasterMotion, OnChange_CapturesAgainWhenAShapeChanged) {
  const auto scene = makeWavingScene();
  RasterSequence sequence(device(), withRefresh("on-change"), kSize, kSize, 1);
  EXPECT_EQ(sequence.renderFrame(*makeSnapshot(scene, 0, "", 1.0)).counters.facesCaptured, 6);
  EXPECT_GT(sequence.renderFrame(*makeSnapshot(scene, 1, "", 1.0)).counters.facesCaptured, 0);
  EXPECT_EQ(sequence.renderFrame(*makeSnapshot(scene, 1, "", 1.0)).counters.facesCaptured, 0);
}

// A mirror ball in an environment that turns from black to white, and the same from a gradient to a cube map.
std::shared_ptr<const Scene> makeSwitchingScene(Environment later) {
  Scene scene = makeBall(kBlack, makeMirrorMaterial("mirror"));
  scene.environmentChanges.push_back({1.0, std::move(later)});
  finishScene(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

class RasterSky : public RasterTest {
 protected:
  // What the middle of the ball and the corner of the image show before and after the switch.
  struct Seen {
    float ball, sky;
  };
  std::pair<Seen, Seen> seen(const std::string& policy, Environment later) {
    const auto scene = makeSwitchingScene(std::move(later));
    RasterSequence sequence(device(), withRefresh(policy), kSize, kSize, 1);
    const auto look = [&](int frame) {
      const Image image = rendered(sequence, *makeSnapshot(scene, frame, "", 1.0));
      return Seen{centreOf(image).x, image(0, 0).x};
    };
    const Seen before = look(29);
    return {before, look(30)};
  }
};
INSTANTIATE_TEST_SUITE_P(Gl, RasterSky, kBackends, nameOfBackend);

TEST_P(RasterSky, AfterASwitch_IsStillTheOldOneInStaticProbes) {
  const auto [before, after] = seen("static", makeConstantEnvironment(kWhite));
  EXPECT_EQ(before.ball, 0.0f);
  EXPECT_EQ(before.sky, 0.0f);
  EXPECT_EQ(after.ball, 0.0f);
  EXPECT_EQ(after.sky, 1.0f);
}

TEST_P(RasterSky, AfterASwitch_IsTheNewOneInProbesThatAreCapturedAgain) {
  for (const char* policy : {"every-frame", "on-change"}) {
    const auto [before, after] = seen(policy, makeConstantEnvironment(kWhite));
    EXPECT_EQ(before.ball, 0.0f) << policy;
    EXPECT_EQ(after.ball, 1.0f) << policy;
  }
}

TEST_P(RasterSky, SwitchedFromAGradientToACubeMap_IsThatCubeMap) {
  const std::vector<ImageRgba> faces(6, ImageRgba(4, 4, glm::vec4(0.25f, 0.5f, 0.75f, 1.0f)));
  const auto [before, after] = seen("every-frame", makeCubeEnvironment("faces", faces));
  EXPECT_EQ(before.sky, 0.0f);
  EXPECT_EQ(after.sky, 0.25f);
  EXPECT_EQ(after.ball, 0.25f);
}

// Environments of both times on one device: roughly lit by the filtered levels of the right one.
TEST_P(RasterSky, OfRoughMetals_IsFilteredForEachEnvironment) {
  Scene scene = makeBall(vec3(0.25f), makeMetalMaterial("metal", vec3(0.2f), vec3(3.0f), 0.5f));
  scene.environmentChanges.push_back({1.0, makeConstantEnvironment(vec3(0.5f))});
  finishScene(scene);
  const auto shared = std::make_shared<const Scene>(std::move(scene));
  Technique technique = withResolution(16);
  technique.filter = ProbeFilter::ggxPrefiltered;
  technique.probes = ProbeUse::environmentOnly;
  RasterSequence sequence(device(), technique, kSize, kSize, 1);
  const vec3 first = centreOf(rendered(sequence, *makeSnapshot(shared, 0, "", 1.0)));
  const vec3 second = centreOf(rendered(sequence, *makeSnapshot(shared, 30, "", 1.0)));
  const vec3 again = centreOf(rendered(sequence, *makeSnapshot(shared, 60, "", 1.0)));
  EXPECT_GT(first.x, 0.1f);
  EXPECT_NEAR(second.x, 2.0f * first.x, 1e-5f);
  EXPECT_EQ(first, again);
}

}  // namespace
}  // namespace pb
