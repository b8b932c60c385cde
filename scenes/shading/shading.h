// The shading model as C++: the *.glsl files of this folder compiled through GLM in namespace pb::shading.
//
// The files are written in the common subset of GLSL 4.50 and C++20. GLSL's texture functions are given here for
// textures in memory, so that filtering, too, has one spelling. What differs between the renderers (light loops,
// random numbers, where a reflected ray ends) stays outside.
#pragma once

#include <array>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "scenes/image.h"

namespace pb::shading {

using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

using glm::abs;
using glm::atan;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::floor;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::pow;
using glm::sin;
using glm::sqrt;

// A mipmapped texture: level 0 first. Must not be empty when it is sampled.
struct sampler2D {
  const std::vector<ImageRgba>* levels;
};
// Layers of one level, all of the same size.
struct sampler2DArray {
  const std::vector<ImageRgba>* layers;
};

inline ivec2 textureSize(sampler2D image, int level) {
  const ImageRgba& texels = (*image.levels)[static_cast<std::size_t>(level)];
  return {texels.width(), texels.height()};
}
inline int textureQueryLevels(sampler2D image) { return static_cast<int>(image.levels->size()); }
inline vec4 texelFetch(sampler2D image, ivec2 p, int level) {
  return (*image.levels)[static_cast<std::size_t>(level)](p.x, p.y);
}
inline ivec3 textureSize(sampler2DArray image, int /*level*/) {
  const ImageRgba& texels = image.layers->front();
  return {texels.width(), texels.height(), static_cast<int>(image.layers->size())};
}
inline vec4 texelFetch(sampler2DArray image, ivec3 p, int /*level*/) {
  return (*image.layers)[static_cast<std::size_t>(p.z)](p.x, p.y);
}

#define PB_FUNC inline
#include "scenes/shading/common.glsl"
// common.glsl first; the rest in order of dependence.
#include "scenes/shading/area_light.glsl"
#include "scenes/shading/cubemap.glsl"
#include "scenes/shading/environment.glsl"
#include "scenes/shading/fresnel.glsl"
#include "scenes/shading/light.glsl"
#include "scenes/shading/microfacet.glsl"
#include "scenes/shading/proxy.glsl"
#include "scenes/shading/screen.glsl"
#include "scenes/shading/srgb.glsl"
#include "scenes/shading/surface.glsl"
#include "scenes/shading/texture.glsl"
#include "scenes/shading/view.glsl"
#include "scenes/shading/volume.glsl"
#undef PB_FUNC

// These travel in GPU buffers as they are: vec4 members only, so std140, std430 and C++ agree.
static_assert(sizeof(Sky) == 5 * 16 && sizeof(Ambient) == 9 * 16 && sizeof(Light) == 4 * 16 && sizeof(View) == 4 * 16);
static_assert(sizeof(TextureSlot) == 3 * 16 && sizeof(MaterialConstants) == (9 + 5 * 3) * 16);
static_assert(sizeof(AreaLight) == 4 * 16);
static_assert(offsetof(MaterialConstants, baseColorSlot) == 9 * 16 &&
              offsetof(MaterialConstants, occlusionSlot) == 9 * 16 + 4 * 48);

}  // namespace pb::shading
