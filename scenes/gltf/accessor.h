// Values of glTF accessors as floats or indices, with sparse substitution and normalised integers; every access is
// checked against the buffer first. Errors name the accessor.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "scenes/gltf/document.h"

namespace pb::gltf {

// Elements of up to four components; missing ones are 0, the fourth 1. All values are finite.
struct FloatAccessor {
  int components = 0;
  std::vector<glm::vec4> elements;
};

FloatAccessor readFloats(const Document& document, int accessor);

// Of an accessor of 4x4 matrices. All values are finite.
std::vector<glm::mat4> readMatrices(const Document& document, int accessor);

// Of an accessor of unsigned integers.
std::vector<std::uint32_t> readIndices(const Document& document, int accessor);

}  // namespace pb::gltf
