// What probes capture, and when they are captured again.
#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "scenes/builtin/shapes.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

class RasterProbe : public RasterTest {};

INSTANTIATE_TEST_SUITE_P(Gl, RasterProbe, kBackends, nameOfBackend);

// Walls of six colours around a mirror ball at the origin, and a white marker before each wall.
struct Wall {
  vec3 direction;
  vec3 color;
  vec3 marker;  // in the direction whose face coordinates are s = 0.75, t = 0.25
};
// OpenGL 4.5 core, table 8.19: s = (sc / |ma| + 1) / 2, t likewise; e.g. on +X sc = -rz and tc = -ry, so s = 0.75 is
// rz = -0.5 and t = 0.25 is ry = 0.5.
const std::array<Wall, 6> kWalls = {{{{1, 0, 0}, {1, 0, 0}, {1, 0.5f, -0.5f}},
                                     {{-1, 0, 0}, {0, 1, 0}, {-1, 0.5f, 0.5f}},
                                     {{0, 1, 0}, {0, 0, 1}, {0.5f, 1, -0.5f}},
                                     {{0, -1, 0}, {1, 1, 0}, {0.5f, -1, 0.5f}},
                                     {{0, 0, 1}, {1, 0, 1}, {0.5f, 0.5f, 1}},
                                     {{0, 0, -1}, {0, 1, 1}, {-0.5f, 0.5f, -1}}}};
constexpr int kFace = 32;

Scene makeRoom() {
  Scene scene = makeEmptyScene(kBlack);
  Material mirror = makeMirrorMaterial("mirror");
  mirror.doubleSided = true;  // were it drawn in its own capture, it would hide everything
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.5f, 16, 8)), addMaterial(scene, mirror));
  for (const Wall& wall : kWalls) {
    addBox(scene, 6.0f * wall.direction, vec3(11.0f) - 10.0f * glm::abs(wall.direction), makeUnlit(wall.color));
    addBox(scene, 4.0f * wall.marker, vec3(0.4f), makeUnlit(kWhite));
  }
  return scene;
}

// `aspect` of the final image must not matter to captures.
std::array<Image, 6> captureRoom(RasterDevice& device, int width, int height) {
  const auto snapshot = snapshotOf(makeRoom(), static_cast<double>(width) / height);
  RasterSequence sequence(device, withResolution(kFace), width, height, 1);
  sequence.renderFrame(*snapshot);
  return sequence.readProbe(0);
}

TEST_P(RasterProbe, CubeFacesLieAsOpenGlReadsThem) {
  const std::array<Image, 6> faces = captureRoom(device(), 64, 64);
  for (std::size_t f = 0; f < 6; ++f) {
    EXPECT_EQ(centreOf(faces[f]), kWalls[f].color) << "face " << f;
    EXPECT_EQ(faces[f](3 * kFace / 4, kFace / 4), kWhite) << "face " << f;
    EXPECT_EQ(faces[f](kFace / 4, kFace / 4), kWalls[f].color) << "face " << f;
    EXPECT_EQ(faces[f](kFace / 4, 3 * kFace / 4), kWalls[f].color) << "face " << f;
    EXPECT_EQ(faces[f](3 * kFace / 4, 3 * kFace / 4), kWalls[f].color) << "face " << f;
  }
}

TEST_P(RasterProbe, CapturesAreSquareAndWholeWhateverTheImagesShape) {
  const std::array<Image, 6> square = captureRoom(device(), 64, 64);
  EXPECT_EQ(captureRoom(device(), 90, 10), square);
  // Walls end at 5.5 / 5.5 = 90 degrees: every texel was drawn, none shows the black environment.
  for (const Image& face : square)
    for (const vec3& texel : face) EXPECT_NE(texel, kBlack);
}

TEST_P(RasterProbe, ReflectionPointsWhereTheMirrorFaces) {
  // The middle of the ball's picture reflects straight back: the wall at +Z.
  EXPECT_EQ(centreOf(render(*snapshotOf(makeRoom()), withResolution(kFace), 65, 65)), kWalls[4].color);
}

