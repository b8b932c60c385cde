#include "scenes/gltf/mesh.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <map>
#include <numeric>
#include <set>

#include "scenes/error.h"
#include "scenes/gltf/accessor.h"
#include "scenes/gltf/draco.h"

namespace pb::gltf {
namespace {

constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

// Vertex data by attribute name and the indices as stored, before triangulation.
struct RawPrimitive {
  std::map<std::string, FloatAccessor> attributes;
  std::vector<std::map<std::string, FloatAccessor>> targets;
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
    raw = {std::move(decoded.attributes), {}, std::move(decoded.indices)};
  }
  for (const std::map<std::string, int>& target : primitive.targets) {
    raw.targets.emplace_back();
    for (const auto& [name, accessor] : target) raw.targets.back().emplace(name, readFloats(document, accessor));
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
std::vector<Vector> take(const std::map<std::string, FloatAccessor>& attributes, const std::string& name,
                         int minComponents, int maxComponents) {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return {};
  const FloatAccessor& values = found->second;
  if (values.components < minComponents || values.components > maxComponents)
    throwInputError("attribute {} wants {} components, got {}", name, maxComponents, values.components);
  return {values.elements.begin(), values.elements.end()};
}

// Indices were read as floats, which hold all of 16 bits.
std::vector<glm::u16vec4> takeJoints(const RawPrimitive& raw) {
  std::vector<glm::u16vec4> joints;
  for (const glm::vec4& j : take<glm::vec4>(raw.attributes, "JOINTS_0", 4, 4)) {
    if (glm::any(glm::lessThan(j, glm::vec4(0.0f))) || glm::any(glm::greaterThan(j, glm::vec4(65535.0f))) ||
        j != glm::floor(j))
      throwInputError("attribute JOINTS_0 wants whole numbers from 0 to 65535, got {} {} {} {}", j.x, j.y, j.z, j.w);
    joints.emplace_back(j);
  }
  return joints;
}

MorphTarget takeTarget(const std::map<std::string, FloatAccessor>& attributes, bool hasNormals) {
  MorphTarget target;
  target.positions = take<glm::vec3>(attributes, "POSITION", 3, 3);
  // Of flat normals, which are computed, and their tangents there is nothing to add to.
  if (hasNormals) target.normals = take<glm::vec3>(attributes, "NORMAL", 3, 3);
  if (hasNormals) target.tangents = take<glm::vec3>(attributes, "TANGENT", 3, 3);
  return target;
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
  for (const auto& [name, accessor] : primitive.attributes) {
    if (name == "TEXCOORD_2" || name == "COLOR_1")
      warnings.push_back(fmt::format("{}: attribute {} is ignored", place, name));
    if (name == "JOINTS_1")
      warnings.push_back(place + ": attribute JOINTS_1 is ignored, the first four joints of a vertex move it");
  }
  std::set<std::string> unread;
  for (const std::map<std::string, int>& target : primitive.targets)
    for (const auto& [name, accessor] : target)
      if (name != "POSITION" && name != "NORMAL" && name != "TANGENT") unread.insert(name);
  for (const std::string& name : unread)
    warnings.push_back(fmt::format("{}: attribute {} of morph targets is ignored", place, name));
}

Mesh toMesh(const RawPrimitive& raw, int mode, std::string name) {
  Mesh mesh;
  mesh.name = std::move(name);
  const std::map<std::string, FloatAccessor>& attributes = raw.attributes;
  mesh.positions = take<glm::vec3>(attributes, "POSITION", 3, 3);
  mesh.normals = take<glm::vec3>(attributes, "NORMAL", 3, 3);
  // Tangents belong to given normals; for flat ones they must be ignored (glTF 2.0, section 3.7.2.1).
  if (!mesh.normals.empty()) mesh.tangents = take<glm::vec4>(attributes, "TANGENT", 4, 4);
  mesh.uvs = {take<glm::vec2>(attributes, "TEXCOORD_0", 2, 2), take<glm::vec2>(attributes, "TEXCOORD_1", 2, 2)};
  mesh.colors = take<glm::vec4>(attributes, "COLOR_0", 3, 4);
  for (const auto& target : raw.targets) mesh.targets.push_back(takeTarget(target, !mesh.normals.empty()));
  mesh.joints = takeJoints(raw);
  mesh.jointWeights = take<glm::vec4>(attributes, "WEIGHTS_0", 4, 4);
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
