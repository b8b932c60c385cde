// `hall-of-mirrors`: a corridor between two facing mirrors. Each bounce shows it once more, dimmed to nine tenths.
#include <glm/trigonometric.hpp>

#include "scenes/builtin/room.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr Bounds kRoom = {{-1.8f, 0.0f, -5.5f}, {1.8f, 2.8f, 4.5f}};

void addMirrors(Scene& scene) {
  const int mirror = addMaterial(scene, makeMirrorMaterial("Mirror", glm::vec3(0.9f)));
  const glm::vec3 size = kRoom.extent();
  addInstance(scene, "Right mirror",
              finishMesh(makeQuadMesh({kRoom.upper.x, kRoom.lower.y, kRoom.lower.z}, {0, 0, size.z}, {0, size.y, 0})),
              mirror);
  addInstance(scene, "Left mirror",
              finishMesh(makeQuadMesh({kRoom.lower.x, kRoom.lower.y, kRoom.upper.z}, {0, 0, -size.z}, {0, size.y, 0})),
              mirror);
}

// Between the panes, so that reflections can be told apart and counted.
void addPilasters(Scene& scene) {
  const auto pilaster = finishMesh(makeBoxMesh({0.12f, kRoom.upper.y, 0.2f}));
  const int plaster = addMaterial(scene, makeDiffuseMaterial("Plaster", {0.62f, 0.55f, 0.42f}));
  for (int k = 0; k < 4; ++k)
    for (const float side : {-1.0f, 1.0f}) {
      Node node;
      node.translation = {side * (kRoom.upper.x - 0.06f), 0.5f * kRoom.upper.y, -4.4f + 2.4f * static_cast<float>(k)};
      addInstance(scene, "Pilaster_" + std::to_string(2 * k + (side > 0.0f ? 1 : 0)), pilaster, plaster, node);
    }
}

// Balls on plinths, alternately left and right.
void addExhibits(Scene& scene) {
  const std::array<glm::vec3, 4> albedos = {
      {{0.80f, 0.20f, 0.12f}, {0.15f, 0.35f, 0.75f}, {0.20f, 0.60f, 0.20f}, {0.80f, 0.65f, 0.12f}}};
  const auto plinth = finishMesh(makeBoxMesh({0.4f, 0.8f, 0.4f}));
  const auto ball = finishMesh(makeSphereMesh(0.28f, 40, 20));
  const int stone = addMaterial(scene, makeDiffuseMaterial("Stone", glm::vec3(0.5f)));
  for (std::size_t i = 0; i < albedos.size(); ++i) {
    const glm::vec3 foot(i % 2 == 0 ? 0.75f : -0.75f, 0.0f, 1.4f - 1.7f * static_cast<float>(i));
    const std::string number = std::to_string(i);
    Node below, above;
    below.translation = foot + glm::vec3(0.0f, 0.4f, 0.0f);
    above.translation = foot + glm::vec3(0.0f, 1.08f, 0.0f);
    addInstance(scene, "Plinth_" + number, plinth, stone, below);
    addInstance(scene, "Ball_" + number, ball, addMaterial(scene, makeDiffuseMaterial("Ball_" + number, albedos[i])),
                above);
  }
}

}  // namespace

Scene makeHallOfMirrorsScene(SpecReader& /*parameters*/) {
  Scene scene;
  addRoom(
      scene, kRoom,
      {{{}, {}, {{0.70f, 0.70f, 0.74f}}, {{0.45f, 0.32f, 0.22f}}, {{0.25f, 0.42f, 0.50f}}, {{0.60f, 0.25f, 0.20f}}}},
      0.6f);
  addMirrors(scene);
  addPilasters(scene);
  addExhibits(scene);
  addCamera(scene, "Camera", {-1.3f, 1.6f, 2.4f}, {1.0f, 1.1f, 0.35f}, glm::radians(48.0f), 0.05f);
  addDirectionalLight(scene, "Lamp", {0.3f, 0.8f, 0.5f}, glm::vec3(1.6f));
  scene.environment = makeConstantEnvironment(glm::vec3(0.5f));
  return scene;
}

}  // namespace pb
