// Maps of probes that are given instead of captured.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "raster/probe_views.h"
#include "tests/error_message.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;
using testing::HasSubstr;

class RasterGiven : public RasterTest {};

INSTANTIATE_TEST_SUITE_P(Gl, RasterGiven, kBackends, nameOfBackend);

constexpr int kFace = 32;
constexpr float kNothing = std::numeric_limits<float>::infinity();

Technique withGivenProbes(Technique technique = withResolution(kFace)) {
  technique.probes = ProbeUse::given;
  return technique;
}

std::array<Image, 6> uniformFaces(int size, const vec3& radiance) {
  std::array<Image, 6> faces;
  for (Image& face : faces) face = Image(size, size, radiance);
  return faces;
}

// A rough metal ball, which reads filtered levels, and a mirror beside a bright box.
Scene makeBallsAndBox() {
  Scene scene =
      makeBall({0.2f, 0.3f, 0.5f}, makeMetalMaterial("gold", {0.18f, 0.42f, 1.37f}, {3.42f, 2.35f, 1.77f}, 0.25f));
  Node node;
  node.translation = {1.2f, 0.4f, -0.5f};
  addInstance(scene, "mirror", finishMesh(makeSphereMesh(0.5f, 32, 16)),
              addMaterial(scene, makeMirrorMaterial("mirror")), node);
  addBox(scene, {-1.2f, 0.0f, 0.6f}, vec3(0.5f), makeUnlit({2.0f, 1.0f, 0.25f}));
  return scene;
}

struct Pictures {
  Image captured;
  Image given;
  FrameStats statsOfGiven;
};

// What a technique shows, and what it shows of the same maps given.
Pictures capturedAndGiven(RasterDevice& device, const Technique& technique, const Snapshot& snapshot) {
  RasterSequence capturing(device, technique, 64, 64, 1);
  RasterSequence showing(device, withGivenProbes(technique), 64, 64, 1);
  capturing.renderFrame(snapshot);
  const bool hasDistances = technique.lookup.name == "distance-impostor";
  for (int probe = 0; probe < static_cast<int>(snapshot.probes.size()); ++probe)
    showing.setProbe(probe, capturing.readProbe(probe),
                     hasDistances ? capturing.readProbeDistances(probe) : std::array<Plane, 6>{});
  const FrameStats stats = showing.renderFrame(snapshot);
  return {capturing.readImage(), showing.readImage(), stats};
}

TEST_P(RasterGiven, MapsThatWereCaptured_GiveTheSamePictureAndCaptureNothing) {
  const auto snapshot = snapshotOf(makeBallsAndBox());
  ASSERT_EQ(snapshot->probes.size(), 2u);
  for (const BounceOrder order : {BounceOrder::sequential, BounceOrder::simultaneous}) {
    Technique technique = withResolution(kFace);
    technique.bounceOrder = order;
    const Pictures pictures = capturedAndGiven(device(), technique, *snapshot);
    EXPECT_EQ(pictures.given, pictures.captured);
    EXPECT_EQ(pictures.statsOfGiven.counters.facesCaptured, 0);
    EXPECT_TRUE(pictures.statsOfGiven.faceAgeFrames.empty());
  }
}

TEST_P(RasterGiven, MapsThatWereCaptured_GiveTheSamePictureInEveryFormatAndStorage) {
  const auto snapshot = snapshotOf(makeBallsAndBox());
  const auto expectSame = [&](const Technique& technique) {
    const Pictures pictures = capturedAndGiven(device(), technique, *snapshot);
    EXPECT_EQ(pictures.given, pictures.captured);
  };
  for (const ProbeFormat format : {ProbeFormat::r11fG11fB10f, ProbeFormat::rgb9e5, ProbeFormat::rgba8Srgb}) {
    SCOPED_TRACE(static_cast<int>(format));
    Technique technique = withResolution(kFace);
    technique.format = format;
    expectSame(technique);
  }
  for (const Storage storage : {Storage::dualParaboloid, Storage::octahedral}) {
    SCOPED_TRACE(static_cast<int>(storage));
    Technique technique = withResolution(kFace);
    technique.storage = storage;
    technique.filter = ProbeFilter::none;
    expectSame(technique);
  }
}

// Distances d are kept as n / d and read back as n / (n / d), which rounds twice: by 1.2e-7 of d. The search in them
// ends within an interval of that order of where it ended, and a texel is 2 / 32 wide.
TEST_P(RasterGiven, MapsWithDistances_GiveTheSamePicture) {
  Technique technique = withResolution(kFace);
  technique.lookup = parseSpec("distance-impostor");
  const Pictures pictures = capturedAndGiven(device(), technique, *snapshotOf(makeBallsAndBox()));
  EXPECT_LT(largestDifference(pictures.given, pictures.captured), 1e-4f);
}

