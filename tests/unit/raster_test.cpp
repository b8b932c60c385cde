// The rasteriser's pictures against what the scene says, on both GL backends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "raster/device.h"
#include "raster/renderer.h"
#include "scenes/builtin.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

using glm::vec3;

#ifdef PROBEBENCH_OSMESA
constexpr bool kHasOsmesa = true;
#else
constexpr bool kHasOsmesa = false;
#endif

const vec3 kRed(1.0f, 0.0f, 0.0f), kBlue(0.0f, 0.0f, 1.0f), kWhite(1.0f), kBlack(0.0f);

Material makeUnlit(vec3 radiance) {
  Material material = makeDiffuseMaterial("unlit", radiance);
  material.constants.kind.x = shading::kSurfaceUnlit;
  return material;
}

void addBox(Scene& scene, vec3 centre, vec3 edges, Material material) {
  Node node;
  node.translation = centre;
  addInstance(scene, "box", finishMesh(makeBoxMesh(edges)), addMaterial(scene, std::move(material)), node);
}

// Looks along -Z from z = 3.
Scene makeEmptyScene(vec3 environment) {
  Scene scene;
  scene.environment = makeConstantEnvironment(environment);
  addCamera(scene, "camera", vec3(0, 0, 3), vec3(0), 0.8f, 0.1f);
  return scene;
}

std::shared_ptr<const Snapshot> snapshotOf(Scene scene, double aspect = 1.0) {
  finishScene(scene);
  return makeSnapshot(std::make_shared<const Scene>(std::move(scene)), 0, "", aspect);
}

std::shared_ptr<const Snapshot> snapshotOf(const std::string& builtin, int frame = 0) {
  return makeSnapshot(std::make_shared<const Scene>(makeBuiltinScene(parseSpec(builtin))), frame, "", 16.0 / 9.0);
}

Technique withResolution(int resolution) {
  Technique technique;
  technique.resolution = resolution;
  return technique;
}

vec3 centreOf(const Image& image) { return image(image.width() / 2, image.height() / 2); }

float largestDifference(const Image& a, const Image& b) {
  EXPECT_EQ(a.width(), b.width());
  EXPECT_EQ(a.height(), b.height());
  float largest = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const vec3 d = glm::abs(a[i] - b[i]);
    largest = std::max({largest, d.x, d.y, d.z});
  }
  return largest;
}

class Raster : public testing::TestWithParam<GlBackend> {
 protected:
  // Shared by the tests, given back before the process ends: OSMesa takes itself down at exit, before static objects
  // go.
  static RasterDevice& deviceOf(GlBackend backend) {
    std::unique_ptr<RasterDevice>& device = devices_[backend];
    if (!device) device = std::make_unique<RasterDevice>(backend);
    return *device;
  }
  static void TearDownTestSuite() { devices_.clear(); }

  void SetUp() override {
    if (GetParam() == GlBackend::osmesa && !kHasOsmesa) GTEST_SKIP() << "this build has no OSMesa backend";
  }
  RasterDevice& device() { return deviceOf(GetParam()); }

  Image render(const Snapshot& snapshot, const Technique& technique = withResolution(32), int width = 64,
               int height = 64, int samplesPerAxis = 1) {
    RasterSequence sequence(device(), technique, width, height, samplesPerAxis);
    sequence.renderFrame(snapshot);
    return sequence.readImage();
  }

 private:
  static inline std::map<GlBackend, std::unique_ptr<RasterDevice>> devices_;
};

INSTANTIATE_TEST_SUITE_P(Gl, Raster, testing::Values(GlBackend::osmesa, GlBackend::egl),
                         [](const auto& test) { return test.param == GlBackend::osmesa ? "Osmesa" : "Egl"; });

// --- The picture of the camera ---------------------------------------------------------------------------------------

TEST_P(Raster, TopRowIsUpAndFirstColumnIsLeft) {
  Scene scene = makeEmptyScene(kBlack);
  addBox(scene, vec3(-0.6f, 0.6f, 0), vec3(0.2f), makeUnlit(kRed));
  const Image image = render(*snapshotOf(std::move(scene)));
  EXPECT_EQ(image(16, 16), kRed);
  EXPECT_EQ(image(48, 16), kBlack);
  EXPECT_EQ(image(16, 48), kBlack);
}

