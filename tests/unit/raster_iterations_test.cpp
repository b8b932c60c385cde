// Incremental bounce iterations against brute force, on both GL backends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "raster/texel_rect.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

class RasterIterations : public RasterTest {
 protected:
  // Renders the frames both ways and compares the maps of all probes, or of the first ones, and the pictures after
  // each.
  void expectSame(const std::vector<std::shared_ptr<const Snapshot>>& frames, Technique technique, int probes = -1);
};

INSTANTIATE_TEST_SUITE_P(Gl, RasterIterations, kBackends, nameOfBackend);

// Distance of neighbouring half floats around x >= 0.
float halfStep(float x) {
  constexpr float kSmallestNormal = 6.103515625e-05f;
  return std::exp2(std::floor(std::log2(std::max(x, kSmallestNormal))) - 10.0f);
}

// In steps of half floats.
float largestDifferenceInSteps(const Image& a, const Image& b) {
  float largest = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int channel = 0; channel < 3; ++channel) {
      const float p = a[i][channel], q = b[i][channel];
      largest = std::max(largest, std::abs(p - q) / halfStep(std::max(p, q)));
    }
  return largest;
}

// Shaders round the same sum of floats differently at most in its last places, which a half float keeps or not; what is
// filtered from such texels is no farther apart.
constexpr float kOneRounding = 1.001f;

void RasterIterations::expectSame(const std::vector<std::shared_ptr<const Snapshot>>& frames, Technique technique,
                                  int probes) {
  if (probes < 0) probes = static_cast<int>(frames.front()->probes.size());
  technique.iterations = Iterations::bruteForce;
  RasterSequence bruteForce(device(), technique, 32, 18, 1);
  technique.iterations = Iterations::incremental;
  RasterSequence incremental(device(), technique, 32, 18, 1);
  for (const auto& frame : frames) {
    bruteForce.renderFrame(*frame);
    incremental.renderFrame(*frame);
    ASSERT_LE(largestDifferenceInSteps(bruteForce.readImage(), incremental.readImage()), kOneRounding);
    for (int probe = 0; probe < probes; ++probe) {
      const auto expected = bruteForce.readProbe(probe);
      const auto actual = incremental.readProbe(probe);
      for (std::size_t face = 0; face < expected.size(); ++face)
        ASSERT_LE(largestDifferenceInSteps(expected[face], actual[face]), kOneRounding)
            << "probe " << probe << ", face " << face;
    }
  }
}

std::vector<std::shared_ptr<const Snapshot>> framesOf(const std::string& builtin, int count) {
  const auto scene = std::make_shared<const Scene>(makeBuiltinScene(parseSpec(builtin)));
  std::vector<std::shared_ptr<const Snapshot>> frames;
  for (int f = 0; f < count; ++f) frames.push_back(makeSnapshot(scene, 4 * f, "", 16.0 / 9.0));
  return frames;
}

Technique withBounces(int bounces, int resolution = 24) {
  Technique technique = withResolution(resolution);
  technique.bounces = bounces;
  return technique;
}

// A ball of the material between two mirrors of different tints; behind the camera, a light and a dark box.
Scene makeBallBetweenMirrors(Material ball) {
  Scene scene = makeEmptyScene(vec3(0.2f, 0.3f, 0.4f));
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.5f, 24, 12)), addMaterial(scene, std::move(ball)));
  const auto wall = [&](vec3 p, vec3 u, vec3 v, vec3 tint) {
    addInstance(scene, "wall", finishMesh(makeQuadMesh(p, u, v)), addMaterial(scene, makeMirrorMaterial("wall", tint)));
  };
  wall(vec3(-1, -1, 1), vec3(0, 0, -2), vec3(0, 2, 0), vec3(0.9f, 0.8f, 0.7f));
  wall(vec3(1, -1, -1), vec3(0, 0, 2), vec3(0, 2, 0), vec3(0.7f, 0.8f, 0.9f));
  addBox(scene, vec3(0.4f, 0.3f, 2.0f), vec3(0.3f), makeUnlit(vec3(3.0f, 2.0f, 1.0f)));
  addBox(scene, vec3(-0.3f, -0.6f, -1.6f), vec3(0.5f), makeUnlit(vec3(0.05f)));
  return scene;
}

