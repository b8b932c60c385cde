// Formats, storage and mipmaps of the probes' maps, and lookups without seamless edges.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#define GLM_ENABLE_EXPERIMENTAL
#include <glm/gtx/component_wise.hpp>

#include "raster/texel_format.h"
#include "scenes/shading/shading.h"
#include "tests/error_message.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

class RasterFormat : public RasterTest {
 protected:
  std::array<Image, 6> capture(const Snapshot& snapshot, const Technique& technique, int level = 0) {
    RasterSequence sequence(device(), technique, 32, 32, 1);
    sequence.renderFrame(snapshot);
    return sequence.readProbe(0, level);
  }
};

INSTANTIATE_TEST_SUITE_P(Gl, RasterFormat, kBackends, nameOfBackend);

constexpr std::array kFormats = {ProbeFormat::rgba16f, ProbeFormat::r11fG11fB10f, ProbeFormat::rgb9e5,
                                 ProbeFormat::rgba8Srgb};
constexpr std::array kStorages = {Storage::cube, Storage::dualParaboloid, Storage::octahedral};

Technique with(ProbeFormat format, Storage storage = Storage::cube, int resolution = 32) {
  Technique technique = withResolution(resolution);
  technique.format = format;
  technique.storage = storage;
  return technique;
}

// One unit in the last place of each channel of a colour below 1: drivers may round either way when they draw to a
// format (OpenGL 4.5 core, section 2.3.4).
vec3 lastPlace(ProbeFormat format, const vec3& color) {
  const auto relative = [&](vec3 share) { return share * color; };
  switch (format) {
    case ProbeFormat::rgba16f:
      return relative(vec3(std::exp2(-10.0f)));
    case ProbeFormat::r11fG11fB10f:
      return relative({std::exp2(-6.0f), std::exp2(-6.0f), std::exp2(-5.0f)});
    case ProbeFormat::rgb9e5:
      return vec3(std::exp2(-9.0f));  // the largest channel's exponent
    case ProbeFormat::rgba8Srgb:
      return vec3(0.009f);  // slope of the decoding at 1, 2.4 / 1.055, over 255
  }
  return {};
}

void expectNear(const vec3& value, const vec3& expected, const vec3& tolerance, const char* what) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(value[i], expected[i], tolerance[i]) << what << ", channel " << i;
}

TEST_P(RasterFormat, AConstantEnvironmentStaysConstantInEveryFormatAndStorage) {
  const vec3 color(0.3f, 0.6f, 0.9f);
  const auto snapshot = snapshotOf(makeBall(color, makeMirrorMaterial("mirror")));
  for (const ProbeFormat format : kFormats)
    for (const Storage storage : kStorages) {
      const Image image = render(*snapshot, with(format, storage));
      const vec3 middle = centreOf(image);
      expectNear(middle, color, lastPlace(format, color), "middle");
      // All of the ball alike: filtering can't make other colours of one, but for the sampler's weights.
      for (int x = 20; x < 44; ++x) expectNear(image(x, 26), middle, vec3(1e-6f), "ball");
    }
}

// Smooth enough for a probe of its own.
Material makeRoughMetal() {
  Material material = makeMirrorMaterial("metal");
  material.constants.kind.x = shading::kSurfaceGlossy;
  material.constants.factors.y = 0.25f;
  return material;
}

TEST_P(RasterFormat, LevelsOfAConstantEnvironmentAreConstantInEveryFormat) {
  const vec3 color(0.3f, 0.6f, 0.9f);
  const auto snapshot = snapshotOf(makeBall(color, makeRoughMetal()));
  for (const ProbeFormat format : kFormats)
    for (const ProbeFilter filter : {ProbeFilter::boxMips, ProbeFilter::ggxPrefiltered}) {
      Technique technique = with(format);
      technique.filter = filter;
      const Image face = capture(*snapshot, technique, 2)[3];
      ASSERT_EQ(face.width(), 8);
      // Each level is rounded once more than what it was made of.
      for (const vec3& texel : face) expectNear(texel, color, 3.0f * lastPlace(format, color), "level 2");
    }
}

