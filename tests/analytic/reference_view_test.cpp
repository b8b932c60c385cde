// What the rays of the reference renderer meet: views, near plane, hidden instances, sides, transforms, ids.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "reference/renderer.h"
#include "scenes/builtin/shapes.h"
#include "tests/analytic/reference_scenes.h"

namespace pb {
namespace {

using namespace test;

const glm::vec3 kRed(1, 0, 0), kGreen(0, 1, 0), kBlue(0, 0, 1), kBlack(0, 0, 0);
const ReferenceSettings kOneSample{.samplesPerAxis = 1, .spp = 2};

// Directions of the texels of a cube map, OpenGL 4.5 core, table 8.19: major axis, sc and tc.
struct FaceAxes {
  glm::vec3 major, s, t;
};
const std::array<FaceAxes, 6> kFaces = {{{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                         {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                         {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                         {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                         {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},
                                         {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}}};

TEST(CubeFaceView, ShowsEachDirectionInTheTexelThatGlNames) {
  constexpr int kSize = 8, kColumn = 6, kRow = 1;
  const glm::vec3 centre(3.0f, -2.0f, 1.0f);
  for (int face = 0; face < 6; ++face) {
    const FaceAxes& axes = kFaces[static_cast<std::size_t>(face)];
    const float s = (2.0f * kColumn + 1.0f) / kSize - 1.0f, t = (2.0f * kRow + 1.0f) / kSize - 1.0f;
    Scene scene = makeSceneUnder(makeConstantEnvironment(kBlack));
    Node node;
    node.translation = centre + 5.0f * (axes.major + s * axes.s + t * axes.t);
    add(scene, makeBoxMesh(glm::vec3(0.2f)), makeEmitter(kRed), node);
    const Image image = ReferenceScene(finish(std::move(scene)))
                            .render(cubeFaceView(centre, face, 0.01f), kSize, kSize, kOneSample)
                            .mean();
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        EXPECT_EQ(image(x, y), x == kColumn && y == kRow ? kRed : kBlack) << "face " << face << ": " << x << " " << y;
  }
}

TEST(NearPlane, IsFlat_AndHidesWhatLiesBeforeIt) {
  const auto render = [](float zNear) {
    Scene scene = makeSceneUnder(makeConstantEnvironment(kBlack));
    add(scene, makeSquareMesh({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, 5.0f), makeEmitter(kRed));
    add(scene, makeSquareMesh({0, 0, -2}, {1, 0, 0}, {0, 1, 0}, 5.0f), makeEmitter(kGreen));
    addCamera(scene, "camera", {0, 0, 0}, {0, 0, -1}, glm::radians(90.0f), zNear);
    const auto snapshot = finish(std::move(scene));
    return ReferenceScene(snapshot).render(snapshot->camera, 16, 16, kOneSample).mean();
  };
  // At the picture's corners the red square is 1.7 m from the eye, but 1 m along the view's axis.
  EXPECT_EQ(render(0.99f), Image(16, 16, kRed));
  EXPECT_EQ(render(1.01f), Image(16, 16, kGreen));
}

TEST(NearPlane, DoesNotClipReflections) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(kBlack));
  add(scene, makeSquareMesh({0, 0, -3}, {1, 0, 0}, {0, 1, 0}, 5.0f), makeMirrorMaterial("mirror"));
  add(scene, makeSquareMesh({0, 0, -2.9f}, {-1, 0, 0}, {0, 1, 0}, 5.0f), makeEmitter(kGreen));
  addCamera(scene, "camera", {0, 0, 0}, {0, 0, -1}, glm::radians(90.0f), 2.95f);
  const auto snapshot = finish(std::move(scene));
  EXPECT_EQ(ReferenceScene(snapshot).render(snapshot->camera, 4, 4, kOneSample).mean(), Image(4, 4, kGreen));
}

// A red square before a mirror in which a blue one is seen; both coloured squares face the mirror's viewer or the
// mirror.
TEST(HiddenInstances, AreThereForNoRay) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(kBlack));
  const int red = add(scene, makeSquareMesh({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, 5.0f), makeEmitter(kRed));
  add(scene, makeSquareMesh({0, 0, -2}, {1, 0, 0}, {0, 1, 0}, 5.0f), makeMirrorMaterial("mirror"));
  const int blue = add(scene, makeSquareMesh({0, 0, 1}, {-1, 0, 0}, {0, 1, 0}, 5.0f), makeEmitter(kBlue));
  const auto snapshot = finish(std::move(scene));
  const auto seen = [&](std::vector<int> hidden) {
    return radianceAlong(snapshot, {0, 0, 0}, {0, 0, -1}, {.hiddenInstances = std::move(hidden)});
  };
  EXPECT_EQ(seen({}), kRed);
  EXPECT_EQ(seen({red}), kBlue);
  EXPECT_EQ(seen({blue, red}), kBlack);
}

struct Side {
  bool doubleSided;
  bool mirrored;
  bool fromFront;
  bool lit;      // the light shines on the side that is looked at
  float albedo;  // that the pixel shows; 0.5 is the environment's radiance
};
class Sides : public testing::TestWithParam<Side> {};

// A white square in the plane z = 0 whose front is +Z, with a light that gives pi W/m^2 to the front or to the back.
TEST_P(Sides, AreSeenAsTheMaterialAndTheTransformSay) {
  const Side& c = GetParam();
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.5f)));
  scene.environment.ambient = constantAmbient(glm::vec3(0.0f));
  Material white = makeDiffuseMaterial("white", glm::vec3(1.0f));
  white.doubleSided = c.doubleSided;
  Node node;
  node.scale.x = c.mirrored ? -1.0f : 1.0f;
  add(scene, makeSquareMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f), white, node);
  const float viewer = c.fromFront ? 1.0f : -1.0f;
  addDirectionalLight(scene, "light", {0, 0, c.lit ? viewer : -viewer}, glm::vec3(shading::kPi));
  const glm::vec3 seen = radianceAlong(finish(std::move(scene)), {0.2f, 0.1f, viewer}, {0, 0, -viewer});
  EXPECT_NEAR(seen.x, c.albedo, 1e-6f);
}

