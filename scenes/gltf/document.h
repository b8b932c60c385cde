// A glTF 2.0 file, parsed and with every index and type in its JSON checked: what code that walks it may rely on.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/error.h"
#include "scenes/gltf/tinygltf.h"
#include "scenes/place.h"

namespace pb::gltf {

struct Document {
  nlohmann::json json;    // the whole file; extensions and extras are read from here
  tinygltf::Model model;  // the same without images and Draco indices; buffers loaded
  std::string folder;     // of the file, for the paths of images
};

// Parses .gltf or .glb, told by content; external files are found in `folder`, an absolute path. Throws an input Error
// whose place is inside the file: the caller adds its name.
Document parseDocument(const std::string& bytes, const std::string& folder);

// Bytes of a checked buffer view, inside its buffer.
std::span<const std::byte> bytesOf(const Document& document, int bufferView);

// Bytes of images[index], from wherever the file keeps them.
std::string imageBytes(const Document& document, int index);

// "'name'" or "3" where there is no name.
std::string label(const std::string& name, std::size_t index);

// A .glb of one JSON and one binary chunk.
std::string packGlb(const nlohmann::json& json, std::string_view binary);

}  // namespace pb::gltf
