// What the camera sees: orientation, visibility, sampling, ids.
#include <gtest/gtest.h>

#include <limits>

#include "scenes/builtin/shapes.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

class RasterFrame : public RasterTest {};

INSTANTIATE_TEST_SUITE_P(Gl, RasterFrame, kBackends, nameOfBackend);

TEST_P(RasterFrame, TopRowIsUpAndFirstColumnIsLeft) {
  Scene scene = makeEmptyScene(kBlack);
  addBox(scene, vec3(-0.6f, 0.6f, 0), vec3(0.2f), makeUnlit(kRed));
  const Image image = render(*snapshotOf(std::move(scene)));
  EXPECT_EQ(image(16, 16), kRed);
  EXPECT_EQ(image(48, 16), kBlack);
  EXPECT_EQ(image(16, 48), kBlack);
}

TEST_P(RasterFrame, NearHidesFarWhateverIsDrawnLast) {
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

// Its light, which shaders know as constants, is not finite.
TEST_P(RasterFrame, SkyAsBrightAsFloatsGoIsRendered) {
  Scene scene = makeEmptyScene(vec3(std::numeric_limits<float>::max()));
  scene.environment.ambient.constant = glm::vec4(std::numeric_limits<float>::infinity());
  addBox(scene, vec3(0), vec3(0.5f), makeUnlit(kRed));
  const Image image = render(*snapshotOf(std::move(scene)));
  EXPECT_EQ(centreOf(image), kRed);
  EXPECT_GT(image(2, 2).x, 6e4f);
}

TEST_P(RasterFrame, BackFacesAreSeenOnDoubleSidedMaterialsOnly) {
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

TEST_P(RasterFrame, MirroredInstanceShowsItsOutside) {
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

TEST_P(RasterFrame, SamplesAreAveragedOverThePixel) {
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

TEST_P(RasterFrame, IdsNameInstanceGroupAndNearestTexel) {
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

TEST_P(RasterFrame, SameInputsGiveTheSameBits) {
  Technique technique = withResolution(32);
  technique.bounces = 2;
  const auto snapshot = snapshotOf("mirrors?count=3");
  EXPECT_EQ(render(*snapshot, technique, 96, 54, 2), render(*snapshot, technique, 96, 54, 2));
}

}  // namespace
}  // namespace pb
