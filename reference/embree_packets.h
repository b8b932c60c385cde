// Embree and nothing else, for measuring: see EmbreeScene::secondsToIntersect().
#pragma once

#include <span>

#include "reference/embree_rays.h"

namespace pb {

double secondsToIntersect(RTCScene scene, std::span<const Ray> rays, int width, bool coherent);

}  // namespace pb
