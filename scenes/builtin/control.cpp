// `control`: no specular surface at all. Nothing is approximated here, so both renderers must agree; it holds
// everything that could make them differ: shapes, textures with every filter, normal maps, vertex colours, transforms
// and kinds of light. `control-shadows` is the same scene with shadows of its three punctual lights.
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/builtin/teapot_mesh.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

// Smooth colour waves: no texel edges, so that filtering differences show as values and not as edges.
Texture makeWaves(int size) {
  ImageRgba texels(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const float u = glm::two_pi<float>() * (static_cast<float>(x) + 0.5f) / static_cast<float>(size);
      const float v = glm::two_pi<float>() * (static_cast<float>(y) + 0.5f) / static_cast<float>(size);
      texels(x, y) = {0.5f + 0.4f * std::sin(2.0f * u), 0.5f + 0.4f * std::cos(3.0f * v), 0.5f + 0.4f * std::sin(u + v),
                      1.0f};
    }
  return makeTexture("waves", std::move(texels));
}

Texture makeBricks() {
  ImageRgba texels(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const int row = y / 16;
      const bool joint = y % 16 < 2 || (x + 16 * (row % 2)) % 32 < 2;
      texels(x, y) = joint ? glm::vec4(0.6f, 0.58f, 0.55f, 1.0f)
                           : glm::vec4(0.45f, 0.16f + 0.02f * static_cast<float>(row), 0.10f, 1.0f);
    }
  return makeTexture("bricks", std::move(texels));
}

// Normals of a field of round bumps, encoded to [0,1]; their y points up in the picture, against v.
Texture makeBumps() {
  constexpr int kSize = 64;
  constexpr float kHeight = 0.35f;
  ImageRgba texels(kSize, kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const float u = 2.0f * glm::two_pi<float>() * (static_cast<float>(x) + 0.5f) / kSize;
      const float v = 2.0f * glm::two_pi<float>() * (static_cast<float>(y) + 0.5f) / kSize;
      const glm::vec3 n =
          glm::normalize(glm::vec3(-kHeight * std::cos(u) * std::sin(v), kHeight * std::sin(u) * std::cos(v), 1.0f));
      texels(x, y) = glm::vec4(0.5f * n + 0.5f, 1.0f);
    }
  return makeTexture("bumps", std::move(texels));
}

Material makeTextured(std::string name, int texture, glm::vec4 sampler, glm::vec2 repeats) {
  Material material = makeTexturedMaterial(std::move(name), texture, repeats);
  material.constants.baseColorSlot.sampler_ = sampler;
  return material;
}

Node at(glm::vec3 translation, float yawDegrees = 0.0f, glm::vec3 scale = glm::vec3(1.0f)) {
  Node node;
  node.translation = translation;
  node.rotation = glm::angleAxis(glm::radians(yawDegrees), glm::vec3(0, 1, 0));
  node.scale = scale;
  return node;
}

void addTexturedShapes(Scene& scene) {
  using namespace shading;
  const int waves = addTexture(scene, makeWaves(128));
  const int bricks = addTexture(scene, makeBricks());
  const glm::vec4 trilinear(kWrapRepeat, kWrapRepeat, kFilterLinear, kFilterLinearMipLinear);
  const glm::vec4 mirroredBilinear(kWrapMirror, kWrapMirror, kFilterLinear, kFilterLinear);
  const glm::vec4 nearest(kWrapRepeat, kWrapRepeat, kFilterNearest, kFilterNearest);
  addInstance(scene, "Floor", finishMesh(makeQuadMesh({-8, 0, 8}, {16, 0, 0}, {0, 0, -16})),
              addMaterial(scene, makeTextured("Waves", waves, trilinear, {8, 8})));
  addInstance(scene, "Brick box", finishMesh(makeBoxMesh(glm::vec3(1.2f))),
              addMaterial(scene, makeTextured("Bricks", bricks, nearest, {1, 1})), at({-2.4f, 0.6f, 0.4f}, 30.0f));
  addInstance(scene, "Wave ball", finishMesh(makeSphereMesh(0.7f, 64, 32)),
              addMaterial(scene, makeTextured("Mirrored waves", waves, mirroredBilinear, {3, 2})),
              at({2.3f, 0.7f, 0.6f}));

  Material bumpy = makeTextured("Bumpy bricks", bricks, trilinear, {2, 1});
  bumpy.normalTexture = addTexture(scene, makeBumps());
  bumpy.constants.normalSlot.offset.w = 1.0f;
  bumpy.constants.normalSlot.matrix = {3.0f, 0.0f, 0.0f, 2.0f};
  const int bumpyMaterial = addMaterial(scene, std::move(bumpy));
  addInstance(scene, "Bumpy wall", finishMesh(makeBoxMesh({3.0f, 1.6f, 0.3f})), bumpyMaterial,
              at({0.0f, 0.8f, -2.6f}, -12.0f));
  addInstance(scene, "Bumpy torus", finishMesh(makeTorusMesh(0.6f, 0.25f, 64, 32), true), bumpyMaterial,
              at({3.0f, 0.35f, -1.4f}, 20.0f));
}