TEST_P(Raster, NearHidesFarWhateverIsDrawnLast) {
  for (const bool nearFirst : {true, false}) {
    Scene scene = makeEmptyScene(kBlack);
    if (nearFirst) addBox(scene, vec3(0, 0, 1), vec3(0.5f), makeUnlit(kRed));
    addBox(scene, vec3(0, 0, -5), vec3(9.0f, 9.0f, 1.0f), makeUnlit(kBlue));
    if (!nearFirst) addBox(scene, vec3(0, 0, 1), vec3(0.5f), makeUnlit(kRed));
    const Image image = render(*snapshotOf(std::move(scene)));
    EXPECT_EQ(centreOf(image), kRed);
    EXPECT_EQ(image(2, 2), kBlue);
  }
}

TEST_P(Raster, BackFacesAreSeenOnDoubleSidedMaterialsOnly) {
  for (const bool doubleSided : {true, false}) {
    Scene scene = makeEmptyScene(kBlack);
    Material material = makeUnlit(kRed);
    material.doubleSided = doubleSided;
    // Faces -Z, away from the camera.
    addInstance(scene, "quad", finishMesh(makeQuadMesh(vec3(1, -1, 0), vec3(-2, 0, 0), vec3(0, 2, 0))),
                addMaterial(scene, material));
    EXPECT_EQ(centreOf(render(*snapshotOf(std::move(scene)))), doubleSided ? kRed : kBlack);
  }
}

TEST_P(Raster, MirroredInstanceShowsItsOutside) {
  Scene scene = makeEmptyScene(kWhite);
  addBox(scene, vec3(0), vec3(1.0f), makeDiffuseMaterial("grey", vec3(0.5f)));
  const auto plain = snapshotOf(scene);
  scene.nodes.back().scale = vec3(-1, 1, 1);
  const auto mirrored = snapshotOf(scene);
  ASSERT_TRUE(mirrored->instances.front().mirrored);
  // The box is its own mirror image.
  EXPECT_EQ(render(*plain), render(*mirrored));
  EXPECT_NE(centreOf(render(*plain)), kWhite);
}

TEST_P(Raster, DiffuseSurfaceHasTheRadianceOfTheSharedModel) {
  Scene scene = makeEmptyScene(vec3(0.25f));
  addDirectionalLight(scene, "light", vec3(0, 0.6f, 0.8f), vec3(2.0f));
  addBox(scene, vec3(0), vec3(1.0f), makeDiffuseMaterial("grey", vec3(0.5f)));
  // Lambert: albedo (E cos / pi + ambient), with cos = 0.8 on the side towards +Z.
  const float expected = 0.5f * (2.0f * 0.8f / shading::kPi + 0.25f);
  EXPECT_NEAR(centreOf(render(*snapshotOf(std::move(scene)))).x, expected, 1e-5f);
}

TEST_P(Raster, SamplesAreAveragedOverThePixel) {
  const auto snapshot = snapshotOf("control");
  RasterSequence fine(device(), withResolution(8), 64, 36, 1), averaged(device(), withResolution(8), 16, 9, 4);
  fine.renderFrame(*snapshot);
  averaged.renderFrame(*snapshot);
  const Image samples = fine.readImage(), image = averaged.readImage();
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 16; ++x) {
      vec3 sum(0.0f);
      for (int i = 0; i < 16; ++i) sum += samples(4 * x + i % 4, 4 * y + i / 4);
      EXPECT_NEAR(glm::length(sum / 16.0f - image(x, y)), 0.0f, 1e-6f) << x << " " << y;
    }
}

