// Scenes in which nothing is approximated must be the same picture in both renderers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <optional>

#include "raster/renderer.h"
#include "reference/renderer.h"
#include "scenes/builtin.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"

namespace pb {
namespace {

using glm::vec3;

#ifdef PROBEBENCH_OSMESA
constexpr GlBackend kBackend = GlBackend::osmesa;
#else
constexpr GlBackend kBackend = GlBackend::egl;
#endif

constexpr int kWidth = 96, kHeight = 54, kSamplesPerAxis = 2;

// Mean of squared differences over squared values + 0.01, of the pixels whose samples show the same in both, and the
// share of pixels that are left out.
struct Agreement {
  double relmse = 0;
  double leftOut = 0;
};

bool showsTheSame(const Grid<SampleId>& a, const Grid<SampleId>& b, int x, int y) {
  for (int j = 0; j < kSamplesPerAxis; ++j)
    for (int i = 0; i < kSamplesPerAxis; ++i)
      if (a(x * kSamplesPerAxis + i, y * kSamplesPerAxis + j) != b(x * kSamplesPerAxis + i, y * kSamplesPerAxis + j))
        return false;
  return true;
}

// depth: specular hits of the reference's paths, none for all.
Agreement compareRenderers(const std::shared_ptr<const Snapshot>& snapshot, std::optional<int> depth = {}) {
  RasterDevice device(kBackend);
  RasterSequence sequence(device, Technique{}, kWidth, kHeight, kSamplesPerAxis);
  sequence.renderFrame(*snapshot);
  const Image raster = sequence.readImage();
  const Grid<SampleId> rasterIds = sequence.renderIds(*snapshot);

  const ReferenceScene scene(snapshot);
  ReferenceSettings settings;
  settings.samplesPerAxis = kSamplesPerAxis;
  settings.spp = 2;
  settings.depth = depth;
  const Image reference = scene.render(snapshot->camera, kWidth, kHeight, settings).mean();
  const Grid<SampleId> referenceIds = scene.renderIds(snapshot->camera, kWidth, kHeight, kSamplesPerAxis);

  Agreement result;
  int kept = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (!showsTheSame(rasterIds, referenceIds, x, y)) continue;
      ++kept;
      for (int c = 0; c < 3; ++c) {
        const auto truth = static_cast<double>(reference(x, y)[c]);
        const double difference = static_cast<double>(raster(x, y)[c]) - truth;
        result.relmse += difference * difference / (truth * truth + 0.01) / 3.0;
      }
    }
  result.relmse /= kept;
  result.leftOut = 1.0 - static_cast<double>(kept) / (kWidth * kHeight);
  return result;
}

std::shared_ptr<const Snapshot> snapshotOf(Scene scene) {
  finishScene(scene);
  return makeSnapshot(std::make_shared<const Scene>(std::move(scene)), 0, "", static_cast<double>(kWidth) / kHeight);
}

// The bounds of the control: untextured 1e-6, textured 1e-5, and at most 0.2 % left out.
void expectAgreement(const Agreement& agreement, double bound) {
  EXPECT_LE(agreement.relmse, bound);
  EXPECT_LE(agreement.leftOut, 2e-3);
}

Material makeEmitter(vec3 radiance, bool doubleSided) {
  Material material = makeDiffuseMaterial("emitter", vec3(0.2f));
  material.constants.emission = glm::vec4(radiance, 1.0f);
  material.doubleSided = doubleSided;
  return material;
}

void addQuad(Scene& scene, vec3 p, vec3 u, vec3 v, Material material) {
  addInstance(scene, "quad", finishMesh(makeQuadMesh(p, u, v)), addMaterial(scene, std::move(material)));
}

Scene makeRoomWithBall() {
  Scene scene;
  scene.environment = makeConstantEnvironment(vec3(0.05f));
  addCamera(scene, "camera", vec3(0, 1.5f, 4), vec3(0, 0.5f, 0), 0.8f, 0.1f);
  addQuad(scene, vec3(-3, 0, 3), vec3(6, 0, 0), vec3(0, 0, -6), makeDiffuseMaterial("floor", vec3(0.7f)));
  Node node;
  node.translation = vec3(0, 0.6f, 0);
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.5f, 48, 24)),
              addMaterial(scene, makeDiffuseMaterial("ball", vec3(0.8f, 0.6f, 0.4f))), node);
  return scene;
}

// The ball has normals whose horizons the light crosses in all ways; the floor's it crosses as well.
TEST(Pictures, AgreeUnderAreaLightsThatCrossTheHorizon) {
  Scene scene = makeRoomWithBall();
  addQuad(scene, vec3(-1.5f, -0.5f, -1), vec3(0, 2, 0), vec3(0, 0, 2), makeEmitter(vec3(5, 4, 3), false));
  addQuad(scene, vec3(1.2f, 0.2f, 0.6f), vec3(0.3f, 1, 0), vec3(0.2f, 0, -1), makeEmitter(vec3(2, 3, 4), true));
  expectAgreement(compareRenderers(snapshotOf(std::move(scene))), 1e-6);
}

TEST(Pictures, AgreeOnMaskedAndBlendedSurfaces) {
  const auto scene = std::make_shared<const Scene>(makeBuiltinScene(parseSpec("control-alpha")));
  expectAgreement(compareRenderers(makeSnapshot(scene, 0, "", static_cast<double>(kWidth) / kHeight)), 1e-5);
}

Material makeRough(Material material, float roughness) {
  material.constants.factors.y = roughness;
  return material;
}