void addPlainShapes(Scene& scene) {
  const auto plain = [&](const char* name, glm::vec3 albedo) {
    return addMaterial(scene, makeDiffuseMaterial(name, albedo));
  };
  addInstance(scene, "Teapot", finishMesh(makeTeapotMesh(8)), plain("Clay", {0.7f, 0.5f, 0.4f}),
              at({0.0f, 0.0f, 0.6f}, -35.0f, glm::vec3(0.8f)));
  addInstance(scene, "Ellipsoid", finishMesh(makeSphereMesh(0.5f, 48, 24)), plain("Green", {0.2f, 0.6f, 0.25f}),
              at({-3.4f, 0.9f, -1.6f}, 40.0f, {0.8f, 1.8f, 0.5f}));
  addInstance(scene, "Mirrored teapot", finishMesh(makeTeapotMesh(6)), plain("Blue", {0.2f, 0.3f, 0.7f}),
              at({-1.2f, 0.0f, 2.2f}, 10.0f, {-0.35f, 0.35f, 0.35f}));

  Mesh facets = makeSphereMesh(0.45f, 10, 6);
  facets.normals.clear();  // flat
  facets.tangents.clear();
  addInstance(scene, "Facets", finishMesh(std::move(facets)), plain("Yellow", {0.8f, 0.7f, 0.2f}),
              at({1.3f, 0.45f, 2.1f}));

  Mesh rainbow = makeSphereMesh(0.4f, 32, 16);
  for (const glm::vec3& n : rainbow.normals) rainbow.colors.emplace_back(0.5f * n + 0.5f, 1.0f);
  addInstance(scene, "Vertex colours", finishMesh(std::move(rainbow)), plain("White", glm::vec3(0.9f)),
              at({0.3f, 2.3f, -2.4f}));

  Material leaf = makeDiffuseMaterial("Leaf", {0.3f, 0.7f, 0.2f});
  leaf.doubleSided = true;
  addInstance(scene, "Leaf", finishMesh(makeQuadMesh({-0.5f, 0, 0}, {1.0f, 0, 0}, {0, 1.2f, 0.5f})),
              addMaterial(scene, std::move(leaf)), at({3.6f, 0.1f, 1.8f}, 150.0f));

  Material lamp = makeDiffuseMaterial("Lamp", glm::vec3(0.1f));
  lamp.constants.emission = {1.6f, 1.3f, 0.7f, 1.0f};
  addInstance(scene, "Lamp", finishMesh(makeBoxMesh(glm::vec3(0.3f))), addMaterial(scene, std::move(lamp)),
              at({-2.2f, 2.2f, -2.0f}, 45.0f));

  Material sign = makeDiffuseMaterial("Sign", {0.9f, 0.2f, 0.5f});
  sign.constants.kind.x = shading::kSurfaceUnlit;
  addInstance(scene, "Sign", finishMesh(makeBoxMesh({0.6f, 0.3f, 0.1f})), addMaterial(scene, std::move(sign)),
              at({2.4f, 2.0f, -2.2f}, -25.0f));
}

void addLight(Scene& scene, const char* name, float kind, glm::vec3 position, glm::vec3 target, glm::vec3 intensity) {
  Node node;
  node.name = name;
  node.translation = position;
  node.rotation = glm::quatLookAt(glm::normalize(target - position), glm::vec3(0, 0, 1));
  PunctualLight light;
  light.node = static_cast<int>(scene.nodes.size());
  light.kind = kind;
  light.intensity = intensity;
  light.range = kind == shading::kLightPoint ? 12.0f : 0.0f;
  light.innerConeAngle = glm::radians(15.0f);
  light.outerConeAngle = glm::radians(35.0f);
  scene.lights.push_back(light);
  scene.nodes.push_back(std::move(node));
}

void removeTextures(Material& material) {
  material.baseColorTexture = material.normalTexture = -1;
  material.constants.baseColorSlot.offset.w = material.constants.normalSlot.offset.w = 0.0f;
}

}  // namespace

Scene makeControlScene(SpecReader& parameters) {
  const bool textures = parameters.integer("textures", 0, 1, 1) == 1;
  Scene scene;
  addTexturedShapes(scene);
  addPlainShapes(scene);
  addDirectionalLight(scene, "Sun", {0.6f, 0.7f, 0.4f}, glm::vec3(1.6f, 1.5f, 1.3f));
  addLight(scene, "Point", shading::kLightPoint, {-2.0f, 3.0f, 2.5f}, {0, 0, 0}, {6.0f, 4.0f, 3.0f});
  addLight(scene, "Spot", shading::kLightSpot, {3.0f, 4.0f, 2.0f}, {1.0f, 0.0f, 0.0f}, {10.0f, 14.0f, 18.0f});
  addCamera(scene, "Camera", {0.8f, 2.6f, 6.4f}, {0.0f, 0.8f, 0.0f}, glm::radians(42.0f), 0.1f);
  scene.environment = makeProceduralSky();
  if (!textures)
    for (Material& material : scene.materials) removeTextures(material);
  return scene;
}

Scene makeControlShadowsScene(SpecReader& parameters) {
  Scene scene = makeControlScene(parameters);
  scene.castsShadows = true;
  // Little ambient light, which has no shadows, so that they are deep.
  scene.environment.ambient = constantAmbient(glm::vec3(0.12f));
  // Shadow maps belong to punctual lights: the lamp is only another box here.
  for (Material& material : scene.materials) material.constants.emission = {0.0f, 0.0f, 0.0f, 1.0f};
  return scene;
}

}  // namespace pb