TEST_P(Raster, IdsNameInstanceGroupAndNearestTexel) {
  Scene scene = makeEmptyScene(kBlack);
  addBox(scene, vec3(100, 0, 0), vec3(1.0f), makeUnlit(kRed));
  ImageRgba texels(2, 2, glm::vec4(1.0f));
  Material material = makeUnlit(kWhite);
  material.baseColorTexture = addTexture(scene, makeTexture("texels", texels));
  material.constants.baseColorSlot.offset.w = 1.0f;
  material.constants.baseColorSlot.sampler_ = {shading::kWrapClamp, shading::kWrapClamp, shading::kFilterNearest,
                                               shading::kFilterNearest};
  addInstance(scene, "quad", finishMesh(makeQuadMesh(vec3(-0.5f, -0.5f, 0), vec3(1, 0, 0), vec3(0, 1, 0))),
              addMaterial(scene, material));
  const auto snapshot = snapshotOf(std::move(scene));
  RasterSequence sequence(device(), withResolution(8), 32, 32, 2);
  const Grid<SampleId> ids = sequence.renderIds(*snapshot);
  ASSERT_EQ(ids.width(), 64);
  EXPECT_EQ(ids(0, 0), (SampleId{0, 0, 0}));
  const Mesh& quad = *snapshot->instances[1].mesh;
  const auto texelOf = [&](vec3 p) {  // of the quad's point p, from its texture coordinates
    const glm::vec2 uv = quad.uvs[0][0] + (p.x + 0.5f) * (quad.uvs[0][1] - quad.uvs[0][0]) +
                         (p.y + 0.5f) * (quad.uvs[0][3] - quad.uvs[0][0]);
    return static_cast<std::uint32_t>(2 * static_cast<int>(2.0f * uv.y) + static_cast<int>(2.0f * uv.x) + 1);
  };
  // The quad's half edge covers 32 * 0.5 / (3 tan 0.4) = 12.6 samples around the centre.
  EXPECT_EQ(ids(26, 26), (SampleId{2, quad.smoothingGroups[0] + 1, texelOf(vec3(-0.22f, 0.22f, 0))}));
  EXPECT_EQ(ids(38, 26), (SampleId{2, quad.smoothingGroups[0] + 1, texelOf(vec3(0.22f, 0.22f, 0))}));
  EXPECT_EQ(ids(26, 38), (SampleId{2, quad.smoothingGroups[0] + 1, texelOf(vec3(-0.22f, -0.22f, 0))}));
}

TEST_P(Raster, HardwareTexturesAreNearExactOnes) {
  Technique technique = withResolution(8);
  const auto snapshot = snapshotOf("control");
  const Image exact = render(*snapshot, technique, 160, 90);
  technique.textureFilter = TextureFilter::hardware;
  const Image hardware = render(*snapshot, technique, 160, 90);
  double sum = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) sum += static_cast<double>(glm::length(exact[i] - hardware[i]));
  const double mean = sum / static_cast<double>(exact.size());
  // Levels of detail from derivatives instead of cones, and 8-bit filter weights.
  EXPECT_LT(mean, 0.02);
  EXPECT_GT(mean, 0.0) << "the setting changes nothing";
}

// --- Reflection and refraction ---------------------------------------------------------------------------------------

Scene makeBall(vec3 environment, Material material) {
  Scene scene = makeEmptyScene(environment);
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.8f, 32, 16)), addMaterial(scene, std::move(material)));
  return scene;
}

TEST_P(Raster, PerfectMirrorVanishesInAWhiteFurnace) {
  for (const ProbeUse use : {ProbeUse::dynamic, ProbeUse::environmentOnly}) {
    Technique technique = withResolution(16);
    technique.probes = use;
    for (const vec3& pixel : render(*snapshotOf(makeBall(kWhite, makeMirrorMaterial("mirror"))), technique))
      ASSERT_EQ(pixel, kWhite);
  }
}

Material makeGlass(float ior) { return makeGlassMaterial("glass", ior); }

TEST_P(Raster, GlassOfIndexOneIsInvisible) {
  Technique technique = withResolution(16);
  technique.probes = ProbeUse::environmentOnly;
  Scene scene = makeEmptyScene(kBlack);
  addBox(scene, vec3(0), vec3(1.5f), makeGlass(1.0f));
  scene.environment = makeProceduralSky();
  Scene empty = makeEmptyScene(kBlack);
  empty.environment = makeProceduralSky();
  // The sky is evaluated along directions that differ by rounding; its steepest part, the glow, has an exponent of
  // some hundreds.
  EXPECT_LT(largestDifference(render(*snapshotOf(std::move(scene)), technique),
                              render(*snapshotOf(std::move(empty)), technique)),
            1e-3f);
}

