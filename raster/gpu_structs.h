// Buffer contents and binding points shared with the shaders: raster/shaders/gpu_structs.glsl as C++.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "scenes/shading/shading.h"

namespace pb::gpu {

using glm::ivec4;
using glm::mat4;
using glm::vec4;
using shading::Ambient;
using shading::Sky;
using shading::View;

#include "raster/shaders/gpu_structs.glsl"

static_assert(sizeof(PassConstants) == 7 * 16 && sizeof(SceneConstants) == 14 * 16);
static_assert(sizeof(ProbeConstants) == 4 * 16);
static_assert(sizeof(ShadowFace) == 5 * 16);
static_assert(sizeof(LookupScan) == 3 * 16);
static_assert(sizeof(InstanceConstants) == 10 * 16 && offsetof(InstanceConstants, values) == 8 * 16);

}  // namespace pb::gpu
