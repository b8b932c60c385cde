// Masked and blended surfaces in the rasteriser against closed forms, on both GL backends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scenes/error.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

using RasterAlpha = RasterTest;
INSTANTIATE_TEST_SUITE_P(Gl, RasterAlpha, kBackends, nameOfBackend);

const vec3 kGreen(0.0f, 1.0f, 0.0f);

Material makeTransparent(vec3 radiance, float opacity) {
  Material material = makeUnlit(radiance);
  material.doubleSided = true;
  material.constants.baseColor.w = opacity;
  material.constants.alpha.x = shading::kAlphaBlend;
  return material;
}

// p, p + u, p + u + v, p + v.
void addQuad(Scene& scene, vec3 p, vec3 u, vec3 v, Material material) {
  addInstance(scene, "quad", finishMesh(makeQuadMesh(p, u, v)), addMaterial(scene, std::move(material)));
}

// Faces the camera and fills its image.
void addPane(Scene& scene, float z, Material material) {
  addQuad(scene, vec3(-2, -2, z), vec3(4, 0, 0), vec3(0, 4, 0), std::move(material));
}

float largestDifference(const vec3& a, const vec3& b) {
  const vec3 d = glm::abs(a - b);
  return std::max({d.x, d.y, d.z});
}

// Few layers round a few times: some units in the last place of values up to 1.
constexpr float kRounding = 8.0f * std::numeric_limits<float>::epsilon();

// 2 x 2 texels of the given opacities, read without filtering; white.
int addOpacityTexture(Scene& scene, const std::array<float, 4>& opacities) {
  ImageRgba texels(2, 2);
  for (std::size_t i = 0; i < 4; ++i) texels[i] = glm::vec4(1.0f, 1.0f, 1.0f, opacities[i]);
  return addTexture(scene, makeTexture("opacities", std::move(texels)));
}

Material withBaseColorTexture(Material material, int texture) {
  material.baseColorTexture = texture;
  shading::TextureSlot& slot = material.constants.baseColorSlot;
  slot.offset.w = 1.0f;
  slot.sampler_ = {shading::kWrapClamp, shading::kWrapClamp, shading::kFilterNearest, shading::kFilterNearest};
  return material;
}

Material makeMasked(Scene& scene, vec3 radiance, float cutoff, const std::array<float, 4>& opacities) {
  Material material = withBaseColorTexture(makeUnlit(radiance), addOpacityTexture(scene, opacities));
  material.constants.alpha = {shading::kAlphaMask, cutoff, 0.0f, 0.0f};
  return material;
}

// --- Masks -----------------------------------------------------------------------------------------------------------

// Quarters of a quad that fills the image: opacities 0, 0.49, 0.5, 1 of the texture's rows.
std::shared_ptr<const Snapshot> maskedPane() {
  Scene scene = makeEmptyScene(kBlue);
  addPane(scene, 0.0f, makeMasked(scene, kRed, 0.5f, {0.0f, 0.49f, 0.5f, 1.0f}));
  return snapshotOf(std::move(scene));
}

TEST_P(RasterAlpha, MaskShowsWhatIsBehindBelowItsCutoffOnly) {
  const Image image = render(*maskedPane());
  std::array<vec3, 4> quarters = {image(16, 16), image(48, 16), image(16, 48), image(48, 48)};
  // Whichever way the texture lies on the quad, two quarters are holes.
  EXPECT_EQ(std::ranges::count(quarters, kBlue), 2);
  EXPECT_EQ(std::ranges::count(quarters, kRed), 2);
}

TEST_P(RasterAlpha, IdsShowWhatIsBehindTheHolesOfAMask) {
  const auto snapshot = maskedPane();
  RasterSequence sequence(device(), withResolution(32), 64, 64, 1);
  sequence.renderFrame(*snapshot);
  const Image image = sequence.readImage();
  const Grid<SampleId> ids = sequence.renderIds(*snapshot);
  for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(ids[i].instance, image[i] == kRed ? 1U : 0U);
}

