#include "scenes/gltf/validate.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/error.h"
#include "scenes/scene.h"

namespace pb::gltf {
namespace {

using nlohmann::json;

constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846;
// The sun has 2e7 W/(sr m^2); products of two such numbers still fit into float.
constexpr double kLargestRadiance = 1e9;
constexpr auto kLargestNumber = static_cast<double>(kLargestTransform);

constexpr std::size_t kAnyLength = std::numeric_limits<std::size_t>::max();

enum class Type { index, indices, size, number, numbers, text, boolean, object, array };

// What a member must be. `place` is a path in which '*' stands for every element of an array or object; `key` '*' for
// every member. Indices point into the array at the path `target`; one that starts with '^' is relative to the object
// two levels above (an animation's samplers).
struct Rule {
  const char* place;
  const char* key;
  Type type;
  bool required = false;
  const char* target = "";
  double minimum = -kAny;
  double maximum = kAny;
  std::size_t length = 0;  // of number arrays
};

constexpr Rule indexRule(const char* place, const char* key, const char* target, bool required = false) {
  return {.place = place, .key = key, .type = Type::index, .required = required, .target = target};
}
constexpr Rule indicesRule(const char* place, const char* key, const char* target) {
  return {.place = place, .key = key, .type = Type::indices, .target = target};
}
constexpr Rule sizeRule(const char* place, const char* key, bool required = false, double minimum = 0) {
  return {.place = place, .key = key, .type = Type::size, .required = required, .minimum = minimum};
}
constexpr Rule numberRule(const char* place, const char* key, double minimum = -kAny, double maximum = kAny) {
  return {.place = place, .key = key, .type = Type::number, .minimum = minimum, .maximum = maximum};
}
constexpr Rule numbersRule(const char* place, const char* key, std::size_t length, double minimum = -kAny,
                           double maximum = kAny) {
  return {.place = place, .key = key, .type = Type::numbers, .minimum = minimum, .maximum = maximum, .length = length};
}
constexpr Rule required(Rule rule) {
  rule.required = true;
  return rule;
}
constexpr Rule typeRule(const char* place, const char* key, Type type) {
  return {.place = place, .key = key, .type = type};
}

constexpr const char* kLights = "extensions/KHR_lights_punctual/lights";
constexpr const char* kLight = "extensions/KHR_lights_punctual/lights/*";
constexpr const char* kPrimitive = "meshes/*/primitives/*";
constexpr const char* kDraco = "meshes/*/primitives/*/extensions/KHR_draco_mesh_compression";
constexpr const char* kPbr = "materials/*/pbrMetallicRoughness";

// glTF 2.0, section 5, as far as the loader reads it. Offsets and lengths are compared with the data where it is read.
constexpr std::array kRules = {
    sizeRule("buffers/*", "byteLength", true, 1),
    typeRule("buffers/*", "uri", Type::text),
    indexRule("bufferViews/*", "buffer", "buffers", true),
    sizeRule("bufferViews/*", "byteOffset"),
    sizeRule("bufferViews/*", "byteLength", true, 1),
    sizeRule("bufferViews/*", "byteStride"),
    indexRule("accessors/*", "bufferView", "bufferViews"),
    sizeRule("accessors/*", "byteOffset"),
    sizeRule("accessors/*", "count", true, 1),
    sizeRule("accessors/*", "componentType", true),
    required(typeRule("accessors/*", "type", Type::text)),
    typeRule("accessors/*", "normalized", Type::boolean),
    sizeRule("accessors/*/sparse", "count", true, 1),
    required(typeRule("accessors/*/sparse", "indices", Type::object)),
    required(typeRule("accessors/*/sparse", "values", Type::object)),
    indexRule("accessors/*/sparse/indices", "bufferView", "bufferViews", true),
    sizeRule("accessors/*/sparse/indices", "byteOffset"),
    sizeRule("accessors/*/sparse/indices", "componentType", true),
    indexRule("accessors/*/sparse/values", "bufferView", "bufferViews", true),
    sizeRule("accessors/*/sparse/values", "byteOffset"),
    required(typeRule(kPrimitive, "attributes", Type::object)),
    indexRule("meshes/*/primitives/*/attributes", "*", "accessors"),
    typeRule(kPrimitive, "targets", Type::array),
    indexRule("meshes/*/primitives/*/targets/*", "*", "accessors"),
    numbersRule("meshes/*", "weights", kAnyLength),
    numbersRule("nodes/*", "weights", kAnyLength),
    required(indicesRule("skins/*", "joints", "nodes")),
    indexRule("skins/*", "inverseBindMatrices", "accessors"),
    indexRule("skins/*", "skeleton", "nodes"),
    typeRule("skins/*", "name", Type::text),
    indexRule(kPrimitive, "indices", "accessors"),
    indexRule(kPrimitive, "material", "materials"),
    sizeRule(kPrimitive, "mode"),
    indexRule(kDraco, "bufferView", "bufferViews", true),
    required(typeRule(kDraco, "attributes", Type::object)),
    sizeRule("meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes", "*"),
    typeRule("nodes/*", "name", Type::text),
    indicesRule("nodes/*", "children", "nodes"),
    indexRule("nodes/*", "mesh", "meshes"),
    indexRule("nodes/*", "camera", "cameras"),
    indexRule("nodes/*", "skin", "skins"),
    numbersRule("nodes/*", "matrix", 16, -kLargestNumber, kLargestNumber),
    numbersRule("nodes/*", "translation", 3, -kLargestNumber, kLargestNumber),
    numbersRule("nodes/*", "rotation", 4),
    numbersRule("nodes/*", "scale", 3, -kLargestNumber, kLargestNumber),
    indexRule("nodes/*/extensions/KHR_lights_punctual", "light", kLights, true),
    indicesRule("scenes/*", "nodes", "nodes"),
    indexRule("", "scene", "scenes"),
    typeRule("materials/*", "name", Type::text),
    typeRule("materials/*", "alphaMode", Type::text),
    numberRule("materials/*", "alphaCutoff", 0),
    typeRule("materials/*", "doubleSided", Type::boolean),
    numbersRule("materials/*", "emissiveFactor", 3, 0, kLargestRadiance),
    numbersRule(kPbr, "baseColorFactor", 4, 0),
    numberRule(kPbr, "metallicFactor", 0, 1),
    numberRule(kPbr, "roughnessFactor", 0, 1),
    indexRule("materials/*/pbrMetallicRoughness/baseColorTexture", "index", "textures", true),
    sizeRule("materials/*/pbrMetallicRoughness/baseColorTexture", "texCoord"),
    indexRule("materials/*/pbrMetallicRoughness/metallicRoughnessTexture", "index", "textures", true),
    sizeRule("materials/*/pbrMetallicRoughness/metallicRoughnessTexture", "texCoord"),
    indexRule("materials/*/normalTexture", "index", "textures", true),
    sizeRule("materials/*/normalTexture", "texCoord"),
    numberRule("materials/*/normalTexture", "scale"),
    indexRule("materials/*/occlusionTexture", "index", "textures", true),
    sizeRule("materials/*/occlusionTexture", "texCoord"),
    numberRule("materials/*/occlusionTexture", "strength", 0, 1),
    indexRule("materials/*/emissiveTexture", "index", "textures", true),
    sizeRule("materials/*/emissiveTexture", "texCoord"),
    numberRule("materials/*/extensions/KHR_materials_emissive_strength", "emissiveStrength", 0, kLargestRadiance),
    numberRule("materials/*/extensions/KHR_materials_ior", "ior", 0),
    numberRule("materials/*/extensions/KHR_materials_specular", "specularFactor", 0, 1),
    numbersRule("materials/*/extensions/KHR_materials_specular", "specularColorFactor", 3, 0),
    numberRule("materials/*/extensions/KHR_materials_transmission", "transmissionFactor", 0, 1),
    numberRule("materials/*/extensions/KHR_materials_volume", "thicknessFactor", 0),
    numberRule("materials/*/extensions/KHR_materials_volume", "attenuationDistance", 0),
    numbersRule("materials/*/extensions/KHR_materials_volume", "attenuationColor", 3, 0, 1),
    numberRule("materials/*/extensions/KHR_materials_dispersion", "dispersion", 0),
    indexRule("textures/*", "source", "images"),
    indexRule("textures/*", "sampler", "samplers"),
    typeRule("images/*", "uri", Type::text),
    indexRule("images/*", "bufferView", "bufferViews"),
    sizeRule("samplers/*", "magFilter"),
    sizeRule("samplers/*", "minFilter"),
    sizeRule("samplers/*", "wrapS"),
    sizeRule("samplers/*", "wrapT"),
    required(typeRule("cameras/*", "type", Type::text)),
    required(numberRule("cameras/*/perspective", "yfov", 1e-3, 0.999 * kPi)),
    required(numberRule("cameras/*/perspective", "znear", 1e-9)),
    required(typeRule("animations/*/channels/*", "target", Type::object)),
    indexRule("animations/*/channels/*", "sampler", "^samplers", true),
    indexRule("animations/*/channels/*/target", "node", "nodes"),
    required(typeRule("animations/*/channels/*/target", "path", Type::text)),
    indexRule("animations/*/samplers/*", "input", "accessors", true),
    indexRule("animations/*/samplers/*", "output", "accessors", true),
    typeRule("animations/*/samplers/*", "interpolation", Type::text),
    required(typeRule(kLight, "type", Type::text)),
    numbersRule(kLight, "color", 3, 0, kLargestRadiance),
    numberRule(kLight, "intensity", 0, kLargestRadiance),
    numberRule(kLight, "range", 0),
    numberRule("extensions/KHR_lights_punctual/lights/*/spot", "innerConeAngle", 0, 0.5 * kPi),
    numberRule("extensions/KHR_lights_punctual/lights/*/spot", "outerConeAngle", 0, 0.5 * kPi),
};

// Shown in messages; long values are cut.
std::string shown(const json& value) {
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  constexpr std::size_t kLongest = 40;
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "..";
}

// A position in the document with its path for messages. parents holds the objects and arrays on the way.
struct Cursor {
  const json* value;
  std::string path;
  std::vector<const json*> parents;