// Radiances of all sizes around a mirror: one box before each face, and a sky.
Scene makeBoxes() {
  Scene scene = makeEmptyScene({0.013f, 0.4f, 0.09f});
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.5f, 16, 8)), addMaterial(scene, makeMirrorMaterial("mirror")));
  addBox(scene, {3, 0, 0}, vec3(2.0f), makeUnlit({1000, 0.001f, 0}));
  addBox(scene, {-3, 0, 0}, vec3(2.0f), makeUnlit({70000, 65000, 1}));
  addBox(scene, {0, 3, 0}, vec3(2.0f), makeUnlit({1e-6f, 3e-6f, 2e-7f}));
  addBox(scene, {0, -3, 0}, vec3(2.0f), makeUnlit({511.5f, 511.75f, 512}));
  addBox(scene, {0, 0, -3}, vec3(2.0f), makeUnlit({0.999f, 0.5f, 0.25f}));
  return scene;
}

// EXT_texture_shared_exponent, section 3.8.x.y, with N = 9 and B = 15, decoded again.
vec3 sharedExponent(const vec3& color) {
  const glm::dvec3 c = glm::clamp(glm::dvec3(color), 0.0, 65408.0);
  const double largest = std::max({c.x, c.y, c.z});
  int exponent = std::max(-16, largest > 0.0 ? std::ilogb(largest) : -16) + 16;
  if (std::floor(largest / std::exp2(exponent - 24) + 0.5) == 512.0) ++exponent;
  return {glm::floor(c / std::exp2(exponent - 24) + 0.5) * std::exp2(exponent - 24)};
}

TEST_P(RasterFormat, SharedExponentsAreThoseOfTheExtension) {
  const auto snapshot = snapshotOf(makeBoxes());
  const std::array<Image, 6> halves = capture(*snapshot, with(ProbeFormat::rgba16f));
  const std::array<Image, 6> shared = capture(*snapshot, with(ProbeFormat::rgb9e5));
  for (std::size_t f = 0; f < 6; ++f)
    for (std::size_t i = 0; i < halves[f].size(); ++i) ASSERT_EQ(shared[f][i], sharedExponent(halves[f][i])) << f;
  EXPECT_EQ(centreOf(shared[1]), vec3(65408, 65024, 0));
  EXPECT_EQ(centreOf(shared[3]), vec3(512));  // 511.5 rounds up to 512 of the larger exponent
}

TEST_P(RasterFormat, SmallFloatsKeepTheirBitsAndStopAtTheLargest) {
  const auto snapshot = snapshotOf(makeBoxes());
  const std::array<Image, 6> halves = capture(*snapshot, with(ProbeFormat::rgba16f));
  const std::array<Image, 6> small = capture(*snapshot, with(ProbeFormat::r11fG11fB10f));
  const vec3 denormal(std::exp2(-20.0f), std::exp2(-20.0f), std::exp2(-19.0f));  // the smallest steps
  for (std::size_t f = 0; f < 6; ++f)
    for (std::size_t i = 0; i < halves[f].size(); ++i) {
      const vec3 wanted = glm::min(halves[f][i], vec3(64512.0f));
      expectNear(small[f][i], wanted, glm::max(lastPlace(ProbeFormat::r11fG11fB10f, wanted), denormal), "texel");
    }
  EXPECT_EQ(centreOf(small[1]), vec3(64512, 64512, 1));
}

TEST_P(RasterFormat, BytesAreCutOffAtOneAndEncoded) {
  const auto snapshot = snapshotOf(makeBoxes());
  const std::array<Image, 6> halves = capture(*snapshot, with(ProbeFormat::rgba16f));
  const std::array<Image, 6> bytes = capture(*snapshot, with(ProbeFormat::rgba8Srgb));
  for (std::size_t f = 0; f < 6; ++f)
    for (std::size_t i = 0; i < halves[f].size(); ++i)
      for (int channel = 0; channel < 3; ++channel) {
        const float stored = shading::srgbEncode(bytes[f][i][channel]) * 255.0f;
        EXPECT_NEAR(stored, shading::srgbEncode(halves[f][i][channel]) * 255.0f, 1.0f) << "face " << f;
      }
  EXPECT_EQ(centreOf(bytes[1]), vec3(1));
}

// Radiance that tells directions apart and is smooth enough for small maps.
Environment makeLinearSky() {
  std::vector<ImageRgba> faces;
  for (int face = 0; face < 6; ++face) {
    ImageRgba& texels = faces.emplace_back(64, 64);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const glm::vec2 st((2.0f * static_cast<float>(x) + 1.0f) / 64.0f - 1.0f,
                           (2.0f * static_cast<float>(y) + 1.0f) / 64.0f - 1.0f);
        const vec3 d = glm::normalize(shading::cubeDirection(face, st));
        texels(x, y) = glm::vec4(vec3(0.5f) + 0.4f * d, 1.0f);
      }
  }
  return makeCubeEnvironment("linear", std::move(faces));
}

