// The Utah teapot (M. Newell, 1975) with lid and bottom, from its published control points.
#pragma once

#include "scenes/scene.h"

namespace pb {

// Stands on y = 0, 1.575 m high, axis +Y, spout towards +X. Each bicubic patch is tessellated into segments x segments
// quads; the surface is made of separate parts that touch (body, lid, bottom) or intersect (handle, spout).
Mesh makeTeapotMesh(int segments);

}  // namespace pb
