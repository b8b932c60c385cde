// Meshes with fewer triangles: a pure function. Only simplify.cpp knows the library that makes them.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace pb {

// Indices into the mesh's own vertices of about `share` of its triangles, at least one; vertices keep their attributes.
// More triangles are left where fewer would change which parts are connected, as hard edges and corners of texture
// seams stay, or would move the surface by more than a tenth of the mesh's extent.
std::vector<std::uint32_t> simplifiedTriangles(const Mesh& mesh, float share);

}  // namespace pb
