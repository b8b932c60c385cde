// Emissive screens in the rasteriser, on both GL backends.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/screen.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

using RasterScreens = RasterTest;
INSTANTIATE_TEST_SUITE_P(Gl, RasterScreens, kBackends, nameOfBackend);

constexpr int kTexels = 8;

// A screen that fills the image, unfiltered, black but for what it emits.
std::shared_ptr<const Scene> makeScreenScene() {
  Scene scene = makeEmptyScene(kBlack);
  Screen screen;
  screen.widthPx = screen.heightPx = kTexels;
  screen.periodSeconds = 2.0f;
  scene.screens.push_back(screen);
  Material material = makeDiffuseMaterial("screen", vec3(0.0f));
  showScreen(material, 0);
  material.constants.emissionSlot.sampler_ = {shading::kWrapClamp, shading::kWrapClamp, shading::kFilterNearest,
                                              shading::kFilterNearest};
  const float half = 3.0f * std::tan(0.4f);  // of the image's height at z = 0
  // Texture coordinates grow to the right and, as the second row of texels lies below the first, downwards.
  addInstance(scene, "screen",
              finishMesh(makeQuadMesh(vec3(-half, -half, 0), vec3(2 * half, 0, 0), vec3(0, 2 * half, 0))),
              addMaterial(scene, material));
  finishScene(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

// Each texel covers 8 x 8 pixels of which the middle one is looked at.
void expectTexels(const Image& image, const Texture& screen) {
  const ImageRgba& texels = screen.levels.front();
  const bool flipped = image(4, 4) != vec3(texels(0, 0));
  for (int y = 0; y < kTexels; ++y)
    for (int x = 0; x < kTexels; ++x)
      EXPECT_EQ(image(8 * x + 4, 8 * (flipped ? kTexels - 1 - y : y) + 4), vec3(texels(x, y))) << x << " " << y;
}

TEST_P(RasterScreens, ShowTheTexelsOfTheSnapshotsTime) {
  const auto scene = makeScreenScene();
  const auto first = makeSnapshot(scene, 0, "", 1.0), later = makeSnapshot(scene, 20, "", 1.0);
  ASSERT_NE(first->screens.front().levels.front(), later->screens.front().levels.front());
  RasterSequence sequence(device(), withResolution(8), 64, 64, 1), other(device(), withResolution(8), 64, 64, 1);
  for (const auto& snapshot : {first, later, first}) {
    sequence.renderFrame(*snapshot);
    expectTexels(sequence.readImage(), snapshot->screens.front());
    other.renderFrame(*later);  // shares the device's textures
    expectTexels(other.readImage(), later->screens.front());
  }
}

TEST_P(RasterScreens, AreSeenInMirrors) {
  Scene scene = *makeScreenScene();
  Node node;
  node.translation = vec3(0, 0, 6);
  addInstance(scene, "mirror", finishMesh(makeSphereMesh(0.5f, 16, 8)),
              addMaterial(scene, makeMirrorMaterial("mirror")), node);
  RasterSequence sequence(device(), withResolution(64), 16, 16, 1);
  sequence.renderFrame(*snapshotOf(std::move(scene)));
  const Image face = sequence.readProbe(0)[5];  // looks along -Z
  vec3 sum(0.0f);
  for (const vec3& texel : face) sum += texel;
  EXPECT_GT(sum.x + sum.y + sum.z, 0.0f);
}

}  // namespace
}  // namespace pb
