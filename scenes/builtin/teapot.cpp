// `teapot`: the moving scene of the suite `quick`: a mirror teapot, and a matte one that circles it once in two
// seconds.
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/builtin/teapot_mesh.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr float kPeriodSeconds = 2.0f;

Texture makeTiles() {
  // 64 texels a tile of 1 m, four tiles, with a joint of two texels.
  ImageRgba texels(128, 128);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      const bool joint = x % 64 < 2 || y % 64 < 2;
      const bool light = (x / 64 + y / 64) % 2 == 0;
      texels(x, y) = joint   ? glm::vec4(0.05f, 0.05f, 0.05f, 1.0f)
                     : light ? glm::vec4(0.72f, 0.66f, 0.55f, 1.0f)
                             : glm::vec4(0.20f, 0.24f, 0.30f, 1.0f);
    }
  return makeTexture("tiles", std::move(texels));
}

void addFloor(Scene& scene) {
  const int tiles = addTexture(scene, makeTiles());
  addInstance(scene, "Floor", finishMesh(makeQuadMesh({-6, 0, 6}, {12, 0, 0}, {0, 0, -12})),
              addMaterial(scene, makeTexturedMaterial("Floor", tiles, {6.0f, 6.0f})));
}

// Quarter turns as key frames: linear rotations between them are exact.
Track makeOrbit(int node) {
  Track track;
  track.node = node;
  track.target = TrackTarget::rotation;
  for (int quarter = 0; quarter <= 4; ++quarter) {
    const glm::quat q = glm::angleAxis(glm::half_pi<float>() * static_cast<float>(quarter), glm::vec3(0, 1, 0));
    track.timesSeconds.push_back(kPeriodSeconds * static_cast<float>(quarter) / 4.0f);
    track.values.emplace_back(q.x, q.y, q.z, q.w);
  }
  return track;
}

void addPillars(Scene& scene) {
  const auto pillar = finishMesh(makeBoxMesh({0.5f, 2.4f, 0.5f}));
  const std::array<glm::vec3, 4> albedos = {
      {{0.75f, 0.15f, 0.10f}, {0.10f, 0.55f, 0.20f}, {0.12f, 0.25f, 0.70f}, {0.80f, 0.65f, 0.10f}}};
  for (std::size_t i = 0; i < albedos.size(); ++i) {
    const float angle = glm::radians(45.0f + 90.0f * static_cast<float>(i));
    Node node;
    node.translation = {4.2f * glm::cos(angle), 1.2f, 4.2f * glm::sin(angle)};
    node.rotation = glm::angleAxis(0.4f * static_cast<float>(i), glm::vec3(0, 1, 0));
    const std::string name = "Pillar_" + std::to_string(i);
    addInstance(scene, name, pillar, addMaterial(scene, makeDiffuseMaterial(name, albedos[i])), node);
  }
}

}  // namespace

Scene makeTeapotScene(SpecReader& /*parameters*/) {
  Scene scene;
  addFloor(scene);
  addPillars(scene);
  const auto teapot = finishMesh(makeTeapotMesh(10));
  Node centre;
  centre.rotation = glm::angleAxis(glm::radians(20.0f), glm::vec3(0, 1, 0));
  addInstance(scene, "Mirror teapot", teapot, addMaterial(scene, makeMirrorMaterial("Mirror", {0.95f, 0.93f, 0.88f})),
              centre);

  Node pivot;
  pivot.name = "Orbit";
  const int pivotIndex = static_cast<int>(scene.nodes.size());
  scene.nodes.push_back(pivot);
  scene.tracks.push_back(makeOrbit(pivotIndex));
  Node orbiting;
  orbiting.parent = pivotIndex;
  orbiting.translation = {-2.25f, 0.35f, -0.5f};
  orbiting.scale = glm::vec3(0.6f);
  addInstance(scene, "Matte teapot", teapot, addMaterial(scene, makeDiffuseMaterial("Matte", {0.85f, 0.25f, 0.15f})),
              orbiting);

  addCamera(scene, "Camera", {0.6f, 2.4f, 5.2f}, {0.0f, 0.7f, 0.0f}, glm::radians(40.0f), 0.1f);
  addDirectionalLight(scene, "Sun", {0.4f, 0.8f, 0.5f}, glm::vec3(2.4f, 2.3f, 2.1f));
  scene.environment = makeProceduralSky();
  scene.framesPerSecond = 30.0;
  return scene;
}

}  // namespace pb
