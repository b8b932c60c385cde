// How the numbers of a Track are laid out.
#pragma once

#include <cstddef>

#include "scenes/scene.h"

namespace pb {

// 1, or 3 of a cubic spline.
std::size_t valuesPerKey(const Track& track);

// Numbers a value of a weight track has, 0 if its length is no multiple of the keys'.
std::size_t weightsPerValue(const Track& track);

}  // namespace pb
