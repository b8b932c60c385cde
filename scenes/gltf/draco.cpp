#include "scenes/gltf/draco.h"

#include <draco/compression/decode.h>

#include <array>
#include <cmath>
#include <memory>

#include "scenes/error.h"

namespace pb::gltf {
namespace {

FloatAccessor readAttribute(const draco::Mesh& mesh, const std::string& name, std::uint32_t uniqueId) {
  const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(uniqueId);
  if (attribute == nullptr) throwInputError("the Draco data has no attribute {} ('{}')", uniqueId, name);
  const int components = attribute->num_components();
  if (components < 1 || components > 4)
    throwInputError("Draco attributes have 1 to 4 components, '{}' has {}", name, components);
  FloatAccessor result{components, {}};
  result.elements.reserve(mesh.num_points());
  for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
    std::array<float, 4> value = {0.0f, 0.0f, 0.0f, 1.0f};
    const draco::AttributeValueIndex index = attribute->mapped_index(point);
    if (index.value() >= attribute->size() ||
        !attribute->ConvertValue<float>(index, static_cast<std::int8_t>(components), value.data()))
      throwInputError("the Draco attribute '{}' can't be read as floats", name);
    for (const float v : value)
      if (!std::isfinite(v)) throwInputError("the Draco attribute '{}' has a value that is not finite", name);
    result.elements.emplace_back(value[0], value[1], value[2], value[3]);
  }
  return result;
}

}  // namespace

DracoMesh decodeDraco(std::span<const std::byte> bytes, const std::map<std::string, std::uint32_t>& uniqueIds) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  draco::StatusOr<std::unique_ptr<draco::Mesh>> decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throwInputError("the Draco data can't be decoded: {}", decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  DracoMesh result;
  for (const auto& [name, uniqueId] : uniqueIds) result.attributes.emplace(name, readAttribute(mesh, name, uniqueId));
  result.indices.reserve(std::size_t{3} * mesh.num_faces());
  for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
    for (const draco::PointIndex& point : mesh.face(face)) result.indices.push_back(point.value());
  return result;
}

}  // namespace pb::gltf