TEST_P(RasterIterations, MirrorsAreTheSameInBothOrdersAndWithBothKindsOfFeedback) {
  for (const BounceOrder order : {BounceOrder::sequential, BounceOrder::simultaneous})
    for (const Feedback feedback : {Feedback::previousFrame, Feedback::sky})
      for (const int bounces : {2, 3, 5}) {
        Technique technique = withBounces(bounces);
        technique.bounceOrder = order;
        technique.feedback = feedback;
        expectSame(framesOf("mirrors?count=3", 2), technique);
      }
}

// Every fourth frame of what goes from one of the three mirrors to the other in half a second.
std::vector<std::shared_ptr<const Snapshot>> framesOfMovingBox(int count) {
  Scene moving = makeBallBetweenMirrors(makeMirrorMaterial("ball"));
  Track track;
  track.node = moving.instances.back().node;
  track.timesSeconds = {0.0f, 0.5f};
  track.values = {{-0.7f, -0.6f, 0.7f, 0.0f}, {0.7f, 0.6f, 0.7f, 0.0f}};
  moving.tracks.push_back(track);
  finishScene(moving);
  const auto scene = std::make_shared<const Scene>(std::move(moving));
  std::vector<std::shared_ptr<const Snapshot>> frames;
  for (int f = 0; f < count; ++f) frames.push_back(makeSnapshot(scene, 4 * f, "", 16.0 / 9.0));
  return frames;
}

TEST_P(RasterIterations, MovingObjectsAreTheSameUnderEveryRefreshPolicy) {
  const auto frames = framesOfMovingBox(4);
  for (const RefreshPolicy& policy : refreshPolicies())
    for (const BounceOrder order : {BounceOrder::sequential, BounceOrder::simultaneous}) {
      SCOPED_TRACE(policy.name);
      Technique technique = withBounces(3, 48);
      technique.refresh.name = policy.name;
      technique.bounceOrder = order;
      expectSame(frames, technique);
    }
  // The scene is one in which old maps show.
  RasterSequence everyFrame(device(), withBounces(3, 48), 32, 18, 1);
  Technique old = withBounces(3, 48);
  old.refresh.name = "static";
  RasterSequence kept(device(), old, 32, 18, 1);
  for (const auto& frame : frames) {
    everyFrame.renderFrame(*frame);
    kept.renderFrame(*frame);
  }
  EXPECT_GT(largestDifference(everyFrame.readImage(), kept.readImage()), 0.1f);
}

TEST_P(RasterIterations, DeformingMirrorsAreTheSame) { expectSame(framesOf("flag-and-horse", 3), withBounces(3, 16)); }

TEST_P(RasterIterations, RoughLobesAreTheSameWithEveryFilter) {
  Material brushed = makeMetalMaterial("brushed", vec3(0.2f, 0.9f, 1.1f), vec3(3.9f, 2.4f, 2.3f), 0.4f);
  for (const ProbeFilter filter : {ProbeFilter::none, ProbeFilter::boxMips, ProbeFilter::ggxPrefiltered})
    for (const BounceOrder order : {BounceOrder::sequential, BounceOrder::simultaneous}) {
      Technique technique = withBounces(3, 32);
      technique.filter = filter;
      technique.bounceOrder = order;
      expectSame({snapshotOf(makeBallBetweenMirrors(brushed))}, technique);
    }
}

// Of which less is recorded if they are everywhere the same.
TEST_P(RasterIterations, MirrorsOfEveryMaterialAndFresnelLawAreTheSame) {
  Material glowing = makeMirrorMaterial("glowing", vec3(0.6f));
  glowing.constants.emission = glm::vec4(0.1f, 0.3f, 0.2f, 1.0f);
  const std::vector<Material> materials = {
      makeMirrorMaterial("tinted", vec3(0.9f, 0.5f, 0.1f)), glowing,
      makeMetalMaterial("gold", vec3(0.18f, 0.42f, 1.37f), vec3(3.42f, 2.35f, 1.77f), 0.0f)};
  for (const Material& ball : materials) expectSame({snapshotOf(makeBallBetweenMirrors(ball))}, withBounces(3));
  for (const char* law : {"schlick", "ratio?bias=0.1&scale=0.8&power=3"}) {
    Technique technique = withBounces(3);
    technique.fresnel = parseSpec(law);
    expectSame({snapshotOf(makeBallBetweenMirrors(materials.back()))}, technique);
  }
}

