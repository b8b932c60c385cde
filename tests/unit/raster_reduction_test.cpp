// Captures that are reduced: textures, lights, distance and triangles. The final image is never reduced.
#include <gtest/gtest.h>

#include <cmath>

#include "raster/plain_material.h"
#include "raster/simplify.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

constexpr int kFace = 32;

class RasterReduction : public RasterTest {
 protected:
  struct Result {
    std::array<Image, 6> faces;
    Image image;
    FrameCounters counters;
  };

  Result renderAll(const Snapshot& snapshot, const Technique& technique) {
    RasterSequence sequence(device(), technique, 64, 64, 1);
    const FrameCounters counters = sequence.renderFrame(snapshot).counters;
    return {sequence.readProbe(0), sequence.readImage(), counters};
  }
};

INSTANTIATE_TEST_SUITE_P(Gl, RasterReduction, kBackends, nameOfBackend);

Technique reduced(void (*reduce)(Technique&)) {
  Technique technique = withResolution(kFace);
  reduce(technique);
  return technique;
}

void addMirrorBall(Scene& scene) {
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.5f, 16, 8)),
              addMaterial(scene, makeMirrorMaterial("mirror", vec3(1.0f))));
}

// Behind the ball, seen by the camera beside it and by the face -Z: 2 x 2 squares.
std::shared_ptr<const Snapshot> checkeredRoom(Material material) {
  Scene scene = makeEmptyScene(kBlack);
  addMirrorBall(scene);
  ImageRgba texels(2, 2, glm::vec4(0, 0, 0, 1));
  texels(0, 0) = texels(1, 1) = {1, 0.5f, 0.25f, 1};
  material.baseColorTexture = addTexture(scene, makeTexture("checker", texels));
  addInstance(scene, "wall", finishMesh(makeQuadMesh({-4, -4, -2}, {8, 0, 0}, {0, 8, 0})),
              addMaterial(scene, std::move(material)));
  return snapshotOf(std::move(scene));
}

TEST_P(RasterReduction, WithoutTexturesCapturesShowTheirMean) {
  const auto snapshot = checkeredRoom(makeUnlit(kWhite));
  const Result whole = renderAll(*snapshot, withResolution(kFace));
  const Result plain = renderAll(*snapshot, reduced([](Technique& t) { t.captureTextures = false; }));
  // Two of the four texels; halves represent the means exactly.
  for (const vec3& texel : plain.faces[5]) EXPECT_EQ(texel, vec3(0.5f, 0.25f, 0.125f));
  EXPECT_NE(whole.faces[5](kFace / 8, kFace / 8), whole.faces[5](kFace / 8, 7 * kFace / 8));
  // Beside the ball's picture the image shows the wall itself.
  EXPECT_EQ(plain.image(4, 4), whole.image(4, 4));
  EXPECT_EQ(plain.image(4, 60), whole.image(4, 60));
  EXPECT_NE(plain.image(4, 4), plain.image(4, 60));
}

TEST_P(RasterReduction, WithoutTexturesHolesStay) {
  Material material = makeUnlit(kWhite);
  material.constants.alpha = {shading::kAlphaMask, 0.5f, 0, 0};
  Scene scene = makeEmptyScene(kBlack);
  addMirrorBall(scene);
  ImageRgba texels(2, 1, glm::vec4(1, 1, 1, 1));
  texels(0, 0).w = 0.0f;
  material.baseColorTexture = addTexture(scene, makeTexture("hole", texels));
  material.constants.baseColorSlot.sampler_ = {shading::kWrapClamp, shading::kWrapClamp, shading::kFilterNearest,
                                               shading::kFilterNearest};
  addInstance(scene, "wall", finishMesh(makeQuadMesh({-4, -4, -2}, {8, 0, 0}, {0, 8, 0})),
              addMaterial(scene, material));
  const auto snapshot = snapshotOf(std::move(scene));
  const Result plain = renderAll(*snapshot, reduced([](Technique& t) { t.captureTextures = false; }));
  EXPECT_EQ(plain.faces, renderAll(*snapshot, withResolution(kFace)).faces);
}

