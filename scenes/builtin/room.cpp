#include "scenes/builtin/room.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scenes/builtin/shapes.h"

namespace pb {
namespace {

// A side of the cube [-1,1]^3 seen from inside: cross(u, v) points inwards.
struct Side {
  const char* name;
  glm::vec3 p, u, v;
};
const std::array<Side, 6> kSides = {{
    {"Wall +X", {1, -1, -1}, {0, 0, 2}, {0, 2, 0}},
    {"Wall -X", {-1, -1, 1}, {0, 0, -2}, {0, 2, 0}},
    {"Ceiling", {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}},
    {"Floor", {-1, -1, 1}, {2, 0, 0}, {0, 0, -2}},
    {"Wall +Z", {1, -1, 1}, {-2, 0, 0}, {0, 2, 0}},
    {"Wall -Z", {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}},
}};

// 2 x 2 tiles: textures of one texel a tile would have to be magnified, and their edges be blurred or jagged.
Texture makeChecker() {
  constexpr int kTile = 32;
  const glm::vec4 light(1.0f), dark = roundedToBytes(glm::vec4(0.5f, 0.5f, 0.5f, 1.0f));
  ImageRgba texels(2 * kTile, 2 * kTile);
  for (int y = 0; y < 2 * kTile; ++y)
    for (int x = 0; x < 2 * kTile; ++x) texels(x, y) = (x / kTile + y / kTile) % 2 == 0 ? light : dark;
  return makeTexture("checker", std::move(texels));
}

int checkerOf(Scene& scene) {
  for (std::size_t i = 0; i < scene.textures.size(); ++i)
    if (scene.textures[i].name == "checker") return static_cast<int>(i);
  return addTexture(scene, makeChecker());
}

}  // namespace

Material makeCheckeredMaterial(Scene& scene, std::string name, glm::vec3 albedo, glm::vec2 repeats) {
  return makeTexturedMaterial(std::move(name), checkerOf(scene), repeats, albedo);
}

void addRoom(Scene& scene, const Bounds& room, const Walls& walls, float tileMetres) {
  const glm::vec3 half = 0.5f * room.extent();
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    if (!walls[i]) continue;
    const glm::vec3 u = half * kSides[i].u, v = half * kSides[i].v;
    const glm::vec2 repeats = glm::vec2(glm::length(u), glm::length(v)) / (2.0f * tileMetres);
    const int material = addMaterial(scene, makeCheckeredMaterial(scene, kSides[i].name, *walls[i], repeats));
    addInstance(scene, kSides[i].name, finishMesh(makeQuadMesh(room.centre() + half * kSides[i].p, u, v)), material);
  }
  scene.room = room;
}

}  // namespace pb