// Highlights are all that is to be seen, after one hit under a black sky. A wall lit from the front and one lit from
// behind, and a metal so smooth that its lobe is a thousandth of a radian wide.
TEST(Pictures, AgreeOnHighlightsOfThinWallsAndNarrowLobes) {
  Scene scene;
  scene.environment = makeConstantEnvironment(vec3(0.0f));
  addCamera(scene, "camera", vec3(0, 0.5f, 4), vec3(0), 0.8f, 0.1f);
  Material wall = makeRough(makeGlassMaterial("wall", 1.5f, 0.0f), 0.3f);
  wall.doubleSided = true;
  addQuad(scene, vec3(-2, -1, 0), vec3(1.2f, 0, 0.3f), vec3(0, 2, 0.2f), wall);
  addQuad(scene, vec3(0.8f, 1, -0.5f), vec3(1.2f, 0, -0.2f), vec3(0.1f, -2, 0.3f), wall);
  addQuad(scene, vec3(-0.6f, -1, 0.1f), vec3(1.3f, 0, 0.2f), vec3(0, 2, -0.9f),
          makeMetalMaterial("metal", vec3(0.2f, 0.4f, 1.0f), vec3(3.3f, 2.5f, 1.8f), 0.033f));
  addDirectionalLight(scene, "behind", vec3(0.2f, 0.4f, -1), vec3(2.0f));
  addDirectionalLight(scene, "front", vec3(-0.1f, 0.5f, 1), vec3(3.0f));
  expectAgreement(compareRenderers(snapshotOf(std::move(scene)), 1), 1e-6);
}

// The inside of a glass ball reflects by the index seen from inside.
TEST(Pictures, AgreeOnHighlightsInsideOfGlass) {
  Scene scene;
  scene.environment = makeConstantEnvironment(vec3(0.0f));
  addCamera(scene, "camera", vec3(0, 0.5f, 1), vec3(0), 0.8f, 0.1f);
  addInstance(scene, "ball", finishMesh(makeSphereMesh(2.0f, 64, 32)),
              addMaterial(scene, makeRough(makeGlassMaterial("glass", 1.5f), 0.5f)));
  PunctualLight lamp;
  lamp.kind = shading::kLightPoint;
  lamp.intensity = vec3(3.0f);
  lamp.node = static_cast<int>(scene.nodes.size());
  Node node;
  node.translation = vec3(0.8f, 0.7f, 0.0f);
  scene.nodes.push_back(node);
  scene.lights.push_back(lamp);
  expectAgreement(compareRenderers(snapshotOf(std::move(scene)), 1), 1e-6);
}

// Frame 17 of what waves, is bent by a skin of two joints and is morphed: both renderers get the same vertices.
TEST(Pictures, AgreeOnDeformingSurfaces) {
  Scene scene = makeRoomWithBall();
  Node flag;
  flag.translation = vec3(-1.4f, 0.3f, 0.4f);
  flag.wave = Wave{.amplitude = 0.25f, .length = 1.0f, .wavelength = 0.7f, .skew = 0.3f, .periodSeconds = 1.0f};
  Mesh cloth = makeSphereMesh(0.4f, 48, 24);
  for (vec3& p : cloth.positions) p.x += 0.4f;
  addInstance(scene, "flag", finishMesh(std::move(cloth)),
              addMaterial(scene, makeDiffuseMaterial("cloth", vec3(0.8f, 0.2f, 0.2f))), flag);

  Mesh arm = makeSphereMesh(0.3f, 48, 24);
  arm.targets.resize(1);
  for (vec3& p : arm.positions) {
    p.y = 2.0f * p.y + 0.6f;
    const float upper = glm::smoothstep(0.4f, 0.8f, p.y);
    arm.joints.emplace_back(0, 1, 0, 0);
    arm.jointWeights.emplace_back(1.0f - upper, upper, 0.0f, 0.0f);
    arm.targets[0].positions.push_back(0.2f * vec3(p.x, 0.0f, p.z));
  }
  const int lower = static_cast<int>(scene.nodes.size());
  Node joint;
  joint.translation = vec3(1.3f, 0.0f, 0.3f);
  scene.nodes.push_back(joint);
  joint.parent = lower;
  joint.translation = vec3(0.0f, 0.6f, 0.0f);
  joint.rotation = glm::angleAxis(0.9f, vec3(0, 0, 1));
  joint.scale = vec3(1.0f, 1.2f, 0.7f);
  scene.nodes.push_back(joint);
  scene.skins.push_back(
      {"bones", {lower, lower + 1}, {glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), vec3(0.0f, -0.6f, 0.0f))}});
  Node skinned;
  skinned.skin = 0;
  skinned.morphWeights = {0.7f};
  addInstance(scene, "arm", finishMesh(std::move(arm)),
              addMaterial(scene, makeDiffuseMaterial("skin", vec3(0.3f, 0.5f, 0.8f))), skinned);
  addDirectionalLight(scene, "sun", vec3(1, 2, 1), vec3(3.0f));
  finishScene(scene);
  const auto shared = std::make_shared<const Scene>(std::move(scene));
  expectAgreement(compareRenderers(makeSnapshot(shared, 17, "", static_cast<double>(kWidth) / kHeight)), 1e-6);
}

// Edges of shadows are not the control's; what lies inside and outside is. So most pixels agree to rounding.
TEST(Pictures, AgreeOnLightAndShadowButForTheirEdges) {
  Scene scene = makeRoomWithBall();
  addDirectionalLight(scene, "sun", vec3(1, 2, 1), vec3(3.0f));
  scene.castsShadows = true;
  const Agreement shadowed = compareRenderers(snapshotOf(scene));
  EXPECT_LE(shadowed.relmse, 2e-3)
      << "6 m of floor in 1024 texels: the shadow's edge is a ramp of 6 mm in 8 m of its length";
  scene.castsShadows = false;
  expectAgreement(compareRenderers(snapshotOf(std::move(scene))), 1e-6);
}

}  // namespace
}  // namespace pb
