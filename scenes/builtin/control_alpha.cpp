// `control-alpha`: cutouts, and transparent surfaces that lie behind and cut through each other, all matte. Nothing is
// approximated here if every fragment is composed in order of depth, so both renderers must agree.
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

// Round leaves: alpha falls smoothly from 1 at a leaf's centre to 0 between leaves, 0.5 on its edge.
Texture makeLeaves() {
  constexpr int kSize = 64;
  ImageRgba texels(kSize, kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const float u = 2.0f * glm::two_pi<float>() * (static_cast<float>(x) + 0.5f) / kSize;
      const float v = 2.0f * glm::two_pi<float>() * (static_cast<float>(y) + 0.5f) / kSize;
      const float leaf = std::sin(u) * std::sin(v);
      texels(x, y) = roundedToBytes({0.25f + 0.2f * std::sin(u), 0.6f, 0.2f + 0.1f * std::cos(v), 0.5f + 0.5f * leaf});
    }
  return makeTexture("leaves", std::move(texels));
}

Texture makeChecker() {
  ImageRgba texels(2, 2);
  for (int i = 0; i < 4; ++i)
    texels(i % 2, i / 2) = roundedToBytes(glm::vec4(glm::vec3(i == 0 || i == 3 ? 0.7f : 0.25f), 1.0f));
  return makeTexture("checker", std::move(texels));
}

int addTransparent(Scene& scene, const char* name, glm::vec3 albedo, float opacity) {
  Material material = makeDiffuseMaterial(name, albedo);
  material.constants.baseColor.w = opacity;
  material.constants.alpha.x = shading::kAlphaBlend;
  material.doubleSided = true;
  return addMaterial(scene, std::move(material));
}

Node at(glm::vec3 translation, float yawDegrees = 0.0f) {
  Node node;
  node.translation = translation;
  node.rotation = glm::angleAxis(glm::radians(yawDegrees), glm::vec3(0, 1, 0));
  return node;
}

void addOpaque(Scene& scene) {
  Material floor = makeTexturedMaterial("Floor", addTexture(scene, makeChecker()), {5, 5});
  floor.constants.baseColorSlot.sampler_.z = shading::kFilterNearest;
  addInstance(scene, "Floor", finishMesh(makeQuadMesh({-5, 0, 5}, {10, 0, 0}, {0, 0, -10})),
              addMaterial(scene, std::move(floor)));
  const auto plain = [&](const char* name, glm::vec3 albedo) {
    return addMaterial(scene, makeDiffuseMaterial(name, albedo));
  };
  addInstance(scene, "Box", finishMesh(makeBoxMesh(glm::vec3(0.6f))), plain("Orange", {0.8f, 0.4f, 0.1f}),
              at({-1.1f, 0.8f, 0.2f}, 30.0f));
  addInstance(scene, "Wall", finishMesh(makeBoxMesh({6.0f, 2.2f, 0.2f})), plain("Plaster", {0.6f, 0.6f, 0.65f}),
              at({0.0f, 1.1f, -2.6f}));
  addInstance(scene, "Torus", finishMesh(makeTorusMesh(0.7f, 0.2f, 48, 24)), plain("Blue", {0.15f, 0.3f, 0.7f}),
              at({1.2f, 0.75f, 0.1f}));
}

void addCutouts(Scene& scene) {
  Material leaves = makeTexturedMaterial("Leaves", addTexture(scene, makeLeaves()), {2, 2});
  leaves.constants.alpha = {shading::kAlphaMask, 0.5f, 0.0f, 0.0f};
  leaves.doubleSided = true;
  const int material = addMaterial(scene, std::move(leaves));
  addInstance(scene, "Hedge", finishMesh(makeQuadMesh({-1.2f, 0, 0}, {2.4f, 0, 0}, {0, 1.6f, 0})), material,
              at({-2.0f, 0.01f, -1.2f}, 25.0f));
  addInstance(scene, "Leaf ball", finishMesh(makeSphereMesh(0.55f, 48, 24)), material, at({2.5f, 0.57f, 1.0f}));
}

// Panes that share a vertical axis, balls that overlap each other and a pane: no order of whole objects is right.
void addTransparentShapes(Scene& scene) {
  const auto pane = finishMesh(makeQuadMesh({-0.8f, 0, 0}, {1.6f, 0, 0}, {0, 1.5f, 0}));
  addInstance(scene, "Red pane", pane, addTransparent(scene, "Red", {0.8f, 0.1f, 0.1f}, 0.5f),
              at({0.0f, 0.02f, 1.0f}, 10.0f));
  addInstance(scene, "Green pane", pane, addTransparent(scene, "Green", {0.1f, 0.7f, 0.2f}, 0.4f),
              at({0.0f, 0.02f, 1.0f}, 70.0f));
  addInstance(scene, "Yellow pane", pane, addTransparent(scene, "Yellow", {0.9f, 0.8f, 0.1f}, 0.6f),
              at({0.0f, 0.02f, 1.0f}, 130.0f));
  const auto ball = finishMesh(makeSphereMesh(0.7f, 64, 32));
  addInstance(scene, "Cyan ball", ball, addTransparent(scene, "Cyan", {0.1f, 0.6f, 0.7f}, 0.35f),
              at({-1.1f, 0.8f, 0.3f}));
  addInstance(scene, "Violet ball", ball, addTransparent(scene, "Violet", {0.5f, 0.15f, 0.7f}, 0.45f),
              at({-0.55f, 0.9f, 0.7f}));
  Material fading = makeTexturedMaterial("Fading leaves", 1, {1, 1});
  fading.constants.alpha.x = shading::kAlphaBlend;
  addInstance(scene, "Fading ball", ball, addMaterial(scene, std::move(fading)), at({1.2f, 0.9f, 0.9f}));
}

}  // namespace

Scene makeControlAlphaScene(SpecReader& /*parameters*/) {
  Scene scene;
  addOpaque(scene);
  addCutouts(scene);
  addTransparentShapes(scene);
  addDirectionalLight(scene, "Sun", {0.5f, 0.8f, 0.6f}, glm::vec3(1.9f, 1.8f, 1.6f));
  addCamera(scene, "Camera", {0.4f, 1.9f, 5.2f}, {0.1f, 0.75f, 0.0f}, glm::radians(40.0f), 0.1f);
  scene.environment = makeProceduralSky();
  return scene;
}

}  // namespace pb
