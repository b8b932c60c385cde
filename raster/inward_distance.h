// How far a closed mesh reaches behind its own surface: a pure function of the mesh.
#pragma once

#include <vector>

#include "scenes/scene.h"

namespace pb {

// By vertex, in object space: the distance along the inward normal to the first triangle that is seen from behind, d_N
// of Wyman, "An Approximate Image-Space Approach for Interactive Refraction" (2005). Where there is none, because the
// mesh is open, the distance to the mesh's bounding box. The mean over the corners of the triangles that share the
// vertex: each corner's ray starts a little inside of its triangle, since at a vertex it would run along neighbours'
// edges.
std::vector<float> inwardDistances(const Mesh& mesh);

}  // namespace pb
