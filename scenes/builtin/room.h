// Closed rooms around scenes, and the materials of their walls.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "scenes/scene.h"

namespace pb {

// A matte material in a checker of two tones, `albedo` and half of it, `repeats` times two tiles along u and v.
Material makeCheckeredMaterial(Scene& scene, std::string name, glm::vec3 albedo, glm::vec2 repeats);

// Albedos of the walls on the sides +X -X +Y -Y +Z -Z; sides without one stay open.
using Walls = std::array<std::optional<glm::vec3>, 6>;

// Walls, ceiling and floor that face inwards, with checkers of square tiles. The box becomes Scene::room.
void addRoom(Scene& scene, const Bounds& room, const Walls& walls, float tileMetres);

}  // namespace pb