TEST_P(RasterIterations, MirrorsOfSeveralMaterialsThatShareAProbeAreTheSame) {
  Technique technique = withBounces(3);
  technique.sharing = parseSpec("count?probes=2");
  expectSame({snapshotOf(makeBallBetweenMirrors(makeMirrorMaterial("ball")))}, technique, 2);
}

TEST_P(RasterIterations, CoatsOfSurfacesWithoutProbesAreTheSame) {
  Material coated = makeDiffuseMaterial("coated", vec3(0.5f, 0.4f, 0.3f));
  coated.constants.kind.x = shading::kSurfaceGlossy;
  coated.constants.specular.w = 1.0f;
  coated.constants.factors.y = 0.3f;
  for (const Coats coats : {Coats::nearestProbe, Coats::blendedProbes, Coats::environment, Coats::none}) {
    Technique technique = withBounces(3);
    technique.coats = coats;
    expectSame({snapshotOf(makeBallBetweenMirrors(coated))}, technique);
  }
}

TEST_P(RasterIterations, MirrorsAndGlassWithoutProbesAreTheSame) {
  for (const Material& material : {makeMirrorMaterial("mirror"), makeGlass(1.5f)})
    for (const WithoutProbe shown : {WithoutProbe::nearestProbe, WithoutProbe::blendedProbes}) {
      Scene scene = makeBallBetweenMirrors(material);
      scene.nodes[static_cast<std::size_t>(scene.instances.front().node)].probe.emplace().enabled = false;
      Technique technique = withBounces(3);
      technique.withoutProbe = shown;
      expectSame({snapshotOf(std::move(scene))}, technique);
    }
}

TEST_P(RasterIterations, GlassIsTheSameWithEveryRefraction) {
  for (const Refraction refraction :
       {Refraction::oneInterface, Refraction::twoInterface, Refraction::cubemapBackface, Refraction::thickSlab}) {
    Technique technique = withBounces(3);
    technique.refraction = refraction;
    expectSame({snapshotOf(makeBallBetweenMirrors(makeGlass(1.5f)))}, technique);
  }
}

TEST_P(RasterIterations, BlendedSurfacesBeforeMirrorsAreTheSame) {
  Material pane = makeUnlit(vec3(0.5f, 0.1f, 0.1f));
  pane.constants.baseColor.w = 0.5f;
  pane.constants.alpha.x = shading::kAlphaBlend;
  expectSame({snapshotOf(makeBallBetweenMirrors(pane))}, withBounces(3));
  Material mirror = makeMirrorMaterial("blended");
  mirror.constants.baseColor.w = 0.5f;
  mirror.constants.alpha.x = shading::kAlphaBlend;
  expectSame({snapshotOf(makeBallBetweenMirrors(mirror))}, withBounces(3));
}

TEST_P(RasterIterations, MirrorsWithHolesAreTheSame) {
  Scene scene = makeBallBetweenMirrors(makeMirrorMaterial("mirror"));
  ImageRgba texels(2, 2);
  for (std::size_t i = 0; i < 4; ++i) texels[i] = glm::vec4(1.0f, 1.0f, 1.0f, i % 3 == 0 ? 1.0f : 0.0f);
  Material& material = scene.materials[static_cast<std::size_t>(scene.instances.front().material)];
  material.baseColorTexture = addTexture(scene, makeTexture("holes", std::move(texels)));
  material.constants.baseColorSlot.offset.w = 1.0f;
  material.constants.alpha = {shading::kAlphaMask, 0.5f, 0.0f, 0.0f};
  material.doubleSided = true;
  expectSame({snapshotOf(std::move(scene))}, withBounces(3));
}

TEST_P(RasterIterations, LookupsFacesAndLayoutsOfProbesAreTheSame) {
  for (const char* lookup : {"infinite", "sphere-proxy", "box-proxy", "distance-impostor", "single-view"}) {
    Technique technique = withBounces(3);
    technique.lookup = parseSpec(lookup);
    expectSame(framesOf("mirror-room?count=3", 2), technique);
  }
  Technique technique = withBounces(3);
  technique.faces = CapturedFaces::topHalf;
  expectSame(framesOf("mirrors?count=3", 2), technique);
  technique = withBounces(3);
  technique.sharing = parseSpec("count?probes=2");
  expectSame(framesOf("mirrors?count=4", 2), technique, 2);
  technique = withBounces(3);
  technique.resolutionScale = ResolutionScale::distance;
  expectSame(framesOf("mirrors?count=3", 2), technique);
  technique = withBounces(3);
  technique.hysteresis = 0.5f;
  expectSame(framesOf("mirrors?count=2", 2), technique);
  technique = withBounces(3);
  technique.selfReflection = SelfReflection::splitParts;
  expectSame(framesOf("teapot", 1), technique);
}

