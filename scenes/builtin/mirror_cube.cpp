// `mirror-cube`: a mirror cube in a room, with things close to its faces. The directions that a flat face reflects span
// few degrees: looked up as if everything were infinitely far away, a near object fills the face.
#include <glm/trigonometric.hpp>

#include "scenes/builtin/room.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr float kCubeEdge = 1.3f;
// Above the floor: surfaces in one plane would flicker.
constexpr float kGap = 0.02f;
constexpr Bounds kRoom = {{-4.0f, 0.0f, -4.0f}, {4.0f, 3.6f, 4.0f}};

void addCube(Scene& scene) {
  Node node;
  node.translation = {0.0f, kGap + 0.5f * kCubeEdge, 0.0f};
  node.rotation = glm::angleAxis(glm::radians(38.0f), glm::vec3(0, 1, 0));
  addInstance(scene, "Mirror cube", finishMesh(makeBoxMesh(glm::vec3(kCubeEdge))),
              addMaterial(scene, makeMirrorMaterial("Mirror", glm::vec3(0.95f))), node);
}

void addBall(Scene& scene, const char* name, glm::vec3 centre, float radius, glm::vec3 albedo) {
  Node node;
  node.translation = centre;
  addInstance(scene, name, finishMesh(makeSphereMesh(radius, 48, 24)),
              addMaterial(scene, makeDiffuseMaterial(name, albedo)), node);
}

void addBox(Scene& scene, const char* name, glm::vec3 foot, glm::vec3 edges, float yawDegrees, glm::vec3 albedo) {
  Node node;
  node.translation = foot + glm::vec3(0.0f, 0.5f * edges.y, 0.0f);
  node.rotation = glm::angleAxis(glm::radians(yawDegrees), glm::vec3(0, 1, 0));
  addInstance(scene, name, finishMesh(makeBoxMesh(edges)), addMaterial(scene, makeDiffuseMaterial(name, albedo)), node);
}

}  // namespace

Scene makeMirrorCubeScene(SpecReader& /*parameters*/) {
  Scene scene;
  addRoom(scene, kRoom,
          {{{{0.62f, 0.20f, 0.16f}},
            {{0.18f, 0.30f, 0.62f}},
            {{0.75f, 0.75f, 0.72f}},
            {{0.55f, 0.50f, 0.42f}},
            {{0.24f, 0.52f, 0.26f}},
            {{0.66f, 0.56f, 0.22f}}}},
          0.5f);
  addCube(scene);
  addBall(scene, "Near ball", {1.35f, 0.32f, 0.4f}, 0.3f, {0.90f, 0.35f, 0.10f});
  addBall(scene, "Hanging ball", {-1.15f, 1.0f, 0.25f}, 0.2f, {0.15f, 0.65f, 0.70f});
  addBox(scene, "Near post", {-1.5f, 0.0f, -0.3f}, {0.22f, 0.8f, 0.22f}, 20.0f, {0.75f, 0.70f, 0.15f});
  addBox(scene, "Far post", {2.3f, 0.0f, -1.2f}, {0.35f, 2.4f, 0.35f}, 35.0f, {0.55f, 0.15f, 0.55f});
  addCamera(scene, "Camera", {0.0f, 1.75f, 3.6f}, {0.0f, 0.68f, 0.0f}, glm::radians(36.0f), 0.05f);
  addDirectionalLight(scene, "Lamp", {0.35f, 0.8f, 0.5f}, glm::vec3(1.6f));
  scene.environment = makeConstantEnvironment(glm::vec3(0.5f));
  return scene;
}

}  // namespace pb
