// What mirrors and glass without a probe of their own show (Technique::withoutProbe).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "raster/probe_views.h"
#include "raster/reflection.h"
#include "reference/renderer.h"
#include "scenes/files.h"
#include "scenes/gltf_load.h"
#include "scenes/gltf_save.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

class RasterWithoutProbe : public RasterTest {};

INSTANTIATE_TEST_SUITE_P(Gl, RasterWithoutProbe, kBackends, nameOfBackend);

Technique showing(WithoutProbe shown, int resolution = 32) {
  Technique technique = withResolution(resolution);
  technique.withoutProbe = shown;
  return technique;
}

void addBall(Scene& scene, const vec3& centre, float radius, Material material, bool hasProbe) {
  Node node;
  node.translation = centre;
  const int added = addInstance(scene, "ball", finishMesh(makeSphereMesh(radius, 32, 16)),
                                addMaterial(scene, std::move(material)), node);
  if (!hasProbe) scene.nodes[static_cast<std::size_t>(added)].probe.emplace().enabled = false;
}

// A ball without a probe at the origin, and two mirror balls with one, to the right: the first at 2 m stands before a
// blue wall, which the camera doesn't see, the second at 5 m. The environment is red.
Scene makeBalls(Material withoutProbe) {
  Scene scene = makeEmptyScene(kRed);
  addBall(scene, vec3(0.0f), 0.8f, std::move(withoutProbe), false);
  addBall(scene, {2.0f, 0.0f, 0.0f}, 0.3f, makeMirrorMaterial("first"), true);
  addBall(scene, {5.0f, 0.0f, 0.0f}, 0.3f, makeMirrorMaterial("second"), true);
  addBox(scene, {0.0f, 0.0f, 8.0f}, {60.0f, 60.0f, 1.0f}, makeUnlit(kBlue));
  return scene;
}

TEST(Reflection, OfMirrorsAndGlassWithoutProbe_IsWhatTheTechniqueSays) {
  for (const Material& material : {makeMirrorMaterial("mirror"), makeGlass(1.5f)}) {
    const auto snapshot = snapshotOf(makeBalls(material));
    const SnapshotInstance& ball = snapshot->instances[0];
    ASSERT_EQ(ball.probe, -1);
    EXPECT_EQ(reflectionOf(showing(WithoutProbe::environment), *snapshot, ball).source, ReflectionSource::environment);
    const Reflection nearest = reflectionOf(showing(WithoutProbe::nearestProbe), *snapshot, ball);
    EXPECT_EQ(nearest.source, ReflectionSource::probe);
    EXPECT_EQ(nearest.probe, 0);
    EXPECT_EQ(nearest.second, -1);
    // At 2 and 5 m, without a third: weights in the ratio of 1/2 to 1/5.
    const Reflection blend = reflectionOf(showing(WithoutProbe::blendedProbes), *snapshot, ball);
    EXPECT_EQ(blend.probe, 0);
    EXPECT_EQ(blend.second, 1);
    EXPECT_NEAR(blend.secondWeight, 0.2f / 0.7f, 1e-6f);
    Technique plain = showing(WithoutProbe::nearestProbe);
    plain.probes = ProbeUse::environmentOnly;
    EXPECT_EQ(reflectionOf(plain, *snapshot, ball).source, ReflectionSource::environment);
  }
}

TEST(Reflection, OfOtherSurfaces_IsTheSameWhateverMirrorsWithoutProbeShow) {
  Material coated = makeDiffuseMaterial("coated", vec3(0.5f));
  coated.constants.kind.x = shading::kSurfaceGlossy;
  for (const Material& material : {coated, makeDiffuseMaterial("matte", vec3(0.5f)), makeUnlit(kWhite)}) {
    const auto snapshot = snapshotOf(makeBalls(material));
    for (const SnapshotInstance& instance : snapshot->instances) {
      const Reflection before = reflectionOf(showing(WithoutProbe::environment), *snapshot, instance);
      const Reflection after = reflectionOf(showing(WithoutProbe::blendedProbes), *snapshot, instance);
      EXPECT_EQ(after.source, before.source);
      EXPECT_EQ(after.probe, before.probe);
      EXPECT_EQ(after.second, before.second);
    }
  }
}

TEST(Reflection, OfMirrorsWithoutProbe_IsCountedByWhatServesThem) {
  const auto snapshot = snapshotOf(makeBalls(makeMirrorMaterial("mirror")));
  EXPECT_EQ(mirrorSources(showing(WithoutProbe::environment), *snapshot), (LookupSources{{0, 0}, 1}));
  EXPECT_EQ(mirrorSources(showing(WithoutProbe::nearestProbe), *snapshot), (LookupSources{{1, 0}, 0}));
  EXPECT_EQ(mirrorSources(showing(WithoutProbe::blendedProbes), *snapshot), (LookupSources{{1, 0}, 0}));
  EXPECT_EQ(coatSources(showing(WithoutProbe::nearestProbe), *snapshot), (LookupSources{{0, 0}, 0}));
}

