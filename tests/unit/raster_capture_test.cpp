// Parts of cubes that are captured, captures blended over frames, resolution by distance, owners cut into parts.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "scenes/builtin/shapes.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

class RasterCapture : public RasterTest {};

INSTANTIATE_TEST_SUITE_P(Gl, RasterCapture, kBackends, nameOfBackend);

constexpr int kFace = 32;
constexpr int kTop = 2, kBottom = 3;
const vec3 kEnvironment(0.25f);
// Of the walls on the sides +X -X +Y -Y +Z -Z; below the probe half of it.
const std::array<vec3, 6> kColors = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}}};

// A closed room of 10 m around a mirror ball; the walls of the sides change their colour at the height of the probe.
Scene makeRoom() {
  Scene scene = makeEmptyScene(kEnvironment);
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.5f, 16, 8)), addMaterial(scene, makeMirrorMaterial("mirror")));
  for (int f = 0; f < 6; ++f) {
    const vec3 direction = shading::cubeFaceForward(f);
    const vec3 edges = vec3(11.0f) - 10.0f * glm::abs(direction);
    const vec3 color = kColors[static_cast<std::size_t>(f)];
    if (f == kTop || f == kBottom) {
      addBox(scene, 6.0f * direction, edges, makeUnlit(color));
      continue;
    }
    const vec3 up(0.0f, 2.75f, 0.0f), half(edges.x, 5.5f, edges.z);
    addBox(scene, 6.0f * direction + up, half, makeUnlit(color));
    addBox(scene, 6.0f * direction - up, half, makeUnlit(0.5f * color));
  }
  return scene;
}

bool isAll(const Image& image, int firstRow, int lastRow, const vec3& color) {
  for (int y = firstRow; y <= lastRow; ++y)
    for (int x = 0; x < image.width(); ++x)
      if (image(x, y) != color) return false;
  return true;
}

struct Captured {
  std::array<Image, 6> faces;
  FrameStats stats;
};

Captured captureRoom(RasterDevice& device, CapturedFaces captured, BounceOrder order = BounceOrder::sequential) {
  Technique technique = withResolution(kFace);
  technique.faces = captured;
  technique.bounceOrder = order;
  RasterSequence sequence(device, technique, 32, 32, 1);
  const FrameStats stats = sequence.renderFrame(*snapshotOf(makeRoom()));
  return {sequence.readProbe(0), stats};
}

TEST_P(RasterCapture, OfAllFaces_ShowsUpperAndLowerWallsOnUpperAndLowerRows) {
  const Captured room = captureRoom(device(), CapturedFaces::all);
  for (const int f : {0, 1, 4, 5}) {
    const vec3 color = kColors[static_cast<std::size_t>(f)];
    EXPECT_TRUE(isAll(room.faces[static_cast<std::size_t>(f)], 0, kFace / 2 - 1, color)) << f;
    EXPECT_TRUE(isAll(room.faces[static_cast<std::size_t>(f)], kFace / 2, kFace - 1, 0.5f * color)) << f;
  }
  EXPECT_EQ(room.stats.counters.facesCaptured, 6);
}

TEST_P(RasterCapture, WithoutTopAndBottom_ShowsTheEnvironmentThere) {
  for (const BounceOrder order : {BounceOrder::sequential, BounceOrder::simultaneous}) {
    const Captured room = captureRoom(device(), CapturedFaces::noTopBottom, order);
    const Captured all = captureRoom(device(), CapturedFaces::all, order);
    EXPECT_TRUE(isAll(room.faces[kTop], 0, kFace - 1, kEnvironment));
    EXPECT_TRUE(isAll(room.faces[kBottom], 0, kFace - 1, kEnvironment));
    for (const std::size_t f : {0u, 1u, 4u, 5u}) EXPECT_EQ(room.faces[f], all.faces[f]) << f;
    EXPECT_EQ(room.stats.counters.facesCaptured, 4);
    EXPECT_EQ(room.stats.faceAgeFrames.at(0), (std::array<std::int64_t, 6>{0, 0, -1, -1, 0, 0}));
  }
}

TEST_P(RasterCapture, OfTheTopHalf_ShowsTheEnvironmentBelowTheHorizon) {
  const Captured room = captureRoom(device(), CapturedFaces::topHalf);
  const Captured all = captureRoom(device(), CapturedFaces::all);
  EXPECT_EQ(room.faces[kTop], all.faces[kTop]);
  EXPECT_TRUE(isAll(room.faces[kBottom], 0, kFace - 1, kEnvironment));
  for (const int f : {0, 1, 4, 5}) {
    EXPECT_TRUE(isAll(room.faces[static_cast<std::size_t>(f)], 0, kFace / 2 - 1, kColors[static_cast<std::size_t>(f)]))
        << f;
    EXPECT_TRUE(isAll(room.faces[static_cast<std::size_t>(f)], kFace / 2, kFace - 1, kEnvironment)) << f;
  }
  EXPECT_EQ(room.stats.counters.facesCaptured, 5);
  EXPECT_LT(room.stats.counters.draws, all.stats.counters.draws) << "lower walls are not drawn";
}