  Cursor child(const json& next, const std::string& key) const {
    Cursor result{&next, path.empty() ? key : path + "/" + key, parents};
    result.parents.push_back(value);
    return result;
  }
};

template <class Visitor>
void forEachChild(const Cursor& cursor, const Visitor& visit) {
  if (cursor.value->is_array())
    for (std::size_t i = 0; i < cursor.value->size(); ++i) visit(cursor.child((*cursor.value)[i], std::to_string(i)));
  else
    for (const auto& [key, value] : cursor.value->items()) visit(cursor.child(value, key));
}

// Calls visit for every object at the path; members on the way that are absent are skipped.
template <class Visitor>
void forEachAt(const Cursor& cursor, std::string_view path, const Visitor& visit) {
  const bool wantsArray = path.starts_with('*');
  if (wantsArray ? !cursor.value->is_array() : !cursor.value->is_object())
    throwInputError("{} wants an {}, got {}", cursor.path, wantsArray ? "array" : "object", shown(*cursor.value));
  if (path.empty()) return visit(cursor);
  const std::size_t slash = std::min(path.find('/'), path.size());
  const std::string key(path.substr(0, slash));
  const std::string_view rest = path.substr(std::min(slash + 1, path.size()));
  if (wantsArray) {
    forEachChild(cursor, [&](const Cursor& child) { forEachAt(child, rest, visit); });
  } else if (const auto found = cursor.value->find(key); found != cursor.value->end()) {
    forEachAt(cursor.child(*found, key), rest, visit);
  }
}

std::size_t sizeOfTarget(const Cursor& owner, const json& document, std::string_view target) {
  if (target.starts_with('^')) {
    // owner is animations/N/channels/M: its parents end with the animation and its channels.
    const json& animation = *owner.parents[owner.parents.size() - 2];
    return animation.value(std::string(target.substr(1)), json::array()).size();
  }
  const json::json_pointer pointer(fmt::format("/{}", target));
  return document.contains(pointer) && document[pointer].is_array() ? document[pointer].size() : 0;
}

void checkIndex(const Cursor& at, const Rule& rule, std::size_t size) {
  const std::string target = rule.target[0] == '^' ? rule.target + 1 : rule.target;
  if (!at.value->is_number_integer())
    throwInputError("{} wants an index into {}, got {}", at.path, target, shown(*at.value));
  if (*at.value < 0 || *at.value >= size)
    throwInputError("{} is out of range: index {} of {} {}", at.path, shown(*at.value), size, target);
}

void checkNumber(const Cursor& at, const Rule& rule) {
  if (!at.value->is_number()) throwInputError("{} wants a number, got {}", at.path, shown(*at.value));
  const double number = at.value->get<double>();
  // Whatever float can't hold would be infinite in the scene.
  const double largest = std::min(rule.maximum, static_cast<double>(std::numeric_limits<float>::max()));
  if (number < std::max(rule.minimum, -largest) || number > largest)
    throwInputError("{} wants a number from {} to {}, got {}", at.path, std::max(rule.minimum, -largest), largest,
                    number);
}

void checkSize(const Cursor& at, const Rule& rule) {
  constexpr double kLargest = 1e12;
  const bool fits =
      at.value->is_number_integer() && at.value->get<double>() >= rule.minimum && at.value->get<double>() <= kLargest;
  if (!fits)
    throwInputError("{} wants an integer from {} to {}, got {}", at.path, rule.minimum, kLargest, shown(*at.value));
}

void checkValue(const Cursor& owner, const Cursor& at, const Rule& rule, const json& document) {
  const json& value = *at.value;
  switch (rule.type) {
    case Type::index:
      return checkIndex(at, rule, sizeOfTarget(owner, document, rule.target));
    case Type::indices:
      if (!value.is_array()) throwInputError("{} wants an array of indices, got {}", at.path, shown(value));
      return forEachChild(
          at, [&](const Cursor& element) { checkIndex(element, rule, sizeOfTarget(owner, document, rule.target)); });
    case Type::size:
      return checkSize(at, rule);
    case Type::number:
      return checkNumber(at, rule);
    case Type::numbers:
      if (!value.is_array() && rule.length == kAnyLength)
        throwInputError("{} wants an array of numbers, got {}", at.path, shown(value));
      if (!value.is_array() || (rule.length != kAnyLength && value.size() != rule.length))
        throwInputError("{} wants an array of {} numbers, got {}", at.path, rule.length, shown(value));
      return forEachChild(at, [&](const Cursor& element) { checkNumber(element, rule); });
    case Type::text:
      if (!value.is_string()) throwInputError("{} wants a string, got {}", at.path, shown(value));
      return;
    case Type::boolean:
      if (!value.is_boolean()) throwInputError("{} wants true or false, got {}", at.path, shown(value));
      return;
    case Type::array:
      if (!value.is_array()) throwInputError("{} wants an array, got {}", at.path, shown(value));
      return;
    case Type::object:
      if (!value.is_object()) throwInputError("{} wants an object, got {}", at.path, shown(value));
      return;
  }
}

void checkRule(const Cursor& root, const Rule& rule) {
  forEachAt(root, rule.place, [&](const Cursor& owner) {
    if (rule.key == std::string_view("*"))
      return forEachChild(owner, [&](const Cursor& member) { checkValue(owner, member, rule, *root.value); });
    const auto found = owner.value->find(rule.key);
    if (found != owner.value->end()) return checkValue(owner, owner.child(*found, rule.key), rule, *root.value);
    if (rule.required) throwInputError("{} wants a member '{}'", owner.path, rule.key);
  });
}

const json& arrayAt(const json& document, const char* key) {
  static const json kNone = json::array();
  const auto found = document.find(key);
  return found != document.end() ? *found : kNone;
}

std::vector<int> parentsOfNodes(const json& nodes) {
  std::vector<int> parents(nodes.size(), -1);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    for (const json& child : arrayAt(nodes[n], "children")) {
      int& parent = parents[child.get<std::size_t>()];
      if (parent >= 0)
        throwInputError("nodes form trees, nodes/{} is a child of nodes/{} and of nodes/{}", child.get<int>(), parent,
                        n);
      parent = static_cast<int>(n);
    }
  return parents;
}

// With one parent each, nodes form trees exactly if all of them can be reached from the roots.
void checkNodeTrees(const json& document) {
  const json& nodes = arrayAt(document, "nodes");
  const std::vector<int> parents = parentsOfNodes(nodes);
  std::vector<std::size_t> pending;
  for (std::size_t n = 0; n < parents.size(); ++n)
    if (parents[n] < 0) pending.push_back(n);
  std::vector<bool> reached(nodes.size(), false);
  while (!pending.empty()) {
    const std::size_t n = pending.back();
    pending.pop_back();
    reached[n] = true;
    for (const json& child : arrayAt(nodes[n], "children")) pending.push_back(child.get<std::size_t>());
  }
  const auto unreached = std::ranges::find(reached, false);
  if (unreached != reached.end())
    throwInputError("nodes form trees, nodes/{} is its own ancestor", unreached - reached.begin());
}

}  // namespace

void validate(const json& document) {
  const Cursor root{&document, "", {}};
  for (const Rule& rule : kRules) checkRule(root, rule);
  checkNodeTrees(document);
}

bool isSupportedExtension(const std::string& name) {
  static constexpr std::array<std::string_view, 11> kSupported = {
      "KHR_draco_mesh_compression",      "KHR_lights_punctual",  "KHR_materials_dispersion",
      "KHR_materials_emissive_strength", "KHR_materials_ior",    "KHR_materials_specular",
      "KHR_materials_transmission",      "KHR_materials_unlit",  "KHR_materials_volume",
      "KHR_mesh_quantization",           "KHR_texture_transform"};
  return std::ranges::find(kSupported, name) != kSupported.end();
}

void checkRequirements(const json& document) {
  if (!document.is_object()) throwInputError("a glTF file is a JSON object, got {}", shown(document));
  const json::json_pointer version("/asset/version");
  if (!document.contains(version) || !document[version].is_string())
    throwInputError("a glTF file wants a string asset/version");
  if (!document[version].get<std::string>().starts_with("2."))
    throwInputError("glTF 2.0 is read, the file's version is {}", shown(document[version]));
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    const json& names = arrayAt(document, key);
    if (!names.is_array() || !std::ranges::all_of(names, [](const json& name) { return name.is_string(); }))
      throwInputError("{} wants an array of strings, got {}", key, shown(names));
  }
  for (const json& name : arrayAt(document, "extensionsRequired"))
    if (!isSupportedExtension(name.get<std::string>()))
      throwInputError("the file requires the extension {}, which is not supported", shown(name));
}

}  // namespace pb::gltf