TEST_P(Raster, GlassConservesEnergyInAWhiteFurnace) {
  for (const vec3& pixel : render(*snapshotOf(makeBall(kWhite, makeGlass(1.5f))))) ASSERT_NEAR(pixel.x, 1.0f, 1e-5f);
}

// The hardware knows orientation and seams of cube maps by itself; the exact filter has them from shading/cubemap.glsl.
TEST_P(Raster, EnvironmentFacesLookAlikeThroughBothFilters) {
  Scene scene = makeBall(kBlack, makeMirrorMaterial("mirror"));
  scene.environment.sky.toGlow.w = 1.0f;
  scene.environment.faces.assign(6, ImageRgba(4, 4));
  for (std::size_t face = 0; face < 6; ++face)
    for (std::size_t i = 0; i < 16; ++i) {
      const auto x = static_cast<float>(16 * face + i);
      scene.environment.faces[face][i] =
          glm::vec4(0.5f) + 0.5f * glm::vec4(std::sin(x), std::sin(2.3f * x), std::sin(5.9f * x), 1.0f);
    }
  const auto snapshot = snapshotOf(std::move(scene));
  Technique technique = withResolution(8);
  technique.probes = ProbeUse::environmentOnly;
  const Image exact = render(*snapshot, technique, 128, 128);
  technique.textureFilter = TextureFilter::hardware;
  // Weights of at least 8 bits on each of two axes between texels that differ by 1 at most.
  EXPECT_LT(largestDifference(exact, render(*snapshot, technique, 128, 128)), 2.0f / 256.0f);
}

TEST_P(Raster, MirrorWithoutProbesShowsTheEnvironment) {
  Technique technique = withResolution(16);
  technique.probes = ProbeUse::environmentOnly;
  Scene scene = makeBall(kBlue, makeMirrorMaterial("mirror"));
  addBox(scene, vec3(0, 0, 5), vec3(9, 9, 1), makeUnlit(kRed));  // behind the camera
  const auto snapshot = snapshotOf(std::move(scene));
  RasterSequence plain(device(), technique, 32, 32, 1);
  const FrameStats stats = plain.renderFrame(*snapshot);
  EXPECT_EQ(centreOf(plain.readImage()), kBlue);
  EXPECT_EQ(stats.counters.facesCaptured, 0);
  EXPECT_EQ(stats.counters.probeBytes, 0);
  EXPECT_TRUE(stats.faceAgeFrames.empty());
  EXPECT_THROW(plain.readProbe(0), Error);
  EXPECT_EQ(centreOf(render(*snapshot)), kRed) << "with probes, the box";
}

// --- Captures --------------------------------------------------------------------------------------------------------

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

TEST_P(Raster, CubeFacesLieAsOpenGlReadsThem) {
  const std::array<Image, 6> faces = captureRoom(device(), 64, 64);
  for (std::size_t f = 0; f < 6; ++f) {
    EXPECT_EQ(centreOf(faces[f]), kWalls[f].color) << "face " << f;
    EXPECT_EQ(faces[f](3 * kFace / 4, kFace / 4), kWhite) << "face " << f;
    EXPECT_EQ(faces[f](kFace / 4, kFace / 4), kWalls[f].color) << "face " << f;
    EXPECT_EQ(faces[f](kFace / 4, 3 * kFace / 4), kWalls[f].color) << "face " << f;
    EXPECT_EQ(faces[f](3 * kFace / 4, 3 * kFace / 4), kWalls[f].color) << "face " << f;
  }
}

TEST_P(Raster, CapturesAreSquareAndWholeWhateverTheImagesShape) {
  const std::array<Image, 6> square = captureRoom(device(), 64, 64);
  EXPECT_EQ(captureRoom(device(), 90, 10), square);
  // Walls end at 5.5 / 5.5 = 90 degrees: every texel was drawn, none shows the black environment.
  for (const Image& face : square)
    for (const vec3& texel : face) EXPECT_NE(texel, kBlack);
}

