#include "raster/culling.h"

#include <array>
#include <glm/geometric.hpp>

namespace pb {
namespace {

// Rounding of boxes and planes, relative to the sizes of the numbers involved: some tens of units in the last place.
constexpr float kMargin = 1e-5f;

}  // namespace

bool isBehindPlane(const Bounds& box, const glm::vec3& normal, float offset) {
  const glm::vec3 farthest = glm::mix(box.lower, box.upper, glm::greaterThan(normal, glm::vec3(0.0f)));
  const float magnitude = glm::dot(glm::abs(normal), glm::abs(farthest)) + glm::abs(offset);
  return glm::dot(normal, farthest) + offset < -kMargin * magnitude;
}

bool isOutsideFrustum(const Bounds& box, const shading::View& view) {
  const glm::vec3 origin(view.origin), forward(view.forward), right(view.right), down(view.down);
  // Inside is |x| <= w and |y| <= w of clipFromWorldPosition() in shading/view.glsl, and w >= near.
  const glm::vec3 s = right / glm::dot(right, right);
  const glm::vec3 t = down / glm::dot(down, down);
  const std::array<glm::vec3, 4> sides = {forward + s, forward - s, forward + t, forward - t};
  for (const glm::vec3& normal : sides)
    if (isBehindPlane(box, normal, -glm::dot(normal, origin))) return true;
  return isBehindPlane(box, forward, -glm::dot(forward, origin) - view.origin.w);
}

}  // namespace pb
