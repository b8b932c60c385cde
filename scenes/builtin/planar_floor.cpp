// `planar-floor`: one flat mirror as the floor of a room, with objects that stand on it and beyond it. A mirrored
// camera shows exactly what it reflects; a cube map has one point of view for all of it.
#include <glm/trigonometric.hpp>

#include "scenes/builtin/room.h"
#include "scenes/builtin/shapes.h"
#include "scenes/builtin/teapot_mesh.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr Bounds kRoom = {{-6.0f, 0.0f, -5.0f}, {6.0f, 4.5f, 5.0f}};
constexpr float kMirrorHalfEdge = 3.0f;
// The mirror lies on the floor.
constexpr float kMirrorHeight = 0.02f;

// `position` is where the object stands: at its lowest point.
void addStanding(Scene& scene, const char* name, Mesh mesh, glm::vec3 position, glm::quat rotation, glm::vec3 albedo) {
  float lowest = std::numeric_limits<float>::infinity();
  for (const glm::vec3& p : mesh.positions) lowest = std::min(lowest, (rotation * p).y);
  Node node;
  node.translation = position - glm::vec3(0.0f, lowest, 0.0f);
  node.rotation = rotation;
  addInstance(scene, name, finishMesh(std::move(mesh)), addMaterial(scene, makeDiffuseMaterial(name, albedo)), node);
}

glm::quat turned(float degrees, glm::vec3 axis) { return glm::angleAxis(glm::radians(degrees), axis); }

void addObjects(Scene& scene) {
  const glm::vec3 up(0, 1, 0);
  const auto on = [](float x, float z) { return glm::vec3(x, kMirrorHeight, z); };
  const auto beyond = [](float x, float z) { return glm::vec3(x, 0.0f, z); };
  addStanding(scene, "Teapot", makeTeapotMesh(8), on(1.3f, 0.3f), turned(25.0f, up), {0.80f, 0.30f, 0.15f});
  addStanding(scene, "Ball", makeSphereMesh(0.55f, 48, 24), on(-1.5f, 0.4f), turned(0.0f, up), {0.15f, 0.55f, 0.75f});
  addStanding(scene, "Ring", makeTorusMesh(0.75f, 0.16f, 48, 20), on(-0.3f, -1.5f),
              turned(35.0f, up) * turned(90.0f, {1, 0, 0}), {0.80f, 0.70f, 0.15f});
  addStanding(scene, "Post", makeBoxMesh({0.35f, 2.2f, 0.35f}), on(2.3f, -1.9f), turned(20.0f, up),
              {0.55f, 0.20f, 0.60f});
  addStanding(scene, "Column left", makeBoxMesh({0.6f, 3.2f, 0.6f}), beyond(-3.6f, -3.6f), turned(0.0f, up),
              {0.75f, 0.75f, 0.70f});
  addStanding(scene, "Column right", makeBoxMesh({0.6f, 3.2f, 0.6f}), beyond(3.6f, -3.6f), turned(45.0f, up),
              {0.25f, 0.60f, 0.30f});
}

}  // namespace

Scene makePlanarFloorScene(SpecReader& /*parameters*/) {
  Scene scene;
  addRoom(scene, kRoom,
          {{{{0.60f, 0.22f, 0.18f}},
            {{0.20f, 0.30f, 0.60f}},
            {{0.70f, 0.70f, 0.68f}},
            {{0.40f, 0.34f, 0.28f}},
            {{0.30f, 0.45f, 0.30f}},
            {{0.62f, 0.58f, 0.48f}}}},
          0.75f);
  const float h = kMirrorHalfEdge;
  addInstance(scene, "Mirror floor", finishMesh(makeQuadMesh({-h, kMirrorHeight, h}, {2 * h, 0, 0}, {0, 0, -2 * h})),
              addMaterial(scene, makeMirrorMaterial("Mirror", glm::vec3(0.9f))));
  addObjects(scene);
  addCamera(scene, "Camera", {0.3f, 1.9f, 4.8f}, {0.0f, 0.35f, -0.6f}, glm::radians(44.0f), 0.05f);
  addDirectionalLight(scene, "Lamp", {0.45f, 0.8f, 0.6f}, glm::vec3(1.5f));
  scene.environment = makeConstantEnvironment(glm::vec3(0.5f));
  return scene;
}

}  // namespace pb
