// glTF primitives as meshes of the scene model.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace pb::gltf {

// Triangles, strips and fans become triangle lists. nullptr, with a warning, for what can't be drawn: points, lines,
// primitives without positions or without area. Tangents are computed where `tangentUvSet` names texture coordinates
// and the file has none.
std::shared_ptr<const Mesh> readPrimitive(const Document& document, std::size_t mesh, std::size_t primitive,
                                          std::optional<int> tangentUvSet, std::vector<std::string>& warnings);

}  // namespace pb::gltf