// A mirror ball that shows nearly all directions, so the maps' seams, too.
TEST_P(RasterFormat, EveryStorageShowsTheSameDirections) {
  Scene scene = makeBall(kBlack, makeMirrorMaterial("mirror"));
  scene.environment = makeLinearSky();
  const auto snapshot = snapshotOf(std::move(scene));
  const Image cube = render(*snapshot, with(ProbeFormat::rgba16f, Storage::cube, 64));
  EXPECT_GT(glm::distance(cube(20, 32), cube(44, 32)), 0.3f);
  for (const Storage storage : {Storage::dualParaboloid, Storage::octahedral}) {
    const Image other = render(*snapshot, with(ProbeFormat::rgba16f, storage, 64));
    // Slopes jump by up to 0.8 at the edges of cubes and octahedra. There interpolation between texels h = 2/64 apart
    // errs by h / 4 times the jump. A texel from the wrong place would be off by h times the slope, 1.2e-2.
    EXPECT_LT(largestDifference(cube, other), 6e-3f);
  }
}

TEST_P(RasterFormat, ConversionsAreCounted) {
  const auto snapshot = snapshotOf(makeBall(kWhite, makeMirrorMaterial("mirror")));
  const auto countersOf = [&](const Technique& technique) {
    RasterSequence sequence(device(), technique, 16, 16, 1);
    return sequence.renderFrame(*snapshot).counters;
  };
  EXPECT_EQ(countersOf(with(ProbeFormat::rgba16f)).texelsFiltered, 0);
  EXPECT_EQ(countersOf(with(ProbeFormat::rgb9e5)).texelsFiltered, 6 * 32 * 32);
  // sqrt(6) * 32 = 78.4
  EXPECT_EQ(countersOf(with(ProbeFormat::r11fG11fB10f, Storage::octahedral)).texelsFiltered, 82 * 82);
  EXPECT_EQ(countersOf(with(ProbeFormat::r11fG11fB10f, Storage::octahedral)).probeBytes, 4 * (82 * 82 + 6 * 32 * 32));
}

// Walls of one colour each fill the six faces, so any mixture comes from filtering across an edge.
Scene makeRoom() {
  Scene scene = makeEmptyScene(kBlack);
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.5f, 32, 16)),
              addMaterial(scene, makeMirrorMaterial("mirror")));
  for (const vec3& axis : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)})
    for (const float side : {1.0f, -1.0f})
      addBox(scene, 6.0f * side * axis, vec3(11.0f) - 10.0f * axis, makeUnlit(vec3(0.5f) + 0.5f * side * axis));
  return scene;
}

bool isWall(const vec3& color) {
  int halves = 0;
  for (int i = 0; i < 3; ++i) halves += color[i] == 0.5f ? 1 : 0;
  return halves == 2 && (glm::compMax(color) == 1.0f || glm::compMin(color) == 0.0f);
}

TEST_P(RasterFormat, WithoutSeamlessFilteringFacesDontMix) {
  const auto snapshot = snapshotOf(makeRoom());
  const auto mixedPixels = [&](const Technique& technique) {
    const Image image = render(*snapshot, technique);
    return std::count_if(image.begin(), image.end(), [](const vec3& c) { return !isWall(c); });
  };
  Technique technique = withResolution(8);
  EXPECT_GT(mixedPixels(technique), 50);
  technique.seamless = false;
  EXPECT_EQ(mixedPixels(technique), 0);
}

TEST_P(RasterFormat, SeamlessnessOfTheEnvironmentIsNotTheProbes) {
  Scene scene = makeBall(kBlack, makeMirrorMaterial("mirror"));
  std::vector<ImageRgba> faces;
  for (int face = 0; face < 6; ++face) faces.emplace_back(2, 2, glm::vec4(vec3(0.1f * static_cast<float>(face)), 1));
  scene.environment = makeCubeEnvironment("coarse", std::move(faces));
  const auto snapshot = snapshotOf(std::move(scene));
  Technique technique = withResolution(32);
  technique.textureFilter = TextureFilter::hardware;
  technique.probes = ProbeUse::environmentOnly;
  const Image seamless = render(*snapshot, technique);
  technique.seamless = false;
  EXPECT_EQ(render(*snapshot, technique), seamless);
}