TEST(Reflection, InASceneWithoutProbes_IsTheEnvironment) {
  Scene scene = makeEmptyScene(kRed);
  addBall(scene, vec3(0.0f), 0.8f, makeMirrorMaterial("mirror"), false);
  const auto snapshot = snapshotOf(std::move(scene));
  for (const WithoutProbe shown : {WithoutProbe::nearestProbe, WithoutProbe::blendedProbes})
    EXPECT_EQ(reflectionOf(showing(shown), *snapshot, snapshot->instances[0]).source, ReflectionSource::environment);
}

// The middle of a mirror ball reflects the camera's side.
TEST_P(RasterWithoutProbe, Mirrors_ShowTheMapOfTheNearestProbe) {
  const auto snapshot = snapshotOf(makeBalls(makeMirrorMaterial("mirror")));
  const auto centreWith = [&](WithoutProbe shown) { return centreOf(render(*snapshot, showing(shown))); };
  EXPECT_EQ(centreWith(WithoutProbe::environment), kRed);
  EXPECT_EQ(centreWith(WithoutProbe::nearestProbe), kBlue);
  EXPECT_EQ(centreWith(WithoutProbe::blendedProbes), kBlue) << "both maps show the wall";
}

// The maps of the snapshot's probes after its first frame, given to a sequence that shows another snapshot.
Image shownWithMapsOf(RasterDevice& device, const Technique& technique, const Snapshot& captured,
                      const Snapshot& shown) {
  RasterSequence capturing(device, technique, 64, 64, 1);
  capturing.renderFrame(captured);
  Technique given = technique;
  given.probes = ProbeUse::given;
  RasterSequence sequence(device, given, 64, 64, 1);
  for (int probe = 0; probe < static_cast<int>(captured.probes.size()); ++probe)
    sequence.setProbe(
        probe, capturing.readProbe(probe),
        technique.lookup.name == "distance-impostor" ? capturing.readProbeDistances(probe) : std::array<Plane, 6>{});
  sequence.renderFrame(shown);
  return sequence.readImage();
}

// What an instance looks up is the same whether its probe is the nearest or its own: proxies, distances and refracted
// rays included.
TEST_P(RasterWithoutProbe, NearestMaps_AreLookedUpAsIfTheyWereTheirOwn) {
  for (const Material& material : {makeMirrorMaterial("mirror"), makeGlass(1.5f)}) {
    const auto snapshot = snapshotOf(makeBalls(material));
    Snapshot owning = *snapshot;
    owning.instances[0].probe = 0;
    for (const char* lookup : {"infinite", "sphere-proxy", "box-proxy", "distance-impostor"}) {
      SCOPED_TRACE(lookup);
      Technique technique = showing(WithoutProbe::nearestProbe);
      technique.lookup = parseSpec(lookup);
      EXPECT_EQ(shownWithMapsOf(device(), technique, *snapshot, *snapshot),
                shownWithMapsOf(device(), technique, *snapshot, owning));
    }
  }
}

std::array<Image, 6> stripedFaces(int size, const vec3& color) {
  std::array<Image, 6> faces;
  for (Image& face : faces) {
    face = Image(size, size);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) face(x, y) = x * 8 / size % 2 == 0 ? color : kBlack;
  }
  return faces;
}

// Maps of other resolutions have other levels for one roughness.
TEST_P(RasterWithoutProbe, RoughSurfacesWhoseNearestProbeBecomesAnother_ReadTheLevelsOfItsResolution) {
  Scene scene = makeEmptyScene(kRed);
  addBall(scene, vec3(0.0f), 0.8f, makeMetalMaterial("rough", vec3(0.2f), vec3(4.0f), 0.5f), false);
  addBall(scene, {1.0f, 0.0f, 0.0f}, 0.3f, makeMirrorMaterial("near"), true);
  addBall(scene, {3.0f, 0.0f, -20.0f}, 0.3f, makeMirrorMaterial("far"), true);
  const auto before = snapshotOf(std::move(scene));
  Snapshot after = *before;
  after.instances[0].nearestProbe = 1;
  Technique technique = withResolution(256);
  technique.resolutionScale = ResolutionScale::distance;
  technique.filter = ProbeFilter::boxMips;
  technique.probes = ProbeUse::given;
  const std::vector<ProbeView> probes = probeViews(technique, before, 128).probes;
  ASSERT_NE(probes[0].resolutionPx, probes[1].resolutionPx);
  const auto lastOf = [&](const std::vector<const Snapshot*>& frames) {
    RasterSequence sequence(device(), technique, 128, 128, 1);
    for (int probe = 0; probe < 2; ++probe)
      sequence.setProbe(probe,
                        stripedFaces(probes[static_cast<std::size_t>(probe)].resolutionPx, probe == 0 ? kRed : kWhite));
    for (const Snapshot* frame : frames) sequence.renderFrame(*frame);
    return sequence.readImage();
  };
  EXPECT_EQ(lastOf({&*before, &after}), lastOf({&after}));
  EXPECT_NE(lastOf({&*before}), lastOf({&after}));
}

