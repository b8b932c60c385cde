// View frustum culling of boxes: a pure function.
#pragma once

#include "scenes/scene.h"
#include "scenes/shading/shading.h"

namespace pb {

// True only if no point of the box has dot(normal, p) + offset >= 0, but for rounding.
bool isBehindPlane(const Bounds& box, const glm::vec3& normal, float offset);

// True only if no point of the box can be seen: the box lies wholly outside one of the frustum's planes (near and four
// sides; there is no far plane). Boxes near the frustum's edges may be called visible although they are not.
bool isOutsideFrustum(const Bounds& box, const shading::View& view);

}  // namespace pb
