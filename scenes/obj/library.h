// Material libraries: .mtl files as tinyobjloader reads them, and which statements they had.
#pragma once

#include <tiny_obj_loader.h>

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace pb::obj {

// A material of a library, and which of its statements were there.
struct MtlMaterial {
  tinyobj::material_t values;
  std::set<std::string, std::less<>> statements;

  bool has(std::string_view statement) const { return statements.contains(statement); }
};
using MtlMaterials = std::map<std::string, MtlMaterial, std::less<>>;

// Those of all libraries that the .obj file of this text names; of one name the first. Throws an input Error naming the
// file for anything damaged or missing.
MtlMaterials readLibraries(std::string_view text, const std::filesystem::path& folder);

}  // namespace pb::obj
