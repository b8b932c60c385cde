// How surfaces look: diffuse light, textures, mirrors and glass.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/environment.h"
#include "scenes/error.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

class RasterSurface : public RasterTest {};

INSTANTIATE_TEST_SUITE_P(Gl, RasterSurface, kBackends, nameOfBackend);

TEST_P(RasterSurface, DiffuseSurfaceHasTheRadianceOfTheSharedModel) {
  Scene scene = makeEmptyScene(vec3(0.25f));
  addDirectionalLight(scene, "light", vec3(0, 0.6f, 0.8f), vec3(2.0f));
  addBox(scene, vec3(0), vec3(1.0f), makeDiffuseMaterial("grey", vec3(0.5f)));
  // Lambert: albedo (E cos / pi + ambient), with cos = 0.8 on the side towards +Z.
  const float expected = 0.5f * (2.0f * 0.8f / shading::kPi + 0.25f);
  EXPECT_NEAR(centreOf(render(*snapshotOf(std::move(scene)))).x, expected, 1e-5f);
}

// 256 lights fit into a uniform block, more come from a storage block. Sums of 257 terms round by less than 257 half
// units in the last place.
TEST_P(RasterSurface, OneLightLooksAsTwoHundredAndFiftySevenOfItsParts) {
  const auto litBy = [&](int lights) {
    Scene scene = makeEmptyScene(vec3(0.0f));
    for (int i = 0; i < lights; ++i)
      addDirectionalLight(scene, "light", vec3(0, 0.6f, 0.8f), vec3(2.0f / static_cast<float>(lights)));
    addBox(scene, vec3(0), vec3(1.0f), makeDiffuseMaterial("grey", vec3(0.5f)));
    return centreOf(render(*snapshotOf(std::move(scene)))).x;
  };
  const float one = litBy(1);
  EXPECT_GT(one, 0.0f);
  EXPECT_NEAR(litBy(256), one, 256 * 6e-8f * one);
  EXPECT_NEAR(litBy(257), one, 257 * 6e-8f * one);
}

TEST_P(RasterSurface, HardwareTexturesAreNearExactOnes) {
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

TEST_P(RasterSurface, PerfectMirrorVanishesInAWhiteFurnace) {
  for (const ProbeUse use : {ProbeUse::dynamic, ProbeUse::environmentOnly}) {
    Technique technique = withResolution(16);
    technique.probes = use;
    for (const vec3& pixel : render(*snapshotOf(makeBall(kWhite, makeMirrorMaterial("mirror"))), technique))
      ASSERT_EQ(pixel, kWhite);
  }
}

TEST_P(RasterSurface, GlassOfIndexOneIsInvisible) {
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

TEST_P(RasterSurface, GlassConservesEnergyInAWhiteFurnace) {
  for (const vec3& pixel : render(*snapshotOf(makeBall(kWhite, makeGlass(1.5f))))) ASSERT_NEAR(pixel.x, 1.0f, 1e-5f);
}

// The hardware knows orientation and seams of cube maps by itself; the exact filter has them from shading/cubemap.glsl.
TEST_P(RasterSurface, EnvironmentFacesLookAlikeThroughBothFilters) {
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

TEST_P(RasterSurface, MirrorWithoutProbesShowsTheEnvironment) {
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

}  // namespace
}  // namespace pb