TEST_P(Raster, ReflectionPointsWhereTheMirrorFaces) {
  // The middle of the ball's picture reflects straight back: the wall at +Z.
  EXPECT_EQ(centreOf(render(*snapshotOf(makeRoom()), withResolution(kFace), 65, 65)), kWalls[4].color);
}

TEST_P(Raster, CapturesHaveDepth) {
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

TEST_P(Raster, RadianceBeyondHalfFloatIsCapturedAsTheLargestHalf) {
  RasterSequence sequence(device(), withResolution(8), 16, 16, 1);
  sequence.renderFrame(*snapshotOf(makeBall(vec3(1e6f), makeMirrorMaterial("mirror"))));
  EXPECT_EQ(centreOf(sequence.readProbe(0)[0]), vec3(65504.0f));
  EXPECT_EQ(sequence.readImage()(0, 0), vec3(1e6f)) << "the image itself is float";
}

TEST_P(Raster, CullingDoesNotChangeThePicture) {
  const auto culled = snapshotOf("mirrors?count=3");
  Snapshot everything = *culled;
  for (SnapshotInstance& instance : everything.instances) instance.worldBounds = {vec3(-1e6f), vec3(1e6f)};
  RasterSequence a(device(), withResolution(32), 96, 54, 1), b(device(), withResolution(32), 96, 54, 1);
  const FrameStats culledStats = a.renderFrame(*culled), allStats = b.renderFrame(everything);
  EXPECT_EQ(a.readImage(), b.readImage());
  for (int probe = 0; probe < 3; ++probe) EXPECT_EQ(a.readProbe(probe), b.readProbe(probe));
  EXPECT_LT(culledStats.counters.draws, allStats.counters.draws);
}

// --- Bounces and feedback --------------------------------------------------------------------------------------------

constexpr float kReflectance = 0.5f;

// Two mirrors that face each other and emit 1: along their common axis a probe shows the sum of kReflectance^k over k
// = 0 .. n - 1 after n captures in turn, and the black environment adds nothing. Sums of few terms are exact in half
// floats; lookups hit the middle of the middle texel but for rounding.
std::shared_ptr<const Snapshot> facingMirrors() {
  Scene scene = makeEmptyScene(kBlack);
  Material mirror = makeMirrorMaterial("mirror", vec3(kReflectance));
  mirror.constants.emission = {1.0f, 1.0f, 1.0f, 1.0f};
  const int material = addMaterial(scene, mirror);
  addInstance(scene, "left", finishMesh(makeQuadMesh(vec3(-1, -1, 1), vec3(0, 0, -2), vec3(0, 2, 0))), material);
  addInstance(scene, "right", finishMesh(makeQuadMesh(vec3(1, -1, -1), vec3(0, 0, 2), vec3(0, 2, 0))), material);
  return snapshotOf(std::move(scene));
}

float partialSum(int terms) {
  return (1.0f - std::pow(kReflectance, static_cast<float>(terms))) / (1.0f - kReflectance);
}

// Terms of the series that the left and the right probe have after rendering `frames` frames.
void expectTerms(RasterDevice& device, const Technique& technique, int frames, int left, int right) {
  const auto snapshot = facingMirrors();
  RasterSequence sequence(device, technique, 16, 16, 1);
  for (int f = 0; f < frames; ++f) sequence.renderFrame(*snapshot);
  constexpr float kTolerance = 1e-3f;  // below half of the smallest difference tested, 0.5^7 / 2
  EXPECT_NEAR(centreOf(sequence.readProbe(0)[0]).x, partialSum(left), kTolerance);   // looks along +X
  EXPECT_NEAR(centreOf(sequence.readProbe(1)[1]).x, partialSum(right), kTolerance);  // looks along -X
}

// An odd number of texels has one in the middle.
Technique withBounces(int bounces, BounceOrder order, Feedback feedback = Feedback::previousFrame) {
  Technique technique = withResolution(33);
  technique.bounces = bounces;
  technique.bounceOrder = order;
  technique.feedback = feedback;
  return technique;
}

TEST_P(Raster, SequentialBouncesGainTwoTermsAnIteration) {
  for (int b = 1; b <= 3; ++b) expectTerms(device(), withBounces(b, BounceOrder::sequential), 1, 2 * b - 1, 2 * b);
}

TEST_P(Raster, SimultaneousBouncesGainOneTermAnIteration) {
  for (int b = 1; b <= 3; ++b) expectTerms(device(), withBounces(b, BounceOrder::simultaneous), 1, b, b);
}

TEST_P(Raster, PreviousFrameFeedbackGoesOnWhereTheLastFrameStopped) {
  expectTerms(device(), withBounces(1, BounceOrder::sequential), 3, 5, 6);
  expectTerms(device(), withBounces(1, BounceOrder::simultaneous), 3, 3, 3);
}

TEST_P(Raster, SkyFeedbackStartsAnewInEveryFrame) {
  expectTerms(device(), withBounces(2, BounceOrder::sequential, Feedback::sky), 3, 3, 4);
  expectTerms(device(), withBounces(2, BounceOrder::simultaneous, Feedback::sky), 3, 2, 2);
}

TEST_P(Raster, SkyFeedbackLeavesProbesAloneThatAreNotDue) {
  // One face a frame: frame 1 captures the left probe's +X face, which sees the right probe's first capture.
  Technique technique = withBounces(1, BounceOrder::sequential, Feedback::sky);
  technique.refresh = parseSpec("faces?k=1");
  expectTerms(device(), technique, 2, 3, 2);
}

// --- Refresh ---------------------------------------------------------------------------------------------------------

TEST_P(Raster, StaticEqualsEveryFrameWhileNothingMoves) {
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

TEST_P(Raster, EveryFrameFollowsWhatMovesAndStaticDoesNot) {
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

// --- Counters, times, determinism ------------------------------------------------------------------------------------

TEST_P(Raster, CountersFollowTheCostModel) {
  Technique technique = withResolution(16);
  technique.bounces = 2;
  const auto snapshot = snapshotOf("mirrors?count=3");
  RasterSequence sequence(device(), technique, 32, 18, 1);
  const FrameCounters first = sequence.renderFrame(*snapshot).counters;
  EXPECT_EQ(first.facesCaptured, 6 * 3 * 2);
  EXPECT_EQ(first.probeBytes, 3 * 6 * 16 * 16 * 8);
  EXPECT_EQ(first.fragments, 0);
  FrameCounters counted = sequence.renderFrame(*snapshot, true).counters;
  // Every sample of the 36 faces and of the image is covered at least once, by the background if by nothing else.
  EXPECT_GE(counted.fragments, 36 * 16 * 16 + 32 * 18);
  counted.fragments = 0;
  EXPECT_EQ(counted, first);
}

TEST_P(Raster, BackgroundIsOneDrawOfOneTriangle) {
  Scene scene = makeEmptyScene(kBlue);
  addBox(scene, vec3(0, 0, 9), vec3(1.0f), makeUnlit(kRed));  // behind the camera
  RasterSequence sequence(device(), withResolution(8), 20, 10, 1);
  const FrameCounters counters = sequence.renderFrame(*snapshotOf(std::move(scene), 2.0), true).counters;
  EXPECT_EQ(counters.draws, 1);
  EXPECT_EQ(counters.triangles, 1);
  EXPECT_EQ(counters.fragments, 20 * 10);
  for (const vec3& pixel : sequence.readImage()) EXPECT_EQ(pixel, kBlue);
}

TEST_P(Raster, TimedFrameShowsTheSamePictureAndTimesEveryPass) {
  Technique technique = withResolution(16);
  technique.bounces = 3;
  const auto snapshot = snapshotOf("mirrors?count=2");
  RasterSequence timed(device(), technique, 32, 18, 1);
  const PassTimes times = timed.renderFrameTimed(*snapshot);
  ASSERT_THAT(times.captureMs, testing::SizeIs(3));
  for (const double ms : times.captureMs) EXPECT_GT(ms, 0.0);
  EXPECT_GT(times.finalMs, 0.0);
  EXPECT_EQ(timed.readImage(), render(*snapshot, technique, 32, 18));
}

TEST_P(Raster, SameInputsGiveTheSameBits) {
  Technique technique = withResolution(32);
  technique.bounces = 2;
  const auto snapshot = snapshotOf("mirrors?count=3");
  EXPECT_EQ(render(*snapshot, technique, 96, 54, 2), render(*snapshot, technique, 96, 54, 2));
}

TEST_P(Raster, RefusesWhatTheDeviceCannotDo) {
  EXPECT_THROW(RasterSequence(device(), withResolution(1 << 20), 16, 16, 1), Error);
  EXPECT_THROW(RasterSequence(device(), withResolution(8), 1 << 20, 16, 1), Error);
  Technique technique = withResolution(8);
  technique.bounces = 0;
  EXPECT_THROW(RasterSequence(device(), technique, 16, 16, 1), Error);
  technique = withResolution(8);
  technique.refresh = parseSpec("sometimes");
  EXPECT_THROW(RasterSequence(device(), technique, 16, 16, 1), Error);
}

TEST_P(Raster, EveryVariantOfTheShadersCompiles) {
  RasterDevice::Impl& impl = device().impl();
  impl.context.makeCurrent();
  SurfaceVariant variant;
  for (const float kind :
       {shading::kSurfaceDiffuse, shading::kSurfaceMirror, shading::kSurfaceGlass, shading::kSurfaceUnlit})
    for (const TextureFilter filter : {TextureFilter::exact, TextureFilter::hardware})
      for (const bool textured : {false, true}) {
        variant.kind = kind;
        variant.filter = filter;
        variant.attributes = textured;
        variant.textures.fill(textured ? std::optional(SamplerSettings{0.0f, 1.0f, 1.0f, 5.0f}) : std::nullopt);
        EXPECT_NE(impl.programs.surfaceShowingProbe(variant, techniqueDefines({})), 0U);
        EXPECT_NE(impl.programs.ids(variant), 0U);
        for (const EnvironmentSource source :
             {EnvironmentSource::gradient, EnvironmentSource::faces, EnvironmentSource::facesHardware})
          EXPECT_NE(impl.programs.surfaceShowingEnvironment(variant, source, techniqueDefines({})), 0U);
      }
}

TEST_P(Raster, ShaderErrorsBecomeOneException) {
  RasterDevice::Impl& impl = device().impl();
  impl.context.makeCurrent();
  try {
    const gl::Program program(impl.context.functions(),
                              {{GL_VERTEX_SHADER, "broken.vert", "#version 450 core\nvoid main() { nonsense; }\n"}});
    FAIL() << "a broken shader compiled";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::environment);
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("broken.vert"), testing::HasSubstr("nonsense"),
                                             testing::Not(testing::HasSubstr("\n"))));
  }
}

