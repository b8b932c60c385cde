#include "scenes/gltf/json_values.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb::gltf {

using nlohmann::json;

double number(const json& value, const std::string& place, double minimum, double maximum) {
  if (!value.is_number() || value < minimum || value > maximum)
    throwInputError("{} wants a number from {} to {}, got {}", place, minimum, maximum, value.dump());
  return value.get<double>();
}

glm::vec3 vector(const json& value, const std::string& place, double minimum, double maximum) {
  if (!value.is_array() || value.size() != 3)
    throwInputError("{} wants an array of 3 numbers, got {}", place, value.dump());
  return glm::dvec3(number(value[0], place, minimum, maximum), number(value[1], place, minimum, maximum),
                    number(value[2], place, minimum, maximum));
}

glm::vec3 color(const json& value, const std::string& place) {
  return value.is_number() ? glm::vec3(glm::dvec3(number(value, place, 0.0, kLargest))) : vector(value, place, 0.0);
}

glm::vec3 unitVector(const json& value, const std::string& place) {
  const glm::vec3 v = vector(value, place);
  const float length = glm::length(v);
  if (!(length > 0.0f)) throwInputError("{} wants a direction, got {}", place, value.dump());
  // Dividing what is unit already would change its last bits.
  return std::abs(length - 1.0f) < 1e-6f ? v : v / length;
}

const json& member(const json& object, const char* key, const std::string& place) {
  if (!object.is_object()) throwInputError("{} wants an object, got {}", place, object.dump());
  const auto found = object.find(key);
  if (found == object.end()) throwInputError("{} wants a member '{}'", place, key);
  return *found;
}

void warnOfUnknownMembers(const json& object, const std::string& owner, const std::string& place,
                          const std::vector<std::string>& known, std::vector<std::string>& warnings) {
  for (const auto& [key, value] : object.items())
    if (std::ranges::find(known, key) == known.end())
      warnings.push_back(fmt::format("{}a member of {} is ignored: {}", owner, place, unknownMessage(key, known)));
}

json toJson(const glm::vec3& v) { return {v.x, v.y, v.z}; }
json toJson(const glm::vec4& v) { return toJson(glm::vec3(v)); }

}  // namespace pb::gltf
