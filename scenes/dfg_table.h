// Directional albedo of GGX lobes as a table: the "BRDF" half of split-sum image-based light, and what coats keep from
// their bases.
#pragma once

#include "scenes/scene.h"

namespace pb {

inline constexpr int kDfgTableSize = 64;

// One level of kDfgTableSize^2 texels for shading::sampleDfg(): x and y as surfaceDfg() returns them, for one of
// shading::kGeometry*. Computed once a process, at first use; called from any thread.
const Texture& dfgTable(float geometry);

// One value of the table by quadrature: the share of uniform light that a lobe reflects towards NoV in (0, 1], as
// x F0 + y F90 with Schlick's Fresnel. alpha is GGX's.
glm::vec2 computeDfg(float NoV, float alpha, float geometry);

}  // namespace pb