TEST_P(RasterReduction, WithoutLightsCapturesShowEmissionAndAmbientLight) {
  const auto room = [](bool isLit) {
    Scene scene = makeEmptyScene(vec3(0.25f));
    addMirrorBall(scene);
    Material wall = makeDiffuseMaterial("wall", vec3(0.5f));
    wall.constants.emission = {0.125f, 0, 0, 1};
    addBox(scene, {0, 0, -3}, {8, 8, 1}, wall);
    if (isLit) addDirectionalLight(scene, "light", {0, 0.6f, 0.8f}, vec3(2.0f));
    return snapshotOf(std::move(scene));
  };
  const Technique dark = reduced([](Technique& t) { t.captureLights = false; });
  const Result lit = renderAll(*room(true), dark);
  // Albedo 0.5 under radiance 0.25 from all around; the wall's own area light would add to it.
  EXPECT_NEAR(lit.faces[5](kFace / 2, kFace / 2).x, 0.125f + 0.125f, 1e-3f);  // half floats
  EXPECT_EQ(lit.faces, renderAll(*room(false), dark).faces);
  EXPECT_EQ(lit.image(4, 4), renderAll(*room(true), withResolution(kFace)).image(4, 4));
}

// A floor at y = -1 fills the lower half of the face +X, whose texels see it at 1 / t along +X.
TEST_P(RasterReduction, BeyondTheFarPlaneCapturesShowTheEnvironment) {
  Scene scene = makeEmptyScene(kBlue);
  addMirrorBall(scene);
  addInstance(scene, "floor", finishMesh(makeQuadMesh({-50, -1, 50}, {100, 0, 0}, {0, 0, -100})),
              addMaterial(scene, makeUnlit(kRed)));
  addBox(scene, {20, 8, 0}, vec3(4.0f), makeUnlit(kWhite));
  const auto snapshot = snapshotOf(std::move(scene));
  const Result near = renderAll(*snapshot, reduced([](Technique& t) { t.captureFar = 4.0f; }));
  const Result whole = renderAll(*snapshot, withResolution(kFace));
  for (int y = 0; y < kFace; ++y) {
    const double t = (2.0 * y + 1.0) / kFace - 1.0;
    EXPECT_EQ(near.faces[0](kFace / 2, y), t > 0.25 ? kRed : kBlue) << "row " << y;
    EXPECT_EQ(whole.faces[0](2, y), t > 0.02 ? kRed : kBlue) << "row " << y;
  }
  EXPECT_EQ(near.image(2, 60), whole.image(2, 60));
  EXPECT_LT(near.counters.draws, whole.counters.draws);  // the box is culled
  EXPECT_EQ(renderAll(*snapshot, reduced([](Technique& t) { t.captureFar = 1000.0f; })).faces, whole.faces);
}

TEST(PlainMaterial, HasTheMeansOfItsTexturesInItsConstants) {
  const auto textureOf = [](glm::vec4 a, glm::vec4 b) {
    ImageRgba texels(2, 1, a);
    texels(1, 0) = b;
    return makeTexture("two texels", texels);
  };
  Scene scene;
  Material material = makeDiffuseMaterial("material", vec3(0.5f));
  material.constants.factors = {1.0f, 0.5f, 1.0f, 0.0f};
  material.constants.emission = {2, 2, 2, 0.75f};
  material.baseColorTexture = addTexture(scene, textureOf({1, 1, 0, 1}, {0, 1, 0, 1}));
  material.metallicRoughnessTexture = addTexture(scene, textureOf({0, 1, 0.5f, 1}, {0, 0.5f, 0, 1}));
  material.emissionTexture = addTexture(scene, textureOf({1, 0, 0, 1}, {0, 0.5f, 0, 1}));
  shading::MaterialConstants plain = plainConstants(scene, {}, material);
  EXPECT_EQ(vec3(plain.baseColor), vec3(0.25f, 0.5f, 0.0f));
  EXPECT_EQ(plain.factors.x, 0.25f);   // metallic
  EXPECT_EQ(plain.factors.y, 0.375f);  // roughness
  EXPECT_EQ(plain.emission, glm::vec4(1, 0.5f, 0, 0.75f));

  // Screens replace the emission texture; textures that make holes stay.
  material.screen = 0;
  material.constants.alpha.x = shading::kAlphaBlend;
  plain = plainConstants(scene, {textureOf({0, 0, 1, 1}, {0, 0, 0, 1})}, material);
  EXPECT_EQ(vec3(plain.emission), vec3(0, 0, 1));
  EXPECT_EQ(vec3(plain.baseColor), vec3(0.5f));
}