TEST_P(RasterAlpha, MasksHaveHolesInCaptures) {
  Scene scene = makeEmptyScene(kBlue);
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.5f, 16, 8)), addMaterial(scene, makeMirrorMaterial("mirror")));
  addQuad(scene, vec3(2, -2, -2), vec3(0, 0, 4), vec3(0, 4, 0), makeMasked(scene, kRed, 0.5f, {0, 1, 1, 0}));
  RasterSequence sequence(device(), withResolution(32), 16, 16, 1);
  sequence.renderFrame(*snapshotOf(std::move(scene)));
  const Image face = sequence.readProbe(0)[0];
  EXPECT_THAT((std::vector<vec3>{face(8, 8), face(24, 24)}), testing::Each(face(8, 8)));
  EXPECT_THAT((std::vector<vec3>{face(24, 8), face(8, 24)}), testing::Each(face(24, 8)));
  EXPECT_NE(face(8, 8), face(24, 8));
}

// --- Blending --------------------------------------------------------------------------------------------------------

// n panes of radiance c and opacity a before a background b: c (1 - (1 - a)^n) + b (1 - a)^n.
TEST_P(RasterAlpha, EqualLayersFollowTheGeometricSeries) {
  for (const int layers : {1, 2, 7, 40}) {
    constexpr float kOpacity = 0.25f;
    Scene scene = makeEmptyScene(kWhite);
    for (int i = 0; i < layers; ++i) addPane(scene, -0.1f * static_cast<float>(i), makeTransparent(kRed, kOpacity));
    const float through = std::pow(1.0f - kOpacity, static_cast<float>(layers));
    const vec3 expected = kRed * (1.0f - through) + kWhite * through;
    EXPECT_LE(largestDifference(centreOf(render(*snapshotOf(std::move(scene)))), expected),
              static_cast<float>(layers) * kRounding)
        << layers << " layers";
  }
}

TEST_P(RasterAlpha, NearLayersCoverFarOnesWhateverIsDrawnLast) {
  for (const bool nearFirst : {true, false}) {
    Scene scene = makeEmptyScene(kBlack);
    if (nearFirst) addPane(scene, 1.0f, makeTransparent(kRed, 0.75f));
    addPane(scene, 0.0f, makeTransparent(kGreen, 0.5f));
    if (!nearFirst) addPane(scene, 1.0f, makeTransparent(kRed, 0.75f));
    EXPECT_EQ(centreOf(render(*snapshotOf(std::move(scene)))), vec3(0.75f, 0.125f, 0.0f));
  }
}

TEST_P(RasterAlpha, OpaqueSurfacesHideLayersBehindAndShowThroughLayersBefore) {
  Scene scene = makeEmptyScene(kBlack);
  addPane(scene, -1.0f, makeTransparent(kGreen, 0.5f));
  addPane(scene, 0.0f, makeUnlit(kBlue));
  addPane(scene, 1.0f, makeTransparent(kRed, 0.5f));
  EXPECT_EQ(centreOf(render(*snapshotOf(std::move(scene)))), vec3(0.5f, 0.0f, 0.5f));
}

// Two panes that cross in the plane x = 0: each is the nearer one on its side of it.
std::shared_ptr<const Snapshot> crossingPanes(bool redFirst) {
  Scene scene = makeEmptyScene(kBlack);
  const auto addRed = [&] {
    addQuad(scene, vec3(-2, -2, 0.731f), vec3(4, 0, -1.462f), vec3(0, 4, 0), makeTransparent(kRed, 0.5f));
  };
  if (redFirst) addRed();
  addQuad(scene, vec3(-2, -2, -0.731f), vec3(4, 0, 1.462f), vec3(0, 4, 0), makeTransparent(kGreen, 0.5f));
  if (!redFirst) addRed();
  return snapshotOf(std::move(scene));
}

