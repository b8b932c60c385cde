// Shadow maps against closed forms, on both GL backends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "raster/shadow_maps.h"
#include "scenes/error.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

using RasterShadows = RasterTest;
INSTANTIATE_TEST_SUITE_P(Gl, RasterShadows, kBackends, nameOfBackend);

constexpr int kImage = 128;      // pixels
constexpr float kExtent = 4.0f;  // metres of the floor along the image's edge

// A floor seen from straight above through a narrow lens: pixel (x, y) shows the floor at ((x + 0.5) / kImage - 0.5)
// kExtent, and the same with z for y, as near as the pixel's own width.
Scene makeFloor() {
  Scene scene;
  scene.environment = makeConstantEnvironment(kBlack);
  constexpr float kHeight = 100.0f;
  // Looks down: up is -Z. A hair off the vertical, which has no horizon to stand upright by.
  addCamera(scene, "camera", vec3(0, kHeight, 1e-3f), vec3(0), 2.0f * std::atan(0.5f * kExtent / kHeight), 0.1f);
  addInstance(scene, "floor", finishMesh(makeQuadMesh(vec3(-5, 0, 5), vec3(10, 0, 0), vec3(0, 0, -10))),
              addMaterial(scene, makeDiffuseMaterial("white", vec3(1.0f))));
  scene.castsShadows = true;
  return scene;
}

// Light from a node at `position` that shines towards `target`.
void addLight(Scene& scene, float kind, vec3 position, vec3 target, float outerConeAngle = 0.6f) {
  Node node;
  node.translation = position;
  node.rotation = glm::quatLookAt(glm::normalize(target - position), vec3(0.1f, 0.2f, 1.0f));
  scene.nodes.push_back(node);
  PunctualLight light;
  light.node = static_cast<int>(scene.nodes.size()) - 1;
  light.kind = kind;
  light.intensity = vec3(kind == shading::kLightDirectional ? shading::kPi : 100.0f);
  light.innerConeAngle = outerConeAngle;
  light.outerConeAngle = outerConeAngle;
  scene.lights.push_back(light);
}

Technique withShadows(int resolution) {
  Technique technique = withResolution(8);
  technique.shadowResolution = resolution;
  return technique;
}

float floorAt(int pixel) { return ((static_cast<float>(pixel) + 0.5f) / kImage - 0.5f) * kExtent; }

// Where the row of the image that shows the floor at `z` turns from lit to dark and back: x of the first and of the
// last dark pixel's outer edges, half lit pixels in the middle of the ramp.
struct Shadow {
  float left, right;
};
Shadow shadowAlong(const Image& image, float z) {
  const int y = static_cast<int>((z / kExtent + 0.5f) * kImage);
  int first = kImage, last = -1;
  for (int x = 0; x < kImage; ++x) {
    // Half of what the row's lit end has at least, from a light whose irradiance changes slowly.
    if (image(x, y).x > 0.5f * image(1, y).x) continue;
    first = std::min(first, x);
    last = std::max(last, x);
  }
  return {floorAt(first) - 0.5f * kExtent / kImage, floorAt(last) + 0.5f * kExtent / kImage};
}

// A box of half a metre whose bottom floats at 0.5 m: its right edge at x = 0.25, heights 0.5 to 1.
Scene makeBoxOverFloor() {
  Scene scene = makeFloor();
  addBox(scene, vec3(0, 0.75f, 0), vec3(0.5f), makeDiffuseMaterial("box", vec3(1.0f)));
  return scene;
}

constexpr float kPixel = kExtent / kImage;

TEST_P(RasterShadows, DirectionalLightThrowsTheBoxAlongItself) {
  // Shines along (1, -1, 0): a point at height h falls h to the right. The shadow reaches from the bottom's left edge,
  // -0.25 + 0.5, to the top's right edge, 0.25 + 1.
  Scene scene = makeBoxOverFloor();
  addLight(scene, shading::kLightDirectional, vec3(-3, 3, 0), vec3(0));
  const Image image = render(*snapshotOf(std::move(scene)), withShadows(1024), kImage, kImage);
  // Bounds of the scene: 10 m of floor, over 1024 texels.
  const float tolerance = 10.0f * std::sqrt(2.0f) / 1024.0f + kPixel;
  const Shadow shadow = shadowAlong(image, 0.0f);
  EXPECT_NEAR(shadow.left, 0.25f, tolerance);
  EXPECT_NEAR(shadow.right, 1.25f, tolerance);
  EXPECT_EQ(image(kImage / 2 + 24, kImage / 2), kBlack) << "the middle of the shadow, x = 0.77";
  // Lambert: E cos 45 / pi.
  EXPECT_NEAR(image(4, 4).x, std::sqrt(0.5f), 1e-5f);
}

