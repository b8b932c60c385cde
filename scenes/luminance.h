// Luminance of linear colour with Rec.709 primaries and white: how bright radiance is as one number.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace pb {

// In the colour's own precision; negative channels count as such.
template <class T>
T luminance(const glm::vec<3, T>& rgb) {
  return glm::dot(rgb, glm::vec<3, T>(0.2126, 0.7152, 0.0722));
}

}  // namespace pb
