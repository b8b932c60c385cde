// `mirrors?count=N&probes=P&varnished=V`: the ring of mirror balls of the peer benchmark three-cubecamera (its
// scene-mirrorsN.glb), so that costs compare.
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

struct Cube {
  glm::vec3 centre;
  float yawDegrees;
  glm::vec3 albedo;
};
constexpr float kCubeEdge = 1.2f;
const std::array<Cube, 8> kCubes = {{{{5.5f, 0.6f, 0.0f}, 0.0f, {0.80f, 0.10f, 0.10f}},
                                     {{4.0f, 0.6f, -4.0f}, 45.0f, {0.10f, 0.65f, 0.15f}},
                                     {{1.8f, 0.6f, -6.0f}, 15.0f, {0.10f, 0.20f, 0.80f}},
                                     {{-1.8f, 0.6f, -6.0f}, 30.0f, {0.85f, 0.75f, 0.10f}},
                                     {{-4.0f, 0.6f, -4.0f}, 60.0f, {0.70f, 0.15f, 0.70f}},
                                     {{-5.5f, 0.6f, 0.0f}, 10.0f, {0.10f, 0.70f, 0.75f}},
                                     {{-3.2f, 0.6f, 5.0f}, 20.0f, {0.90f, 0.45f, 0.10f}},
                                     {{3.2f, 0.6f, 5.0f}, 70.0f, {0.85f, 0.85f, 0.85f}}}};

struct Ball {
  glm::vec3 centre;
  glm::vec3 albedo;
};
constexpr float kBallRadius = 0.6f;
const std::array<Ball, 4> kBalls = {{{{0.0f, 0.6f, 0.0f}, {0.90f, 0.80f, 0.15f}},
                                     {{4.4f, 0.6f, 2.4f}, {0.15f, 0.75f, 0.80f}},
                                     {{-4.4f, 0.6f, 2.4f}, {0.80f, 0.20f, 0.60f}},
                                     {{0.0f, 0.6f, -4.4f}, {0.90f, 0.50f, 0.20f}}}};

constexpr float kMirrorRadius = 0.8f;
constexpr double kRingRadius = 2.6;
constexpr int kSegments = 64;
constexpr int kRings = 32;
const glm::vec3 kToLight(0.5f, 0.8f, 0.4f);

// 20 x 20 texels, one a metre, nearest filter: light where column + row is even.
Texture makeChecker() {
  const float light = shading::srgbDecode(220.0f / 255.0f), dark = shading::srgbDecode(90.0f / 255.0f);
  ImageRgba texels(20, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) texels(x, y) = glm::vec4(glm::vec3((x + y) % 2 == 0 ? light : dark), 1.0f);
  return makeTexture("checker", std::move(texels));
}

// Matt, or under a coat of varnish of index 1.5.
Material makePaint(const std::string& name, glm::vec3 albedo, bool isVarnished) {
  Material material = makeDiffuseMaterial(name, albedo);
  if (!isVarnished) return material;
  material.constants.kind.x = shading::kSurfaceGlossy;
  material.constants.factors.y = 0.2f;  // roughness
  material.constants.specular.w = 1.0f;
  return material;
}

void addGround(Scene& scene) {
  Material material = makeTexturedMaterial("Ground", addTexture(scene, makeChecker()), {1.0f, 1.0f});
  material.constants.baseColorSlot.sampler_ = {shading::kWrapClamp, shading::kWrapClamp, shading::kFilterNearest,
                                               shading::kFilterNearest};
  Mesh mesh;
  mesh.name = "Ground";
  mesh.positions = {{-10, 0, -10}, {-10, 0, 10}, {10, 0, 10}, {10, 0, -10}};
  mesh.normals.assign(4, glm::vec3(0, 1, 0));
  mesh.uvs[0] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  addInstance(scene, "Ground", finishMesh(std::move(mesh)), addMaterial(scene, std::move(material)));
}

shading::Sky makeSky() {
  shading::Sky sky;
  sky.horizon = {0.70f, 0.80f, 0.95f, 1.0f};
  sky.zenith = {0.15f, 0.35f, 0.75f, 0.0f};
  sky.below = {0.30f, 0.28f, 0.25f, 0.0f};
  sky.glow = {0.80f, 0.72f, 0.48f, 64.0f};
  sky.toGlow = glm::vec4(glm::normalize(kToLight), 0.0f);
  return sky;
}

}  // namespace

Scene makeMirrorsScene(SpecReader& parameters) {
  const int count = parameters.integer("count", 1, 64, 5);
  const int probes = parameters.integer("probes", 0, 64, 64);
  const bool isVarnished = parameters.integer("varnished", 0, 1, 0) == 1;
  Scene scene;
  addGround(scene);
  const auto cube = finishMesh(makeBoxMesh(glm::vec3(kCubeEdge)));
  for (std::size_t i = 0; i < kCubes.size(); ++i) {
    const std::string name = "Cube_" + std::to_string(i);
    Node node;
    node.translation = kCubes[i].centre;
    node.rotation = glm::angleAxis(glm::radians(kCubes[i].yawDegrees), glm::vec3(0, 1, 0));
    addInstance(scene, name, cube, addMaterial(scene, makeDiffuseMaterial(name, kCubes[i].albedo)), node);
  }
  const auto ball = finishMesh(makeSphereMesh(kBallRadius, kSegments, kRings));
  for (std::size_t i = 0; i < kBalls.size(); ++i) {
    const std::string name = "Sphere_" + std::to_string(i);
    Node node;
    node.translation = kBalls[i].centre;
    addInstance(scene, name, ball, addMaterial(scene, makePaint(name, kBalls[i].albedo, isVarnished)), node);
  }
  const auto mirror = finishMesh(makeSphereMesh(kMirrorRadius, kSegments, kRings));
  const int mirrorMaterial = addMaterial(scene, makeMirrorMaterial("Mirror"));
  for (int k = 0; k < count; ++k) {
    const double angle = glm::two_pi<double>() * k / count;
    Node node;
    node.translation = glm::vec3(kRingRadius * std::sin(angle), 1.0, kRingRadius * std::cos(angle));
    const int added = addInstance(scene, "Mirror_" + std::to_string(k), mirror, mirrorMaterial, node);
    if (k >= probes) scene.nodes[static_cast<std::size_t>(added)].probe.emplace().enabled = false;
  }
  addCamera(scene, "Camera", {0.0f, 2.2f, 7.5f}, {0.0f, 0.85f, 0.0f}, glm::radians(45.0f), 0.1f);
  // Radiance of a diffuse surface: albedo * (0.25 + 0.8 max(0, n.l)).
  addDirectionalLight(scene, "Sun", kToLight, glm::vec3(0.8f * glm::pi<float>()));
  scene.environment = makeGradientEnvironment(makeSky());
  scene.environment.ambient = constantAmbient(glm::vec3(0.25f));
  scene.probeNear = 0.1f;
  return scene;
}

}  // namespace pb