TEST_P(RasterCapture, FacesThatAreNeverCaptured_FollowTheEnvironment) {
  Scene scene = makeRoom();
  scene.environmentChanges.push_back({1.0, makeConstantEnvironment(vec3(0.75f))});
  finishScene(scene);
  const auto shared = std::make_shared<const Scene>(std::move(scene));
  Technique technique = withResolution(kFace);
  technique.faces = CapturedFaces::noTopBottom;
  technique.refresh = parseSpec("static");
  RasterSequence sequence(device(), technique, 32, 32, 1);
  sequence.renderFrame(*makeSnapshot(shared, 0, "", 1.0));
  EXPECT_EQ(sequence.renderFrame(*makeSnapshot(shared, 30, "", 1.0)).counters.facesCaptured, 0);
  EXPECT_TRUE(isAll(sequence.readProbe(0)[kTop], 0, kFace - 1, vec3(0.75f)));
}

// A mirror ball before a black sky, with a white wall at +X that disappears.
struct Step {
  Snapshot before, after;
};
Step makeStep() {
  Scene scene = makeBall(kBlack, makeMirrorMaterial("mirror"));
  addBox(scene, vec3(6, 0, 0), vec3(1, 20, 20), makeUnlit(kWhite));
  Step step = {*snapshotOf(std::move(scene)), {}};
  step.after = step.before;
  step.after.instances[1].worldFromObject[3] += glm::vec4(0, -1000, 0, 0);
  for (glm::vec3* p : {&step.after.instances[1].worldBounds.lower, &step.after.instances[1].worldBounds.upper})
    p->y -= 1000.0f;
  return step;
}

Technique withHysteresis(float share) {
  Technique technique = withResolution(8);
  technique.hysteresis = share;
  return technique;
}

// After n frames of a step from 1 to 0 a map holds share^n: each is rounded to half floats, 11 bits, once a frame.
TEST_P(RasterCapture, WithHysteresis_AStepDecaysGeometrically) {
  const Step step = makeStep();
  for (const BounceOrder order : {BounceOrder::sequential, BounceOrder::simultaneous})
    for (const int bounces : {1, 3}) {
      Technique technique = withHysteresis(0.7f);
      technique.bounceOrder = order;
      technique.bounces = bounces;
      RasterSequence sequence(device(), technique, 16, 16, 1);
      sequence.renderFrame(step.before);
      EXPECT_EQ(centreOf(sequence.readProbe(0)[0]).x, 1.0f) << "the first capture is shown as it is";
      for (int n = 1; n <= 8; ++n) {
        sequence.renderFrame(step.after);
        const double expected = std::pow(0.7, n);
        EXPECT_NEAR(static_cast<double>(centreOf(sequence.readProbe(0)[0]).x), expected, expected * n / 2048.0)
            << n << " frames, " << bounces << " bounces";
      }
    }
}

TEST_P(RasterCapture, WithHysteresis_OnlyCapturesCount) {
  const Step step = makeStep();
  Technique technique = withHysteresis(0.5f);
  technique.refresh = parseSpec("every-n?n=2");
  RasterSequence sequence(device(), technique, 16, 16, 1);
  sequence.renderFrame(step.before);
  for (int n = 1; n <= 6; ++n) {
    sequence.renderFrame(step.after);
    EXPECT_EQ(centreOf(sequence.readProbe(0)[0]).x, std::exp2(-static_cast<float>(n / 2)));
  }
}

TEST_P(RasterCapture, WithHysteresis_AStillSceneLooksAsWithout) {
  const auto snapshot = snapshotOf("mirrors?count=3");
  const auto imageAfterFrames = [&](float share) {
    Technique technique = withResolution(32);
    technique.hysteresis = share;
    technique.feedback = Feedback::sky;  // every frame is like the first
    RasterSequence sequence(device(), technique, 64, 36, 1);
    for (int f = 0; f < 3; ++f) sequence.renderFrame(*snapshot);
    return sequence.readImage();
  };
  // Half floats round the blend of two equal numbers by 2^-12 of them.
  EXPECT_LT(largestDifference(imageAfterFrames(0.0f), imageAfterFrames(0.5f)), 4.0f / 4096.0f);
}

