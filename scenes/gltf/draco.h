// KHR_draco_mesh_compression.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/gltf/accessor.h"

namespace pb::gltf {

// A decoded mesh: attributes by glTF name, three indices a triangle.
struct DracoMesh {
  std::map<std::string, FloatAccessor> attributes;
  std::vector<std::uint32_t> indices;
};

// `uniqueIds` are the extension's attributes: glTF name to Draco's id. Throws an input Error for damaged data.
DracoMesh decodeDraco(std::span<const std::byte> bytes, const std::map<std::string, std::uint32_t>& uniqueIds);

}  // namespace pb::gltf