TEST_P(RasterIterations, FormatsStoragesAndReductionsOfCapturesAreTheSame) {
  const std::vector<std::function<void(Technique&)>> settings = {
      [](Technique& t) { t.mips = true; },
      [](Technique& t) { t.seamless = false; },
      [](Technique& t) { t.captureTextures = false; },
      [](Technique& t) { t.captureLights = false; },
      [](Technique& t) { t.captureFar = 4.0f; },
      [](Technique& t) { t.captureLod = 0.3f; },
      [](Technique& t) { t.format = ProbeFormat::r11fG11fB10f; },
      [](Technique& t) { t.storage = Storage::octahedral; }};
  for (const auto& set : settings) {
    Technique technique = withBounces(3, 32);
    set(technique);
    expectSame(framesOf("mirrors?count=3", 2), technique);
  }
}

TEST_P(RasterIterations, LaterIterationsOfMirrorsDrawNoFaces) {
  Technique technique = withBounces(3);
  technique.iterations = Iterations::incremental;
  const auto snapshot = snapshotOf("mirrors?count=3");
  RasterSequence sequence(device(), technique, 32, 18, 1);
  sequence.renderFrame(*snapshot);
  EXPECT_EQ(sequence.renderFrame(*snapshot).counters.facesCaptured, 6 * 3);
}

TEST_P(RasterIterations, OneIterationCostsTheSame) {
  Technique technique = withBounces(1);
  const auto snapshot = snapshotOf("mirrors?count=2");
  RasterSequence bruteForce(device(), technique, 32, 18, 1);
  technique.iterations = Iterations::incremental;
  RasterSequence incremental(device(), technique, 32, 18, 1);
  EXPECT_EQ(bruteForce.renderFrame(*snapshot, true).counters, incremental.renderFrame(*snapshot, true).counters);
}

// From the origin, 90 degrees wide and high.
shading::View viewAlongMinusZ() {
  shading::View view;
  view.origin = {0.0f, 0.0f, 0.0f, 0.1f};
  view.forward = {0.0f, 0.0f, -1.0f, 0.0f};
  view.right = {1.0f, 0.0f, 0.0f, 0.0f};
  view.down = {0.0f, -1.0f, 0.0f, 0.0f};
  return view;
}

// One metre wide and two metres before a view whose rays spread by 45 degrees: a quarter of the width on each side of
// the middle, at the near side two metres away.
TEST(TexelRect, HoldsTheBoxAndAMargin) {
  const shading::View view = viewAlongMinusZ();
  const Bounds box = {vec3(-0.5f, 0.0f, -3.0f), vec3(0.5f, 0.5f, -2.0f)};
  EXPECT_EQ(texelsShowing(box, view, 64), (TexelRect{23, 23, 41, 33}));
  const Bounds around = {vec3(-1.0f), vec3(1.0f)};
  EXPECT_EQ(texelsShowing(around, view, 64), (TexelRect{0, 0, 64, 64}));
}

// Half a metre beside the view and two metres ahead, a quarter of the half width from the middle; what is as near as
// the near plane is out of sight to all sides.
TEST(TexelRect, HoldsOnlyWhatIsBeforeTheNearPlane) {
  const shading::View view = viewAlongMinusZ();
  const Bounds beside = {vec3(0.5f, -0.25f, -2.0f), vec3(0.75f, 0.25f, 5.0f)};
  EXPECT_EQ(texelsShowing(beside, view, 64), (TexelRect{39, 0, 64, 64}));
  const Bounds ahead = {vec3(0.5f, -0.25f, -2.0f), vec3(0.75f, 0.25f, -1.0f)};
  EXPECT_EQ(texelsShowing(ahead, view, 64), (TexelRect{39, 23, 57, 41}));
  const Bounds behind = {vec3(-1.0f, -1.0f, 1.0f), vec3(1.0f, 1.0f, 5.0f)};
  EXPECT_EQ(texelsShowing(behind, view, 64).texels(), 0);
}