INSTANTIATE_TEST_SUITE_P(All, Sides,
                         testing::Values(Side{false, false, true, true, 1.0f}, Side{false, false, true, false, 0.0f},
                                         Side{false, false, false, true, 0.5f}, Side{true, false, true, true, 1.0f},
                                         Side{true, false, false, true, 1.0f}, Side{true, false, false, false, 0.0f},
                                         Side{false, true, true, true, 1.0f}, Side{false, true, false, true, 0.5f},
                                         Side{true, true, false, true, 1.0f}, Side{true, true, false, false, 0.0f}));

// A ball scaled by (a, b, c) is the ellipsoid whose normal at p is p / (a^2, b^2, c^2), whatever the scales' signs.
TEST(Transforms, NonUniformAndMirroredScales_KeepNormalsAcross) {
  for (const glm::vec3& scale :
       {glm::vec3(2.0f, 0.5f, 1.0f), glm::vec3(-2.0f, 0.5f, 1.0f), glm::vec3(-1.0f, -2.0f, -0.7f)}) {
    Scene scene = makeSceneUnder(makeConstantEnvironment(kBlack));
    scene.environment.ambient = constantAmbient(glm::vec3(0.0f));
    const glm::vec3 toLight = glm::normalize(glm::vec3(0.3f, 0.4f, 0.8f));
    addDirectionalLight(scene, "light", toLight, glm::vec3(shading::kPi));
    Node node;
    node.scale = scale;
    add(scene, makeSphereMesh(1.0f, 256, 128), makeDiffuseMaterial("white", glm::vec3(1.0f)), node);
    const ReferenceScene reference(finish(std::move(scene)));
    for (const glm::vec2& xy : {glm::vec2(0.1f, 0.2f), glm::vec2(-0.5f, 0.3f), glm::vec2(0.4f, -0.6f)}) {
      const glm::vec3 onSphere(xy, std::sqrt(1.0f - glm::dot(xy, xy)));
      const glm::vec3 p = glm::abs(scale) * onSphere;
      const float expected = std::max(glm::dot(glm::normalize(p / (scale * scale)), toLight), 0.0f);
      // Second order in the angle of a segment, 6e-4, which the scales turn into at most 4 times as much.
      EXPECT_NEAR(reference.radiance({p.x, p.y, 5.0f}, {0, 0, -1}, {}, 0).x, expected, 1e-3f);
    }
  }
}