TEST_P(RasterGiven, Maps_AreReadAsGivenWithWhatTheFormatCantHoldAtItsLargest) {
  Technique technique = withGivenProbes();
  technique.lookup = parseSpec("distance-impostor");
  RasterSequence sequence(device(), technique, 16, 16, 1);
  const auto snapshot = snapshotOf(makeBall(kRed, makeMirrorMaterial("mirror")));
  std::array<Image, 6> faces = uniformFaces(kFace, kBlue);
  std::array<Plane, 6> distances;
  for (Plane& face : distances) face = Plane(kFace, kFace, kNothing);
  for (int f = 0; f < 6; ++f) {
    faces[static_cast<std::size_t>(f)](f, 2) = vec3(0.5f, 1.0f, static_cast<float>(f));
    distances[static_cast<std::size_t>(f)](f, 2) = 4.0f;  // near plane 1/100: n / (n / 4) is 4
  }
  faces[5](31, 31) = vec3(1e6f, 0.0f, 0.0f);
  sequence.setProbe(0, faces, distances);
  sequence.renderFrame(*snapshot);
  faces[5](31, 31) = vec3(65504.0f, 0.0f, 0.0f);
  EXPECT_EQ(sequence.readProbe(0), faces);
  const std::array<Plane, 6> read = sequence.readProbeDistances(0);
  for (std::size_t f = 0; f < 6; ++f)
    for (std::size_t i = 0; i < read[f].size(); ++i) {
      if (distances[f][i] == kNothing)
        EXPECT_EQ(read[f][i], kNothing);
      else
        EXPECT_NEAR(read[f][i], 4.0f, 4.0f * 1.2e-7f);
    }
}

TEST_P(RasterGiven, NewMaps_ShowInTheNextFrame) {
  RasterSequence sequence(device(), withGivenProbes(), 16, 16, 1);
  const auto snapshot = snapshotOf(makeBall(kRed, makeMirrorMaterial("mirror")));
  for (const vec3& color : {kBlue, kWhite}) {
    sequence.setProbe(0, uniformFaces(kFace, color));
    sequence.renderFrame(*snapshot);
    EXPECT_EQ(centreOf(sequence.readImage()), color);
  }
}

TEST_P(RasterGiven, MapsThatDontFit_AreRefused) {
  const auto snapshot = snapshotOf(makeBall(kRed, makeMirrorMaterial("mirror")));
  const auto messageWith = [&](const Technique& technique, int probe, int size) {
    RasterSequence sequence(device(), technique, 16, 16, 1);
    return messageOf([&] {
      if (size > 0) sequence.setProbe(probe, uniformFaces(size, kBlue));
      sequence.renderFrame(*snapshot);
    });
  };
  Technique impostor = withGivenProbes(), singleView = withGivenProbes();
  impostor.lookup = parseSpec("distance-impostor");
  singleView.lookup = parseSpec("single-view");
  EXPECT_EQ(messageWith(withGivenProbes(), 0, 0), "the map of probe 0 was not given in 32 x 32 texels a face");
  EXPECT_EQ(messageWith(withGivenProbes(), 0, 16), "faces of probe 0 have 32 x 32 texels, one of 16 x 16 was given");
  EXPECT_EQ(messageWith(withGivenProbes(), 1, kFace), "probe 1 was given a map, there are probes 0 to 0");
  EXPECT_EQ(messageWith(withResolution(kFace), 0, kFace), "probe 0 is captured: its map can't be given");
  EXPECT_THAT(messageWith(impostor, 0, kFace), HasSubstr("reads distances: probe 0 wants 32 x 32 of them a face"));
  EXPECT_THAT(messageOf([&] { RasterSequence(device(), singleView, 16, 16, 1); }), HasSubstr("single-view"));
}

TEST(ProbeViews, OfATechnique_AreWhereItsProbesStandWithTheirOwnersHidden) {
  const auto snapshot = snapshotOf(makeBallsAndBox());
  const ProbeViews own = probeViews(withResolution(kFace), snapshot, 64);
  EXPECT_EQ(own.snapshot, snapshot);
  ASSERT_EQ(own.probes.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(own.probes[i].position, snapshot->probes[i].position);
    EXPECT_EQ(own.probes[i].zNear, snapshot->probes[i].zNear);
    EXPECT_EQ(own.probes[i].hidden, snapshot->probes[i].owners);
    EXPECT_EQ(own.probes[i].resolutionPx, kFace);
  }
  Technique shared = withResolution(kFace);
  shared.sharing = parseSpec("count?probes=1");
  const ProbeViews one = probeViews(shared, snapshot, 64);
  ASSERT_EQ(one.probes.size(), 1u);
  EXPECT_EQ(one.probes[0].hidden, (std::vector{0, 1}));
  EXPECT_EQ(one.snapshot->probes.size(), 1u);
}

TEST(ProbeViews, OfGlassThatIsCapturedFromInside_HideNothing) {
  Technique technique = withResolution(kFace);
  technique.refraction = Refraction::cubemapBackface;
  EXPECT_TRUE(probeViews(technique, snapshotOf(makeBall(kRed, makeGlass(1.5f))), 64).probes[0].hidden.empty());
}

}  // namespace
}  // namespace pb
