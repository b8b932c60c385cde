// Tangent frames of normal-mapped meshes that bring none.
#pragma once

#include "scenes/scene.h"

namespace pb {

// Fills mesh.tangents from its normals and texture coordinates of set `uvSet` (any vector across the normal where there
// are none) by MikkTSpace, which glTF 2.0 (3.7.2.1) asks for: Mikkelsen, "Simulation of Wrinkled Surfaces Revisited"
// (2008), with an angular threshold of 180 degrees. w is the sign for a bitangent that points up in the picture,
// against v. Vertices are split where the frames of their triangles differ: at mirrored and at unconnected texture
// coordinates. Wants triangles with area and unit normals.
void computeTangents(Mesh& mesh, int uvSet);

}  // namespace pb