TEST(Simplify, LeavesTheWantedShareOfASmoothMesh) {
  const auto mesh = finishMesh(makeSphereMesh(1.0f, 64, 32));
  for (const float share : {0.5f, 0.25f, 0.05f}) {
    const std::vector<std::uint32_t> indices = simplifiedTriangles(*mesh, share);
    const double left = static_cast<double>(indices.size()) / static_cast<double>(mesh->indices.size());
    EXPECT_LE(left, double{share} + 0.002) << share;
    EXPECT_GE(left, 0.9 * double{share}) << share;
    for (const std::uint32_t index : indices) ASSERT_LT(index, mesh->positions.size());
    EXPECT_EQ(indices, simplifiedTriangles(*mesh, share));
  }
}

TEST(Simplify, KeepsWhatCannotBeSimpler) {
  const auto box = finishMesh(makeBoxMesh(vec3(1.0f)));
  EXPECT_EQ(simplifiedTriangles(*box, 1.0f), box->indices);
  EXPECT_EQ(simplifiedTriangles(*box, 0.01f).size(), box->indices.size());  // edges are hard
  const auto quad = finishMesh(makeQuadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_EQ(simplifiedTriangles(*quad, 0.01f).size(), quad->indices.size());
}

// The smooth ball behind the mirror is seen by one face, and by the camera as a ring around the mirror.
TEST_P(RasterReduction, SimplifiedMeshesAreDrawnInCapturesOnly) {
  Scene scene = makeEmptyScene(kBlue);
  addMirrorBall(scene);
  Node behind;
  behind.translation = {0, 0, -4};
  const auto mesh = finishMesh(makeSphereMesh(1.5f, 64, 32));
  addInstance(scene, "other", mesh, addMaterial(scene, makeUnlit(kRed)), behind);
  const auto snapshot = snapshotOf(std::move(scene));
  const Result whole = renderAll(*snapshot, withResolution(kFace));
  const Result simple = renderAll(*snapshot, reduced([](Technique& t) { t.captureLod = 0.1f; }));
  const auto dropped = static_cast<std::int64_t>((mesh->indices.size() - simplifiedTriangles(*mesh, 0.1f).size()) / 3);
  EXPECT_EQ(whole.counters.triangles - simple.counters.triangles, dropped);
  EXPECT_EQ(whole.counters.draws, simple.counters.draws);
  // The same disc but for its outline: 0.1 of 3968 triangles are some 14 x 14 quads, whose chords lie 1 - cos(pi/28) =
  // 0.6 % inside; a texel is 6 % of the face's half width.
  EXPECT_EQ(simple.faces[5](kFace / 2, kFace / 2), kRed);
  int different = 0;
  for (std::size_t i = 0; i < simple.faces[5].size(); ++i) different += simple.faces[5][i] != whole.faces[5][i] ? 1 : 0;
  EXPECT_LE(different, 12);
  // The mirror ball covers 13 pixels around the middle, the other one 16.
  EXPECT_EQ(simple.image(32, 17), kRed);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      if (std::hypot(x - 31.5, y - 31.5) > 14.0) {
        EXPECT_EQ(simple.image(x, y), whole.image(x, y));
      }
    }
  EXPECT_EQ(renderAll(*snapshot, reduced([](Technique& t) { t.captureLod = 0.1f; })).faces, simple.faces);
}

}  // namespace
}  // namespace pb
