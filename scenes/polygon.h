// Polygons into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace pb {

// Triangles of a simple polygon, convex or not, as indices of its corners in the polygon's orientation: corners - 2 of
// them. Of one that crosses itself they cover what they can. Empty if the polygon has no area. O(corners^2) for convex
// ones, up to O(corners^3).
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const glm::vec3> corners);

}  // namespace pb
