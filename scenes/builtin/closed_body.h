// Smooth closed bodies, made by code.
#pragma once

#include <functional>

#include "scenes/scene.h"

namespace pb {

// Where the surface is: along its axis from 0 to 1, both single points, and once around it from 0 to 1.
using BodyPoint = std::function<glm::dvec3(double along, double around)>;

// `rings` bands of `columns` quads, triangles at the two ends. Every edge belongs to two triangles; normals point
// outwards, the mean of the adjacent triangles' by their angle.
Mesh makeClosedBody(int rings, int columns, const BodyPoint& point);

// |x|^exponent with the sign of x.
double signedPower(double x, double exponent);

}  // namespace pb
