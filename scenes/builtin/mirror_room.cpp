// `mirror-room?count=N`: small mirror balls in a closed room, far from its walls, under a bright sky that nothing in
// the room shows. Parallax is small here, so that what is left of the error comes from resolution and from missing
// bounces: a map that was captured before another ball had its own shows that ball full of sky.
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr float kRoomHalfEdge = 60.0f;
constexpr int kTilesPerWall = 12;
constexpr float kBallRadius = 0.3f;
constexpr double kRingRadius = 0.9;

// The six walls seen from inside: cross(u, v) points inwards.
struct Wall {
  const char* name;
  glm::vec3 p, u, v;  // in units of half the room's edge
  glm::vec3 albedo;
};
const std::array<Wall, 6> kWalls = {{
    {"Right", {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, {0.55f, 0.12f, 0.10f}},
    {"Left", {-1, -1, 1}, {0, 0, -2}, {0, 2, 0}, {0.10f, 0.16f, 0.50f}},
    {"Ceiling", {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, {0.60f, 0.60f, 0.58f}},
    {"Floor", {-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, {0.30f, 0.26f, 0.20f}},
    {"Front", {1, -1, 1}, {-2, 0, 0}, {0, 2, 0}, {0.14f, 0.40f, 0.16f}},
    {"Back", {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, {0.50f, 0.44f, 0.16f}},
}};

// Two by two smooth bumps that repeat: detail without edges, which would move with the smallest shift.
Texture makePattern() {
  constexpr int kSize = 64;
  ImageRgba texels(kSize, kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const float u = glm::two_pi<float>() * (static_cast<float>(x) + 0.5f) / kSize;
      const float v = glm::two_pi<float>() * (static_cast<float>(y) + 0.5f) / kSize;
      texels(x, y) = glm::vec4(glm::vec3(0.5f + 0.5f * std::sin(u) * std::sin(v)), 1.0f);
    }
  return makeTexture("pattern", std::move(texels));
}

}  // namespace

Scene makeMirrorRoomScene(SpecReader& parameters) {
  const int count = parameters.integer("count", 1, 16, 5);
  Scene scene;
  const int pattern = addTexture(scene, makePattern());
  for (const Wall& wall : kWalls)
    addInstance(scene, wall.name,
                finishMesh(makeQuadMesh(kRoomHalfEdge * wall.p, kRoomHalfEdge * wall.u, kRoomHalfEdge * wall.v)),
                addMaterial(scene, makeTexturedMaterial(wall.name, pattern, glm::vec2(kTilesPerWall), wall.albedo)));
  const auto ball = finishMesh(makeSphereMesh(kBallRadius, 64, 32));
  const int mirror = addMaterial(scene, makeMirrorMaterial("Mirror"));
  for (int k = 0; k < count; ++k) {
    const double angle = glm::two_pi<double>() * k / count;
    Node node;
    node.translation = glm::vec3(kRingRadius * std::sin(angle), 0.0, kRingRadius * std::cos(angle));
    addInstance(scene, "Mirror_" + std::to_string(k), ball, mirror, node);
  }
  addCamera(scene, "Camera", {0.0f, 1.5f, 3.6f}, glm::vec3(0.0f), glm::radians(36.0f), 0.05f);
  // Outside, and without shadows: shines on the walls through each other.
  addDirectionalLight(scene, "Lamp", {0.3f, 0.8f, 0.5f}, glm::vec3(1.2f));
  scene.environment = makeConstantEnvironment(glm::vec3(1.5f, 1.7f, 2.0f));
  scene.environment.ambient = constantAmbient(glm::vec3(0.6f));
  return scene;
}

}  // namespace pb
