#include "scenes/gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "scenes/error.h"

namespace pb::gltf {
namespace {

// Accessors without data of their own are zeros; a count alone must not claim gigabytes.
constexpr std::size_t kMaxZeroElements = std::size_t{1} << 24;

// `count` elements of `components` components, `stride` bytes apart, all inside `bytes`.
struct Elements {
  std::span<const std::byte> bytes;
  std::size_t count;
  std::size_t stride;
  int components;
  int componentType;

  const std::byte* at(std::size_t element, int component) const;
};

std::size_t componentSize(int componentType) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      throwInputError("component types are 5120 to 5123, 5125 and 5126, got {}", componentType);
  }
}

const std::byte* Elements::at(std::size_t element, int component) const {
  return &bytes[element * stride + static_cast<std::size_t>(component) * componentSize(componentType)];
}

template <class T>
T load(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

// glTF 2.0, section 3.6.2.2.
template <class Integer>
float floatOf(const std::byte* bytes, bool normalized) {
  const auto value = static_cast<float>(load<Integer>(bytes));
  return normalized ? std::max(value / static_cast<float>(std::numeric_limits<Integer>::max()), -1.0f) : value;
}

float floatAt(const std::byte* bytes, int componentType, bool normalized) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return floatOf<std::int8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return floatOf<std::uint8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return floatOf<std::int16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return floatOf<std::uint16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return floatOf<std::uint32_t>(bytes, normalized);
    default:
      return load<float>(bytes);
  }
}

std::uint32_t indexAt(const Elements& elements, std::size_t i) {
  switch (elements.componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(elements.at(i, 0));
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(elements.at(i, 0));
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<std::uint32_t>(elements.at(i, 0));
    default:
      throwInputError("indices are unsigned integers, got component type {}", elements.componentType);
  }
}

Elements locate(const Document& document, int bufferView, std::size_t byteOffset, std::size_t count, int components,
                int componentType) {
  const std::span<const std::byte> bytes = bytesOf(document, bufferView);
  const std::size_t elementSize = static_cast<std::size_t>(components) * componentSize(componentType);
  const std::size_t byteStride = document.model.bufferViews[static_cast<std::size_t>(bufferView)].byteStride;
  const std::size_t stride = byteStride == 0 ? elementSize : byteStride;
  // In this order nothing overflows: count * stride may be larger than any integer.
  const bool fits = stride >= elementSize && byteOffset <= bytes.size() && elementSize <= bytes.size() - byteOffset &&
                    count - 1 <= (bytes.size() - byteOffset - elementSize) / stride;
  if (!fits)
    throwInputError("{} elements of {} bytes, {} apart from byte {}, don't fit into the {} bytes of bufferViews/{}",
                    count, elementSize, stride, byteOffset, bytes.size(), bufferView);
  return {bytes.subspan(byteOffset), count, stride, components, componentType};
}

int componentsOf(const tinygltf::Accessor& accessor) {
  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (components < 1 || components > 4 || accessor.type == TINYGLTF_TYPE_MAT2)
    throwInputError("accessors of scalars and vectors are read, got a matrix");
  return components;
}

// Where an accessor's values stand. Without base they are zeros.
struct Source {
  std::optional<Elements> base;
  std::optional<Elements> sparseIndices;
  std::optional<Elements> sparseValues;
};

Source locate(const Document& document, const tinygltf::Accessor& accessor, int components) {
  Source source;
  if (accessor.bufferView >= 0)
    source.base =
        locate(document, accessor.bufferView, accessor.byteOffset, accessor.count, components, accessor.componentType);
  else if (accessor.count > kMaxZeroElements)
    throwInputError("an accessor without bufferView has at most {} elements, got {}", kMaxZeroElements, accessor.count);
  if (!accessor.sparse.isSparse) return source;
  const auto& indices = accessor.sparse.indices;
  const auto& values = accessor.sparse.values;
  const auto count = static_cast<std::size_t>(accessor.sparse.count);
  source.sparseIndices = locate(document, indices.bufferView, static_cast<std::size_t>(indices.byteOffset), count, 1,
                                indices.componentType);
  source.sparseValues = locate(document, values.bufferView, static_cast<std::size_t>(values.byteOffset), count,
                               components, accessor.componentType);
  return source;
}

// Calls assign(element, elements, index in these) for the base values and then for the sparse ones.
template <class Assign>
void visit(const Source& source, std::size_t count, const Assign& assign) {
  if (source.base)
    for (std::size_t i = 0; i < count; ++i) assign(i, *source.base, i);
  if (!source.sparseIndices) return;
  for (std::size_t i = 0; i < source.sparseIndices->count; ++i) {
    const std::uint32_t element = indexAt(*source.sparseIndices, i);
    if (element >= count) throwInputError("sparse index {} is out of range: {} of {} elements", i, element, count);
    assign(element, *source.sparseValues, i);
  }
}

float finiteAt(const Elements& elements, std::size_t i, int component, bool normalized, std::size_t element) {
  const float value = floatAt(elements.at(i, component), elements.componentType, normalized);
  if (!std::isfinite(value)) throwInputError("element {} is not finite", element);
  return value;
}

}  // namespace

FloatAccessor readFloats(const Document& document, int index) {
  const tinygltf::Accessor& accessor = document.model.accessors.at(static_cast<std::size_t>(index));
  return atPlace(fmt::format("accessors/{}", index), [&] {
    const int components = componentsOf(accessor);
    const Source source = locate(document, accessor, components);
    const glm::vec4 zero(0.0f, 0.0f, 0.0f, components < 4 ? 1.0f : 0.0f);
    FloatAccessor result{components, std::vector<glm::vec4>(accessor.count, zero)};
    visit(source, accessor.count, [&](std::size_t element, const Elements& elements, std::size_t i) {
      for (int c = 0; c < components; ++c)
        result.elements[element][c] = finiteAt(elements, i, c, accessor.normalized, element);
    });
    return result;
  });
}

std::vector<glm::mat4> readMatrices(const Document& document, int index) {
  const tinygltf::Accessor& accessor = document.model.accessors.at(static_cast<std::size_t>(index));
  return atPlace(fmt::format("accessors/{}", index), [&] {
    // Columns of smaller components would be padded (glTF 2.0, section 3.6.2.4).
    if (accessor.type != TINYGLTF_TYPE_MAT4 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
      throwInputError("4x4 matrices of floats are wanted");
    const Source source = locate(document, accessor, 16);
    std::vector<glm::mat4> result(accessor.count, glm::mat4(0.0f));
    visit(source, accessor.count, [&](std::size_t element, const Elements& elements, std::size_t i) {
      for (int c = 0; c < 16; ++c) result[element][c / 4][c % 4] = finiteAt(elements, i, c, false, element);
    });
    return result;
  });
}

std::vector<std::uint32_t> readIndices(const Document& document, int index) {
  const tinygltf::Accessor& accessor = document.model.accessors.at(static_cast<std::size_t>(index));
  return atPlace(fmt::format("accessors/{}", index), [&] {
    if (accessor.type != TINYGLTF_TYPE_SCALAR) throwInputError("indices are scalars, got a vector");
    const Source source = locate(document, accessor, 1);
    std::vector<std::uint32_t> result(accessor.count, 0);
    visit(source, accessor.count, [&](std::size_t element, const Elements& elements, std::size_t i) {
      result[element] = indexAt(elements, i);
    });
    return result;
  });
}

}  // namespace pb::gltf