// From a light at height H over x = 0, an edge at x = e and height h falls to e H / (H - h).
void expectShadowFromAbove(const Image& image, float texel) {
  const float outermost = 0.25f * 3.0f / (3.0f - 1.0f);  // the top's edges
  const Shadow shadow = shadowAlong(image, 0.0f);
  // A texel at the depth of the floor, 3 m below; the pixel; and the ramp's half.
  EXPECT_NEAR(shadow.left, -outermost, texel + kPixel);
  EXPECT_NEAR(shadow.right, outermost, texel + kPixel);
}

TEST_P(RasterShadows, PointLightThrowsTheBoxFromItsPosition) {
  Scene scene = makeBoxOverFloor();
  addLight(scene, shading::kLightPoint, vec3(0, 3, 0), vec3(0));
  const Image image = render(*snapshotOf(std::move(scene)), withShadows(512), kImage, kImage);
  expectShadowFromAbove(image, 2.0f * 3.0f / 510.0f);
}

TEST_P(RasterShadows, SpotLightThrowsTheBoxFromItsPosition) {
  for (const float angle : {0.6f, 1.2f}) {  // one face; wider than one face sees: six
    Scene scene = makeBoxOverFloor();
    addLight(scene, shading::kLightSpot, vec3(0, 3, 0), vec3(0), angle);
    const Image image = render(*snapshotOf(std::move(scene)), withShadows(512), kImage, kImage);
    expectShadowFromAbove(image, 2.0f * 3.0f / 510.0f);
  }
}

// Flat floors, steep and shallow light, coarse maps: what nothing shadows is lit exactly as without shadows.
TEST_P(RasterShadows, NothingShadowsItself) {
  for (const float kind : {shading::kLightDirectional, shading::kLightPoint, shading::kLightSpot})
    for (const vec3& position : {vec3(0, 4, 0), vec3(3, 2, 1), vec3(4, 0.6f, -2)})
      for (const int resolution : {32, 512}) {
        Scene scene = makeFloor();
        scene.materials.front().doubleSided = true;  // drawn to the maps
        addLight(scene, kind, position, vec3(0), 1.5f);
        const Image shadowed = render(*snapshotOf(scene), withShadows(resolution), kImage, kImage);
        scene.castsShadows = false;
        const Image plain = render(*snapshotOf(std::move(scene)), withShadows(resolution), kImage, kImage);
        EXPECT_LE(largestDifference(shadowed, plain), 1e-6f)
            << "kind " << kind << ", from height " << position.y << ", " << resolution << " texels";
      }
}

TEST_P(RasterShadows, PointLightsFacesMeetWithoutSeams) {
  // The edges between -Y and its neighbours lie on the floor at |x| = height: shadows of thin rails across them.
  Scene scene = makeFloor();
  Material material = makeDiffuseMaterial("rail", vec3(0.5f));
  addBox(scene, vec3(0, 0.5f, 0), vec3(4.0f, 0.02f, 0.4f), material);
  addLight(scene, shading::kLightPoint, vec3(0, 1, 0), vec3(0));
  const Image image = render(*snapshotOf(std::move(scene)), withShadows(256), kImage, kImage);
  for (int x = 2; x < kImage - 2; ++x) EXPECT_EQ(image(x, kImage / 2 + 8), kBlack) << "x = " << floorAt(x);
}

TEST_P(RasterShadows, MasksThrowShadowsWithHoles) {
  Scene scene = makeFloor();
  ImageRgba texels(2, 1);
  texels(0, 0) = glm::vec4(1, 1, 1, 0);
  texels(1, 0) = glm::vec4(1, 1, 1, 1);
  Material mask = makeDiffuseMaterial("mask", vec3(1.0f));
  mask.baseColorTexture = addTexture(scene, makeTexture("mask", std::move(texels)));
  mask.constants.baseColorSlot.offset.w = 1.0f;
  mask.constants.baseColorSlot.sampler_ = {shading::kWrapClamp, shading::kWrapClamp, shading::kFilterNearest,
                                           shading::kFilterNearest};
  mask.constants.alpha = {shading::kAlphaMask, 0.5f, 0.0f, 0.0f};
  mask.doubleSided = true;
  // Holes where x < 0. The camera sees the floor past it: the light shines from the left, the shadow falls to the
  // right.
  addInstance(scene, "mask", finishMesh(makeQuadMesh(vec3(-1, 0.5f, 0.5f), vec3(2, 0, 0), vec3(0, 0, -1))),
              addMaterial(scene, mask));
  addLight(scene, shading::kLightDirectional, vec3(-1, 1, 0), vec3(0));
  const Image image = render(*snapshotOf(std::move(scene)), withShadows(512), kImage, kImage);
  const auto pixelAt = [&](float x) { return image(static_cast<int>((x / kExtent + 0.5f) * kImage), kImage / 2); };
  EXPECT_GT(pixelAt(-0.25f).x, 0.5f);  // through the hole: x = -0.75 at height 0.5
  EXPECT_EQ(pixelAt(1.25f), kBlack);   // x = 0.75 at height 0.5
}

