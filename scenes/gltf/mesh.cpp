#include "scenes/gltf/mesh.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "scenes/error.h"
#include "scenes/gltf/accessor.h"
#include "scenes/gltf/draco.h"

namespace pb::gltf {
namespace {

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

// Vertex data by attribute name and the indices as stored, before triangulation.
struct RawPrimitive {
  std::map<std::string, FloatAccessor> attributes;
  std::vector<std::uint32_t> indices;
};

std::map<std::string, std::uint32_t> dracoIds(const nlohmann::json& extension) {
  std::map<std::string, std::uint32_t> ids;
  for (const auto& [name, id] : extension["attributes"].items()) ids[name] = id;
  return ids;
}

RawPrimitive readRaw(const Document& document, const tinygltf::Primitive& primitive, const nlohmann::json& json) {
  RawPrimitive raw;
  const bool isDraco = primitive.extensions.contains(kDracoExtension);
  if (isDraco) {
    const nlohmann::json& extension = json["extensions"][kDracoExtension];
    DracoMesh decoded = decodeDraco(bytesOf(document, extension["bufferView"]), dracoIds(extension));
    raw = {std::move(decoded.attributes), std::move(decoded.indices)};
  }
  // A Draco primitive may keep some attributes outside of the compressed data.
  for (const auto& [name, accessor] : primitive.attributes)
    if (!raw.attributes.contains(name)) raw.attributes.emplace(name, readFloats(document, accessor));
  if (isDraco) return raw;
  if (primitive.indices >= 0) {
    raw.indices = readIndices(document, primitive.indices);
  } else if (raw.attributes.contains("POSITION")) {
    raw.indices.resize(raw.attributes["POSITION"].elements.size());
    std::iota(raw.indices.begin(), raw.indices.end(), 0U);
  }
  return raw;
}

// glTF 2.0, section 3.7.2.1: triangle i of a strip or fan.
std::vector<std::uint32_t> triangulated(const std::vector<std::uint32_t>& indices, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return indices;
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      triangles.insert(triangles.end(), {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    else
      triangles.insert(triangles.end(), {indices[i + 1], indices[i + 2], indices[0]});
  }
  return triangles;
}

// The attribute's elements as vectors of fewer components; empty if there is no such attribute.
template <class Vector>
std::vector<Vector> take(const RawPrimitive& raw, const std::string& name, int minComponents, int maxComponents) {
  const auto found = raw.attributes.find(name);
  if (found == raw.attributes.end()) return {};
  const FloatAccessor& values = found->second;
  if (values.components < minComponents || values.components > maxComponents)
    throwInputError("attribute {} wants {} components, got {}", name, maxComponents, values.components);
  return {values.elements.begin(), values.elements.end()};
}

bool isTriangleMode(int mode) {
  return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP || mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

std::string placeOf(const tinygltf::Mesh& mesh, std::size_t meshIndex, std::size_t primitive) {
  return fmt::format("mesh {} primitive {}", label(mesh.name, meshIndex), primitive);
}

// Why the primitive is left out, or "".
std::string reasonToSkip(const tinygltf::Primitive& primitive) {
  if (!isTriangleMode(primitive.mode)) return "points and lines are not drawn";
  if (!primitive.attributes.contains("POSITION")) return "a primitive without positions is not drawn";
  return "";
}

void warnIgnored(const tinygltf::Primitive& primitive, const std::string& place, std::vector<std::string>& warnings) {
  if (!primitive.targets.empty()) warnings.push_back(place + ": morph targets are ignored");
  for (const auto& [name, accessor] : primitive.attributes)
    if (name == "TEXCOORD_2" || name == "COLOR_1")
      warnings.push_back(fmt::format("{}: attribute {} is ignored", place, name));
}

Mesh toMesh(const RawPrimitive& raw, int mode, std::string name) {
  Mesh mesh;
  mesh.name = std::move(name);
  mesh.positions = take<glm::vec3>(raw, "POSITION", 3, 3);
  mesh.normals = take<glm::vec3>(raw, "NORMAL", 3, 3);
  // Tangents belong to given normals; for flat ones they must be ignored (glTF 2.0, section 3.7.2.1).
  if (!mesh.normals.empty()) mesh.tangents = take<glm::vec4>(raw, "TANGENT", 4, 4);
  mesh.uvs = {take<glm::vec2>(raw, "TEXCOORD_0", 2, 2), take<glm::vec2>(raw, "TEXCOORD_1", 2, 2)};
  mesh.colors = take<glm::vec4>(raw, "COLOR_0", 3, 4);
  mesh.indices = triangulated(raw.indices, mode);
  return mesh;
}

}  // namespace

std::shared_ptr<const Mesh> readPrimitive(const Document& document, std::size_t meshIndex, std::size_t primitiveIndex,
                                          std::optional<int> tangentUvSet, std::vector<std::string>& warnings) {
  const tinygltf::Mesh& mesh = document.model.meshes.at(meshIndex);
  const tinygltf::Primitive& primitive = mesh.primitives.at(primitiveIndex);
  const std::string place = placeOf(mesh, meshIndex, primitiveIndex);
  if (const std::string reason = reasonToSkip(primitive); !reason.empty()) {
    warnings.push_back(place + ": " + reason);
    return nullptr;
  }
  warnIgnored(primitive, place, warnings);
  const auto result = atPlace(place, [&] {
    const RawPrimitive raw =
        readRaw(document, primitive, document.json["meshes"][meshIndex]["primitives"][primitiveIndex]);
    const std::string name = mesh.name.empty() ? fmt::format("mesh {}", meshIndex) : mesh.name;
    return finishMesh(toMesh(raw, primitive.mode, name), tangentUvSet.has_value(), tangentUvSet.value_or(0));
  });
  if (result->triangleCount() > 0) return result;
  warnings.push_back(place + ": no triangle has an area");
  return nullptr;
}

}  // namespace pb::gltf