TEST_P(Raster, GlErrorsBecomeOneExceptionAndAreCleared) {
  RasterDevice::Impl& impl = device().impl();
  impl.context.makeCurrent();
  impl.context.functions().Enable(GL_RGBA);
  try {
    impl.context.check("testing");
    FAIL() << "the error went unnoticed";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::environment);
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("GL_INVALID_ENUM"), testing::HasSubstr("testing")));
  }
  EXPECT_NO_THROW(impl.context.check("testing"));
}

// Both are llvmpipe of one Mesa here; on a machine where EGL finds a GPU the pictures differ in rounding.
TEST(Backends, UsedInTurnEachGiveThePictureThatTheyGiveAlone) {
  if (!kHasOsmesa) GTEST_SKIP() << "this build has no OSMesa backend";
  RasterDevice osmesa(GlBackend::osmesa), egl(GlBackend::egl);
  const auto snapshot = snapshotOf("mirrors?count=2");
  RasterSequence a(osmesa, withResolution(32), 64, 36, 1), b(egl, withResolution(32), 64, 36, 1);
  RasterSequence alone(osmesa, withResolution(32), 64, 36, 1);
  for (int f = 0; f < 2; ++f) {
    a.renderFrame(*snapshot);
    b.renderFrame(*snapshot);
  }
  for (int f = 0; f < 2; ++f) alone.renderFrame(*snapshot);
  EXPECT_EQ(a.readImage(), alone.readImage());
  if (osmesa.info().renderer == egl.info().renderer) {
    EXPECT_EQ(a.readImage(), b.readImage());
  }
  EXPECT_LT(largestDifference(a.readImage(), b.readImage()), 1.0f);
}

}  // namespace
}  // namespace pb