TEST_P(RasterShadows, BlendedSurfacesThrowShadowsFromHalfCoverageOn) {
  for (const float opacity : {0.4f, 0.6f}) {
    Scene scene = makeFloor();
    Material material = makeDiffuseMaterial("pane", vec3(1.0f));
    material.constants.baseColor.w = opacity;
    material.constants.alpha.x = shading::kAlphaBlend;
    material.doubleSided = true;
    addInstance(scene, "pane", finishMesh(makeQuadMesh(vec3(-0.5f, 1, 0.5f), vec3(1, 0, 0), vec3(0, 0, -1))),
                addMaterial(scene, material));
    addLight(scene, shading::kLightDirectional, vec3(-1, 1, 0), vec3(0));
    const Image image = render(*snapshotOf(std::move(scene)), withShadows(512), kImage, kImage);
    const float lit = image(4, 4).x;
    EXPECT_NEAR(image(kImage / 2 + 32, kImage / 2).x, opacity < 0.5f ? lit : 0.0f, 1e-5f);
  }
}

// Rays from a surface to a light pass single-sided surfaces from behind.
TEST_P(RasterShadows, SingleSidedSurfacesShadowWhatTheyFace) {
  for (const bool facesFloor : {true, false}) {
    Scene scene = makeFloor();
    const vec3 u = facesFloor ? vec3(0, 0, 1) : vec3(1, 0, 0);
    const vec3 v = facesFloor ? vec3(1, 0, 0) : vec3(0, 0, 1);
    addInstance(scene, "pane", finishMesh(makeQuadMesh(vec3(-0.5f, 1, -0.5f), facesFloor ? v : u, facesFloor ? u : v)),
                addMaterial(scene, makeDiffuseMaterial("pane", vec3(1.0f))));
    addLight(scene, shading::kLightDirectional, vec3(-1, 1, 0), vec3(0));
    const vec3 normal = glm::cross(facesFloor ? v : u, facesFloor ? u : v);
    const Image image = render(*snapshotOf(std::move(scene)), withShadows(512), kImage, kImage);
    EXPECT_EQ(image(kImage / 2 + 32, kImage / 2) == kBlack, normal.y < 0.0f);
  }
}

TEST_P(RasterShadows, CapturesShowThem) {
  Scene scene = makeBoxOverFloor();
  addInstance(scene, "mirror", finishMesh(makeSphereMesh(0.2f, 16, 8)),
              addMaterial(scene, makeMirrorMaterial("mirror")), [] {
                Node node;
                node.translation = vec3(0.75f, 1.5f, 0.0f);  // over the shadow's middle
                return node;
              }());
  addLight(scene, shading::kLightDirectional, vec3(-3, 3, 0), vec3(0));
  Technique technique = withShadows(1024);
  technique.resolution = 65;
  RasterSequence sequence(device(), technique, kImage, kImage, 1);
  sequence.renderFrame(*snapshotOf(std::move(scene)));
  EXPECT_EQ(sequence.readProbe(0)[3](32, 32), kBlack);
}

TEST_P(RasterShadows, AreDrawnOnceAFrame) {
  Scene scene = makeBoxOverFloor();
  addLight(scene, shading::kLightPoint, vec3(0, 3, 0), vec3(0));
  const auto shadowed = snapshotOf(scene);
  scene.castsShadows = false;
  const auto plain = snapshotOf(std::move(scene));
  Technique technique = withShadows(64);
  RasterSequence a(device(), technique, 16, 16, 1), b(device(), technique, 16, 16, 1);
  const FrameCounters with = a.renderFrame(*shadowed).counters, without = b.renderFrame(*plain).counters;
  // Both instances are seen by the face that looks down, and by none of the others beside the floor.
  EXPECT_EQ(with.facesCaptured, without.facesCaptured);
  EXPECT_GE(with.draws, without.draws + 2);
  EXPECT_LE(with.draws, without.draws + 2 * 6);
  EXPECT_GT(a.renderFrameTimed(*shadowed).shadowMs, 0.0);
}

TEST_P(RasterShadows, RefuseWhatTheDeviceCannotDo) {
  Scene scene = makeBoxOverFloor();
  addLight(scene, shading::kLightPoint, vec3(0, 3, 0), vec3(0));
  RasterSequence sequence(device(), withShadows(1 << 20), 16, 16, 1);
  EXPECT_THROW(sequence.renderFrame(*snapshotOf(std::move(scene))), Error);
}

}  // namespace
}  // namespace pb