// A ball of radius 1 two metres ahead is seen under asin(1/2) to each side: tan(30 degrees) = 0.577 of the half width.
TEST(TexelRect, HoldsTheBallAndAMargin) {
  const shading::View view = viewAlongMinusZ();
  EXPECT_EQ(texelsShowing(Ball{vec3(0.0f, 0.0f, -2.0f), 1.0f}, view, 64), (TexelRect{12, 12, 52, 52}));
  EXPECT_EQ(texelsShowing(Ball{vec3(0.0f, 0.5f, 0.0f), 1.0f}, view, 64), (TexelRect{0, 0, 64, 64}));
  EXPECT_EQ(texelsShowing(Ball{vec3(0.0f, 0.0f, 2.0f), 1.0f}, view, 64).texels(), 0);
  // Beside the view and partly behind it: of the horizontal circle, all that is right of the tangent at -45 degrees.
  EXPECT_EQ(texelsShowing(Ball{vec3(2.0f, 0.0f, 0.0f), std::sqrt(2.0f)}, view, 64).right, 64);
}

// Points of the surface of balls all around the view: those in the picture lie in the rectangle.
TEST(TexelRect, HoldsWhateverTheBallShows) {
  const shading::View view = viewAlongMinusZ();
  for (int i = 0; i < 200; ++i) {
    const auto random = [&](int k) { return static_cast<float>((i * 37 + k * 101) % 97) / 48.0f - 1.0f; };
    const Ball ball = {3.0f * vec3(random(1), random(2), random(3)), 0.55f + 0.5f * random(4)};
    const TexelRect rect = texelsShowing(ball, view, 64);
    for (int row = 1; row < 16; ++row)
      for (int column = 0; column < 32; ++column) {
        const float polar = static_cast<float>(row) * glm::pi<float>() / 16.0f;
        const float around = static_cast<float>(column) * glm::pi<float>() / 16.0f;
        const vec3 direction(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around));
        const glm::vec4 clip = shading::clipFromWorldPosition(view, ball.centre + ball.radius * direction);
        if (clip.w < view.origin.w || std::abs(clip.x) >= clip.w || std::abs(clip.y) >= clip.w) continue;
        const int x = static_cast<int>(32.0f * (clip.x / clip.w + 1.0f)),
                  y = static_cast<int>(32.0f * (clip.y / clip.w + 1.0f));
        EXPECT_TRUE(x >= rect.left && x < rect.right && y >= rect.top && y < rect.bottom) << i << " " << x << " " << y;
      }
  }
}

TEST(TexelRect, TransformedBallHoldsTransformedPoints) {
  const glm::mat4 matrix = glm::scale(glm::rotate(glm::translate(glm::mat4(1.0f), vec3(1, 2, 3)), 0.7f, vec3(0, 1, 1)),
                                      vec3(1.0f, 2.0f, 0.5f));
  const Ball ball = transformed(Ball{vec3(0.5f, 0.0f, 0.0f), 2.0f}, matrix);
  EXPECT_NEAR(ball.radius, 4.0f, 1e-5f);  // the largest scale; one rotation changes no length
  EXPECT_LT(glm::distance(ball.centre, vec3(matrix * glm::vec4(0.5f, 0.0f, 0.0f, 1.0f))), 1e-6f);
}

TEST(TexelRect, CommonPartIsInBoth) {
  const TexelRect a = {1, 2, 5, 6};
  EXPECT_EQ(common(a, TexelRect{3, 0, 9, 4}), (TexelRect{3, 2, 5, 4}));
  EXPECT_EQ(common(a, TexelRect{5, 2, 9, 6}).texels(), 0);
}

TEST(TexelRect, JoinsToTheSmallestThatHoldsBoth) {
  const TexelRect a = {1, 2, 3, 4};
  EXPECT_EQ(joined(a, TexelRect{}), a);
  EXPECT_EQ(joined(TexelRect{}, a), a);
  EXPECT_EQ(joined(a, TexelRect{2, 0, 7, 3}), (TexelRect{1, 0, 7, 4}));
}

}  // namespace
}  // namespace pb
