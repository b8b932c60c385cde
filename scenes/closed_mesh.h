// Whether meshes bound a volume: what refraction through glass with a thickness relies on.
#pragma once

#include <span>

#include "scenes/scene.h"

namespace pb {

enum class Boundary {
  closed,     // every edge is run through as often in one direction as in the other
  open,       // some edge is not
  insideOut,  // closed, but its triangles face the inside
};

// Of all triangles of the meshes together. Positions closer than 1e-5 of the size of the whole count as one, so that
// seams of texture coordinates and of normals, and their rounding, are no holes.
Boundary boundaryOf(std::span<const Mesh* const> meshes);

// Appends a warning for each node whose glass with a thickness is not closed: light that enters it may never leave it
// again. The glass primitives of a node count as one body.
void warnOfOpenGlass(Scene& scene);

}  // namespace pb