TEST_P(RasterAlpha, CrossingSurfacesAreSortedAtEverySample) {
  const Image image = render(*crossingPanes(true));
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      EXPECT_EQ(image(x, y), x < 32 ? vec3(0.5f, 0.25f, 0.0f) : vec3(0.25f, 0.5f, 0.0f)) << x << " " << y;
}

// Overlapping quads in all directions, in the order of `order`.
std::shared_ptr<const Snapshot> tangle(const std::vector<int>& order) {
  Scene scene = makeEmptyScene(vec3(0.3f, 0.5f, 0.7f));
  for (const int i : order) {
    const float t = static_cast<float>(i);
    const vec3 u(std::cos(1.7f * t), std::sin(2.3f * t), std::cos(0.9f * t));
    const vec3 v(std::sin(0.7f * t), std::cos(1.1f * t), std::sin(1.9f * t));
    Material material = makeTransparent(vec3(0.1f * t, 1.0f - 0.1f * t, 0.5f), 0.1f + 0.08f * t);
    addQuad(scene, 0.2f * vec3(std::sin(t), std::cos(t), std::sin(2.0f * t)) - 0.5f * (u + v), u, v, material);
  }
  return snapshotOf(std::move(scene));
}

TEST_P(RasterAlpha, TheOrderOfInstancesDoesNotMatter) {
  std::vector<int> order(10);
  std::iota(order.begin(), order.end(), 0);
  const Image expected = render(*tangle(order), withResolution(32), 64, 64, 2);
  EXPECT_NE(centreOf(expected), vec3(0.3f, 0.5f, 0.7f));
  for (const int step : {3, 7, 9}) {
    std::vector<int> permuted(10);
    for (int i = 0; i < 10; ++i) permuted[static_cast<std::size_t>(i)] = (4 + step * i) % 10;
    EXPECT_EQ(render(*tangle(permuted), withResolution(32), 64, 64, 2), expected) << "step " << step;
  }
}

TEST_P(RasterAlpha, LayersAreComposedInCaptures) {
  Scene scene = makeEmptyScene(kBlue);
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.5f, 16, 8)), addMaterial(scene, makeMirrorMaterial("mirror")));
  addQuad(scene, vec3(2, -4, 4), vec3(0, 0, -8), vec3(0, 8, 0), makeTransparent(kGreen, 0.5f));
  addQuad(scene, vec3(1, -4, 4), vec3(0, 0, -8), vec3(0, 8, 0), makeTransparent(kRed, 0.5f));
  RasterSequence sequence(device(), withResolution(32), 16, 16, 1);
  sequence.renderFrame(*snapshotOf(std::move(scene)));
  EXPECT_EQ(centreOf(sequence.readProbe(0)[0]), vec3(0.5f, 0.25f, 0.25f));
  EXPECT_EQ(centreOf(sequence.readProbe(0)[1]), kBlue);
}

// A mirror that is half there: half of what its probe shows, half of what is behind.
TEST_P(RasterAlpha, BlendedMirrorsReflectAndShowWhatIsBehind) {
  Scene scene = makeEmptyScene(kBlack);
  Material mirror = makeMirrorMaterial("mirror");
  mirror.constants.baseColor.w = 0.5f;
  mirror.constants.alpha.x = shading::kAlphaBlend;
  addQuad(scene, vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0), mirror);
  addPane(scene, -1.0f, makeUnlit(kGreen));
  addQuad(scene, vec3(9, -9, 5), vec3(-18, 0, 0), vec3(0, 18, 0), makeUnlit(kRed));
  EXPECT_EQ(centreOf(render(*snapshotOf(std::move(scene)))), vec3(0.5f, 0.5f, 0.0f));
}

TEST_P(RasterAlpha, IdsShowTheNearestSurfaceWithAnyCoverage) {
  for (const float opacity : {0.0f, 0.01f}) {
    Scene scene = makeEmptyScene(kBlack);
    addPane(scene, 0.0f, makeUnlit(kGreen));
    addPane(scene, 1.0f, makeTransparent(kRed, opacity));
    RasterSequence sequence(device(), withResolution(32), 16, 16, 1);
    const Grid<SampleId> ids = sequence.renderIds(*snapshotOf(std::move(scene)));
    EXPECT_EQ(ids(8, 8).instance, opacity > 0.0f ? 2U : 1U);
  }
}