// Two mirror cubes that are one mesh, of reflectance 1/2 under a white sky. In the capture around the one the other
// shows the sky at half of its radiance.
TEST_P(RasterCapture, OfSplitParts_ShowsTheOtherPart) {
  Mesh mesh = makeBoxMesh(vec3(1.0f));
  const Mesh second = mesh;
  for (const std::uint32_t index : second.indices) mesh.indices.push_back(index + 24);
  for (const vec3& p : second.positions) mesh.positions.push_back(p + vec3(3, 0, 0));
  mesh.normals.insert(mesh.normals.end(), second.normals.begin(), second.normals.end());
  mesh.tangents.insert(mesh.tangents.end(), second.tangents.begin(), second.tangents.end());
  for (std::size_t set = 0; set < mesh.uvs.size(); ++set)
    mesh.uvs[set].insert(mesh.uvs[set].end(), second.uvs[set].begin(), second.uvs[set].end());
  Scene scene = makeEmptyScene(kWhite);
  addInstance(scene, "cubes", finishMesh(std::move(mesh)),
              addMaterial(scene, makeMirrorMaterial("mirror", vec3(0.5f))));
  const auto snapshot = snapshotOf(std::move(scene));
  Technique technique = withResolution(kFace);
  technique.feedback = Feedback::sky;
  technique.bounceOrder = BounceOrder::simultaneous;
  technique.selfReflection = SelfReflection::splitParts;
  RasterSequence split(device(), technique, 32, 32, 1);
  EXPECT_EQ(split.renderFrame(*snapshot).counters.facesCaptured, 12);
  EXPECT_NEAR(centreOf(split.readProbe(0)[0]).x, 0.5f, 1e-3f);
  EXPECT_EQ(centreOf(split.readProbe(0)[1]), kWhite);
  EXPECT_NEAR(centreOf(split.readProbe(1)[1]).x, 0.5f, 1e-3f);
  // Ids are those of the whole object, and the sequence goes on with its parts.
  technique.selfReflection = SelfReflection::none;
  RasterSequence whole(device(), technique, 32, 32, 1);
  whole.renderFrame(*snapshot);
  EXPECT_EQ(centreOf(whole.readProbe(0)[0]), kWhite);
  const Image before = split.readImage();
  EXPECT_EQ(split.renderIds(*snapshot), whole.renderIds(*snapshot));
  split.renderFrame(*snapshot);
  EXPECT_EQ(split.readImage(), before);
}

// The box around a ball of 0.8 m has a diagonal of 2.77 m; from 3 m away, under 0.8 rad and in 64 pixels it is 70
// pixels across, ten times as far away 7.
Snapshot seenFromTenTimesAsFar(const Snapshot& snapshot) {
  Snapshot far = snapshot;
  far.camera.origin.z *= 10.0f;
  return far;
}

Technique byDistance(int most) {
  Technique technique = withResolution(most);
  technique.resolutionScale = ResolutionScale::distance;
  return technique;
}

TEST_P(RasterCapture, ByDistance_EqualsThatResolutionChosenByHand) {
  for (const float roughness : {0.0f, 0.4f})
    for (const ProbeFilter filter : {ProbeFilter::boxMips, ProbeFilter::ggxPrefiltered}) {
      Scene scene = makeBall(kBlack, makeMetalMaterial("metal", vec3(0.2f), vec3(3.0f), roughness));
      scene.nodes.back().probe.emplace();
      addBox(scene, vec3(0, 0, 4), vec3(2, 1, 1), makeUnlit(kRed));
      const Snapshot far = seenFromTenTimesAsFar(*snapshotOf(std::move(scene)));
      Technique scaled = byDistance(64), fixed = withResolution(8);
      scaled.filter = fixed.filter = filter;
      EXPECT_EQ(render(far, scaled), render(far, fixed)) << roughness;
    }
}

TEST_P(RasterCapture, ByDistance_AChangeOfResolutionMakesAllFacesDue) {
  const auto near = snapshotOf(makeRoom());
  const Snapshot far = seenFromTenTimesAsFar(*near);
  Technique technique = byDistance(64);
  technique.refresh = parseSpec("static");
  technique.faces = CapturedFaces::noTopBottom;
  RasterSequence sequence(device(), technique, 64, 64, 1);
  EXPECT_EQ(sequence.renderFrame(*near).counters.probeBytes, 6 * 64 * 64 * 8);
  const FrameCounters counters = sequence.renderFrame(far).counters;
  EXPECT_EQ(counters.facesCaptured, 4);
  EXPECT_EQ(counters.probeBytes, 6 * 8 * 8 * 8);
  EXPECT_EQ(sequence.readProbe(0)[0].width(), 8);
  EXPECT_TRUE(isAll(sequence.readProbe(0)[kTop], 0, 7, kEnvironment));
  EXPECT_EQ(sequence.renderFrame(far).counters.facesCaptured, 0);
  EXPECT_EQ(sequence.renderFrame(*near).counters.facesCaptured, 4);
}

// What a map shows is scaled with it: the second mirror's capture shows the first one's map of the frame before.
TEST_P(RasterCapture, ByDistance_MapsKeepWhatTheyShowUntilTheyAreCaptured) {
  Scene scene = makeBall(kWhite, makeMirrorMaterial("mirror"));
  addBox(scene, vec3(0, 0, 20), vec3(1), makeMirrorMaterial("mirror"));
  const auto near = snapshotOf(std::move(scene));
  for (const auto format : {ProbeFormat::rgba16f, ProbeFormat::rgb9e5}) {
    Technique technique = byDistance(64);
    technique.bounceOrder = BounceOrder::simultaneous;
    technique.format = format;
    RasterSequence sequence(device(), technique, 64, 64, 1);
    sequence.renderFrame(*near);
    const Image before = sequence.readImage();
    sequence.renderFrame(seenFromTenTimesAsFar(*near));
    sequence.renderFrame(*near);
    EXPECT_LT(largestDifference(sequence.readImage(), before), 1e-2f) << "all is white";
  }
}

}  // namespace
}  // namespace pb