TEST_P(RasterProbe, CapturesHaveDepth) {
  for (const bool nearFirst : {true, false}) {
    Scene scene = makeBall(kBlack, makeMirrorMaterial("mirror"));
    if (nearFirst) addBox(scene, vec3(2, 0, 0), vec3(0.5f), makeUnlit(kRed));
    addBox(scene, vec3(9, 0, 0), vec3(1, 9, 9), makeUnlit(kBlue));
    if (!nearFirst) addBox(scene, vec3(2, 0, 0), vec3(0.5f), makeUnlit(kRed));
    RasterSequence sequence(device(), withResolution(kFace), 16, 16, 1);
    sequence.renderFrame(*snapshotOf(std::move(scene)));
    const Image face = sequence.readProbe(0)[0];
    EXPECT_EQ(centreOf(face), kRed);
    EXPECT_EQ(face(kFace / 2, 10), kBlue);
  }
}

TEST_P(RasterProbe, RadianceBeyondHalfFloatIsCapturedAsTheLargestHalf) {
  RasterSequence sequence(device(), withResolution(8), 16, 16, 1);
  sequence.renderFrame(*snapshotOf(makeBall(vec3(1e6f), makeMirrorMaterial("mirror"))));
  EXPECT_EQ(centreOf(sequence.readProbe(0)[0]), vec3(65504.0f));
  EXPECT_EQ(sequence.readImage()(0, 0), vec3(1e6f)) << "the image itself is float";
}

TEST_P(RasterProbe, CullingDoesNotChangeThePicture) {
  const auto culled = snapshotOf("mirrors?count=3");
  Snapshot everything = *culled;
  for (SnapshotInstance& instance : everything.instances) instance.worldBounds = {vec3(-1e6f), vec3(1e6f)};
  RasterSequence a(device(), withResolution(32), 96, 54, 1), b(device(), withResolution(32), 96, 54, 1);
  const FrameStats culledStats = a.renderFrame(*culled), allStats = b.renderFrame(everything);
  EXPECT_EQ(a.readImage(), b.readImage());
  for (int probe = 0; probe < 3; ++probe) EXPECT_EQ(a.readProbe(probe), b.readProbe(probe));
  EXPECT_LT(culledStats.counters.draws, allStats.counters.draws);
}

TEST_P(RasterProbe, StaticEqualsEveryFrameWhileNothingMoves) {
  Technique everyFrame = withResolution(32), once = everyFrame;
  once.refresh = parseSpec("static");
  const auto snapshot = snapshotOf("teapot");
  RasterSequence a(device(), everyFrame, 64, 36, 1), b(device(), once, 64, 36, 1);
  for (int f = 0; f < 3; ++f) {
    a.renderFrame(*snapshot);
    const FrameStats stats = b.renderFrame(*snapshot);
    EXPECT_EQ(stats.counters.facesCaptured, f == 0 ? 6 : 0);
    EXPECT_EQ(stats.faceAgeFrames.at(0)[3], f);
    EXPECT_EQ(a.readImage(), b.readImage());
  }
}

TEST_P(RasterProbe, EveryFrameFollowsWhatMovesAndStaticDoesNot) {
  Technique everyFrame = withResolution(32), once = everyFrame;
  once.refresh = parseSpec("static");
  RasterSequence a(device(), everyFrame, 64, 36, 1), b(device(), once, 64, 36, 1), fresh(device(), once, 64, 36, 1);
  const auto scene = std::make_shared<const Scene>(makeBuiltinScene(parseSpec("teapot")));
  const auto first = makeSnapshot(scene, 0, "", 16.0 / 9.0), later = makeSnapshot(scene, 20, "", 16.0 / 9.0);
  for (RasterSequence* sequence : {&a, &b}) {
    sequence->renderFrame(*first);
    sequence->renderFrame(*later);
  }
  fresh.renderFrame(*later);
  EXPECT_EQ(a.readImage(), fresh.readImage());
  EXPECT_NE(b.readImage(), fresh.readImage());
}

}  // namespace
}  // namespace pb