TEST_P(RasterAlpha, InvisibleSurfacesChangeNothing) {
  Scene scene = makeEmptyScene(kBlue);
  addPane(scene, 0.0f, makeTransparent(kRed, 0.0f));
  EXPECT_EQ(centreOf(render(*snapshotOf(std::move(scene)))), kBlue);
}

// One instance of `count` panes behind each other.
std::shared_ptr<const Snapshot> stackedPanes(int count, float opacity) {
  Scene scene = makeEmptyScene(kBlack);
  Mesh panes;
  for (int i = 0; i < count; ++i) {
    const Mesh pane = makeQuadMesh(vec3(-4, -4, -0.01f * static_cast<float>(i)), vec3(8, 0, 0), vec3(0, 8, 0));
    for (const std::uint32_t index : pane.indices)
      panes.indices.push_back(index + static_cast<std::uint32_t>(panes.positions.size()));
    panes.positions.insert(panes.positions.end(), pane.positions.begin(), pane.positions.end());
  }
  addInstance(scene, "panes", finishMesh(std::move(panes)), addMaterial(scene, makeTransparent(kRed, opacity)));
  return snapshotOf(std::move(scene));
}

// More layers than are reserved for at first, which is one a sample: drawn again.
void expectStack(RasterSequence& sequence, int count, float opacity) {
  const auto snapshot = stackedPanes(count, opacity);
  const FrameCounters first = sequence.renderFrame(*snapshot).counters;
  const Image image = sequence.readImage();
  const float expected = 1.0f - std::pow(1.0f - opacity, static_cast<float>(count));
  float largest = 0.0f;
  for (const vec3& pixel : image) largest = std::max(largest, std::abs(pixel.x - expected));
  EXPECT_LE(largest, static_cast<float>(count) * kRounding);
  EXPECT_EQ(sequence.renderFrame(*snapshot).counters, first) << "counters are of the picture, not of the memory";
  EXPECT_EQ(sequence.readImage(), image);
}

TEST_P(RasterAlpha, HundredsOfLayersAreComposed) {
  RasterSequence sequence(device(), withResolution(32), 32, 32, 1);
  expectStack(sequence, 600, 0.005f);
}

// 24 layers at 512 x 512 samples: 192 MiB, of which llvmpipe's storage blocks hold 128.
TEST_P(RasterAlpha, MoreLayersThanMemoryAreDrawnInStrips) {
  RasterSequence sequence(device(), withResolution(32), 512, 512, 1);
  expectStack(sequence, 24, 0.1f);
}

// A driver may give up sorting, but not without saying so.
TEST_P(RasterAlpha, ThousandsOfLayersAreComposedOrRefused) {
  RasterSequence sequence(device(), withResolution(32), 8, 8, 1);
  try {
    expectStack(sequence, 4000, 0.001f);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::environment);
    EXPECT_THAT(error.what(), testing::HasSubstr("blended surfaces"));
  }
}

// --- What it costs ---------------------------------------------------------------------------------------------------

TEST_P(RasterAlpha, BlendedSurfacesAddTheirDrawsAndOneThatComposesThem) {
  Scene scene = makeEmptyScene(kBlack);
  addPane(scene, 0.0f, makeUnlit(kGreen));
  RasterSequence opaque(device(), withResolution(32), 16, 16, 1), blended(device(), withResolution(32), 16, 16, 1);
  const FrameCounters before = opaque.renderFrame(*snapshotOf(scene)).counters;
  addPane(scene, 1.0f, makeTransparent(kRed, 0.5f));
  const FrameCounters after = blended.renderFrame(*snapshotOf(scene)).counters;
  EXPECT_EQ(after.draws, before.draws + 2);
  EXPECT_EQ(after.triangles, before.triangles + 2 + 1);
}

}  // namespace
}  // namespace pb