// Stripes that are narrower than a pixel of the ball's picture.
Scene makeStripes() {
  Scene scene = makeEmptyScene(vec3(0.5f));
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.5f, 64, 32)),
              addMaterial(scene, makeMirrorMaterial("mirror")));
  for (int i = -30; i <= 30; ++i)
    addBox(scene, {0.4f * static_cast<float>(i), 0, 6}, {0.2f, 20, 0.1f}, makeUnlit(kWhite));
  return scene;
}

TEST_P(RasterFormat, MipmapsShowMeansWhereTexelsAreSmallerThanPixels) {
  const auto snapshot = snapshotOf(makeStripes());
  Technique technique = withResolution(256);
  constexpr int kPixels = 24;
  const Image truth = render(*snapshot, technique, kPixels, kPixels, 16);
  const auto error = [&](const Image& image) {
    double sum = 0.0;
    for (int y = 10; y < 14; ++y)
      for (int x = 8; x < 16; ++x) sum += double{std::pow(image(x, y).x - truth(x, y).x, 2.0f)};
    return sum;
  };
  const double without = error(render(*snapshot, technique, kPixels, kPixels, 1));
  technique.mips = true;
  const double with = error(render(*snapshot, technique, kPixels, kPixels, 1));
  EXPECT_LT(with, 0.25 * without);
}

TEST_P(RasterFormat, MipmapsAreMadeByEachCaptureAndCounted) {
  const auto snapshot = snapshotOf(makeBall(kWhite, makeMirrorMaterial("mirror")));
  Technique technique = withResolution(16);
  technique.mips = true;
  RasterSequence sequence(device(), technique, 16, 16, 1);
  const FrameCounters counters = sequence.renderFrame(*snapshot).counters;
  EXPECT_EQ(counters.texelsFiltered, 6 * (8 * 8 + 4 * 4 + 2 * 2 + 1));
  EXPECT_EQ(counters.probeBytes, 8 * 6 * (16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1));
}

// Large pictures of a map read level 0 alone.
TEST_P(RasterFormat, MipmapsChangeNothingWhereTexelsAreLargerThanPixels) {
  const auto snapshot = snapshotOf(makeRoom());
  Technique technique = withResolution(8);
  const Image level0 = render(*snapshot, technique, 128, 128);
  for (const ProbeFilter filter : {ProbeFilter::none, ProbeFilter::ggxPrefiltered}) {
    technique.filter = filter;
    technique.mips = true;
    const Image image = render(*snapshot, technique, 128, 128);
    // But at the ball's edge, where pixels see wide angles: its picture is 50 pixels wide.
    for (int y = 50; y < 78; ++y)
      for (int x = 50; x < 78; ++x) EXPECT_EQ(image(x, y), level0(x, y));
  }
}

TEST_P(RasterFormat, WhatCannotBeIsRefusedBeforeAnythingIsRendered) {
  const auto mirror = snapshotOf(makeBall(kWhite, makeMirrorMaterial("mirror")));
  const auto rough = snapshotOf(makeBall(kWhite, makeRoughMetal()));
  const auto check = [&](const Technique& technique, const Snapshot& snapshot) {
    return messageOf([&] { RasterSequence::check(device(), technique, snapshot, 16, 16, 1); });
  };
  const Technique octahedral = with(ProbeFormat::rgba16f, Storage::octahedral);
  EXPECT_EQ(check(octahedral, *mirror), "no error");
  EXPECT_THAT(check(octahedral, *rough), testing::HasSubstr("filter must be none"));
  Technique mips = octahedral;
  mips.mips = true;
  EXPECT_THAT(check(mips, *mirror), testing::HasSubstr("mips must be off"));
  Scene scene = makeEmptyScene(kWhite);
  const int material = addMaterial(scene, makeMirrorMaterial("mirror"));
  const auto ball = finishMesh(makeSphereMesh(0.1f, 8, 4));
  for (int i = 0; i < 64; ++i) {
    Node node;
    node.translation = {i, 0, 0};
    addInstance(scene, "ball" + std::to_string(i), ball, material, node);
  }
  // 64 cubes of 6 * 4096^2 texels: 48 GiB in halves, 24 GiB in bytes.
  const auto many = snapshotOf(std::move(scene));
  EXPECT_THAT(check(withResolution(4096), *many), testing::HasSubstr("49"));
  EXPECT_THAT(check(with(ProbeFormat::rgba8Srgb, Storage::cube, 4096), *many), testing::HasSubstr("24"));
}

}  // namespace
}  // namespace pb