// The first probe looks at the mirror at -X, which shows what is behind the probe, at +X: green there. In its own
// capture the mirror can't show the map that is drawn, in the second one's it does.
TEST_P(RasterWithoutProbe, InTheCaptureOfTheirNearestProbe_MirrorsShowTheEnvironment) {
  const vec3 green(0.0f, 1.0f, 0.0f);
  Scene scene = makeEmptyScene(kRed);
  addBall(scene, vec3(0.0f), 0.8f, makeMirrorMaterial("mirror"), false);
  addBall(scene, {2.0f, 0.0f, 0.0f}, 0.1f, makeMirrorMaterial("first"), true);
  addBall(scene, {5.0f, 3.0f, 0.0f}, 0.1f, makeMirrorMaterial("second"), true);
  addBox(scene, {20.0f, 0.0f, 0.0f}, {1.0f, 60.0f, 60.0f}, makeUnlit(green));
  const auto snapshot = snapshotOf(std::move(scene));
  constexpr int kMinusX = 1;
  for (const BounceOrder order : {BounceOrder::sequential, BounceOrder::simultaneous}) {
    Technique technique = showing(WithoutProbe::nearestProbe, 64);
    technique.bounceOrder = order;
    RasterSequence sequence(device(), technique, 16, 16, 1);
    for (int frame = 0; frame < 2; ++frame) {
      sequence.renderFrame(*snapshot);
      EXPECT_EQ(centreOf(sequence.readProbe(0)[kMinusX]), kRed) << "frame " << frame;
    }
    // (-5, -3, 0) from the second probe: the mirror's centre, at 3/5 below the middle of the face.
    EXPECT_EQ(sequence.readProbe(1)[kMinusX](32, 32 + 19), green);
  }
}

TEST(MirrorsScene, WithFewerProbesThanMirrors_IsTheSameAsAFile) {
  const Scene scene = makeBuiltinScene(parseSpec("mirrors?count=8&probes=4"));
  const TemporaryFolder folder;
  saveGlb(scene, folder.file("scene.glb"));
  const auto original = snapshotOf(scene), loaded = snapshotOf(loadGltf(folder.file("scene.glb")));
  ASSERT_EQ(original->instances.size(), loaded->instances.size());
  EXPECT_EQ(loaded->probes.size(), 4u);
  for (std::size_t i = 0; i < original->instances.size(); ++i) {
    EXPECT_EQ(original->instances[i].probe, loaded->instances[i].probe);
    EXPECT_EQ(original->instances[i].nearestProbe, loaded->instances[i].nearestProbe);
  }
}

// Mean squared error over the pixels of mirrors without a probe, one sample each, and the channels.
double errorOnMirrorsWithoutProbe(const Image& image, const Image& truth, const Grid<SampleId>& ids,
                                  const Snapshot& snapshot) {
  double sum = 0.0;
  int pixels = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint32_t id = ids[i].instance;
    if (id == 0) continue;
    const SnapshotInstance& shown = snapshot.instances[id - 1];
    if (shown.probe >= 0 || !snapshot.materialOf(shown).isSpecularDominant) continue;
    const vec3 difference = image[i] - truth[i];
    sum += static_cast<double>(glm::dot(difference, difference)) / 3.0;
    ++pixels;
  }
  return sum / pixels;
}

// Half of the ring has probes. The environment leaves out the ground and everything on it; neighbours' maps show all of
// it, where distances say (as infinitely far away it would be seen in the wrong place, which is worse than not at all).
TEST_P(RasterWithoutProbe, NearestMapsOfARingOfMirrors_WithDistancesAreNearerToTheTruthThanTheEnvironment) {
  const auto snapshot = snapshotOf("mirrors?count=8&probes=4");
  ASSERT_EQ(snapshot->probes.size(), 4u);
  ReferenceSettings settings;
  settings.samplesPerAxis = 1;
  settings.spp = 2;
  const Image truth = ReferenceScene(snapshot).render(snapshot->camera, 160, 90, settings).mean();
  const auto errorOf = [&](WithoutProbe shown) {
    Technique technique = showing(shown, 64);
    technique.lookup = parseSpec("distance-impostor");
    RasterSequence sequence(device(), technique, 160, 90, 1);
    sequence.renderFrame(*snapshot);
    const Image image = sequence.readImage();
    return errorOnMirrorsWithoutProbe(image, truth, sequence.renderIds(*snapshot), *snapshot);
  };
  const double ofEnvironment = errorOf(WithoutProbe::environment);
  // 0.54 and 0.53 of it were measured. What is left: the owners of these probes are not in their own maps.
  EXPECT_LT(errorOf(WithoutProbe::nearestProbe), 0.65 * ofEnvironment);
  EXPECT_LT(errorOf(WithoutProbe::blendedProbes), 0.65 * ofEnvironment);
}

}  // namespace
}  // namespace pb
