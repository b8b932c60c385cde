// Which parts of the cube around a probe are captured: pure functions.
#pragma once

#include "raster/technique.h"
#include "scenes/scene.h"

namespace pb {

enum class FacePart { whole, upperHalf, nothing };

// Of face 0..5 (+X -X +Y -Y +Z -Z). The rest of the face shows the environment. Single views are captured as a whole.
FacePart capturedPart(const Technique& technique, int face);

// Faces of which at least a part is captured, 4 to 6.
int capturedFaceCount(const Technique& technique);

// Whether no point of a box that the face sees from `origin` lies in the part.
bool isOutsidePart(const Bounds& box, const glm::vec3& origin, FacePart part);

// Rows of a face of n x n texels that hold the part, from row 0 in memory on. The four sides have +Y at row 0:
// cubeFaceDown() in scenes/shading/cubemap.glsl is -Y for all of them.
int rowsOf(FacePart part, int n);

}  // namespace pb