// A grid of triangles under rays that meet thousands of points of its edges. Without Embree's robust mode 567 of these
// 7350 rays slip through. (Exactly through a vertex some still do, 30 of 3675: no sign of an edge is certain there.)
TEST(SharedEdges, LetNoRayThrough) {
  constexpr int kSegments = 37;
  Mesh mesh;
  mesh.name = "grid";
  for (int y = 0; y <= kSegments; ++y)
    for (int x = 0; x <= kSegments; ++x)
      mesh.positions.emplace_back(0.1f * static_cast<float>(x), 0.1f * static_cast<float>(y),
                                  0.01f * static_cast<float>(x * y % 3));
  for (std::uint32_t y = 0; y < kSegments; ++y)
    for (std::uint32_t x = 0; x < kSegments; ++x) {
      const std::uint32_t a = y * (kSegments + 1) + x, b = a + 1, c = a + kSegments + 2, d = a + kSegments + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  const std::vector<glm::vec3> vertices = mesh.positions;
  Scene scene = makeSceneUnder(makeConstantEnvironment(kBlack));
  add(scene, std::move(mesh), makeEmitter(kRed));
  const ReferenceScene reference(finish(std::move(scene)));
  const glm::vec3 eye(1.7f, 1.3f, 2.0f);
  for (int y = 1; y + 1 < kSegments; ++y)
    for (int x = 1; x + 1 < kSegments; ++x) {
      const auto at = [&](int i, int j) { return vertices[static_cast<std::size_t>(j * (kSegments + 1) + i)]; };
      for (const float f : {0.3f, 0.5f})
        for (const glm::vec3& end : {at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)})
          ASSERT_EQ(reference.radiance(eye, glm::mix(at(x, y), end, f) - eye, {}, 0), kRed) << x << " " << y;
    }
}

TEST(SampleIds, NameInstanceGroupAndTexel) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(kBlack));
  // Left: a square with a texture of 2 x 2 texels and a nearest filter, v downwards. Right: two squares in one mesh.
  Material textured = makeDiffuseMaterial("textured", glm::vec3(1.0f));
  textured.baseColorTexture = addTexture(scene, makeTexture("t", ImageRgba(2, 2, glm::vec4(1.0f))));
  textured.constants.baseColorSlot.offset.w = 1.0f;
  textured.constants.baseColorSlot.sampler_ = {shading::kWrapClamp, shading::kWrapClamp, shading::kFilterNearest,
                                               shading::kFilterNearest};
  add(scene, makeQuadMesh({-1, 1, 0}, {0, -2, 0}, {1, 0, 0}), textured);
  Mesh two = makeQuadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Mesh lower = makeQuadMesh({0, -1, 0}, {0.5f, 0, 0}, {0, 1, 0.5f});
  two.positions.insert(two.positions.end(), lower.positions.begin(), lower.positions.end());
  two.normals.insert(two.normals.end(), lower.normals.begin(), lower.normals.end());
  two.tangents.insert(two.tangents.end(), lower.tangents.begin(), lower.tangents.end());
  two.uvs[0].insert(two.uvs[0].end(), lower.uvs[0].begin(), lower.uvs[0].end());
  two.indices.insert(two.indices.end(), {4, 5, 6, 4, 6, 7});
  add(scene, std::move(two), makeDiffuseMaterial("plain", glm::vec3(1.0f)));
  addCamera(scene, "camera", {0, 0, 1}, {0, 0, 0}, glm::radians(90.0f), 0.1f);
  const auto snapshot = finish(std::move(scene));
  const Grid<SampleId> ids = ReferenceScene(snapshot).renderIds(snapshot->camera, 2, 2, 2);
  ASSERT_EQ(ids.width(), 4);
  ASSERT_EQ(ids.height(), 4);
  // The quad's u runs down and its v to the right: texel (x, y) of the texture is at row x, column y of the picture.
  EXPECT_EQ(ids(0, 0), (SampleId{1, 1, 1}));
  EXPECT_EQ(ids(1, 0), (SampleId{1, 1, 3}));
  EXPECT_EQ(ids(0, 3), (SampleId{1, 1, 2}));
  EXPECT_EQ(ids(1, 3), (SampleId{1, 1, 4}));
  EXPECT_EQ(ids(2, 0), (SampleId{2, 1, 0}));
  EXPECT_EQ(ids(2, 3), (SampleId{2, 2, 0}));
  EXPECT_EQ(ids(3, 3), (SampleId{0, 0, 0}));
}

}  // namespace
}  // namespace pb
