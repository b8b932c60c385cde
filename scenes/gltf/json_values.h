// Checked values of JSON. What is not as wanted is an input Error that begins with the place where it stands.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pb::gltf {

// Of what has no other limit.
inline constexpr double kLargest = 1e9;

double number(const nlohmann::json& value, const std::string& place, double minimum, double maximum);
glm::vec3 vector(const nlohmann::json& value, const std::string& place, double minimum = -kLargest,
                 double maximum = kLargest);
// Grey may be written as one number.
glm::vec3 color(const nlohmann::json& value, const std::string& place);
glm::vec3 unitVector(const nlohmann::json& value, const std::string& place);
const nlohmann::json& member(const nlohmann::json& object, const char* key, const std::string& place);

// `owner` is "" or names a node or material, with a colon and a space behind it.
void warnOfUnknownMembers(const nlohmann::json& object, const std::string& owner, const std::string& place,
                          const std::vector<std::string>& known, std::vector<std::string>& warnings);

nlohmann::json toJson(const glm::vec3& v);
// Without w.
nlohmann::json toJson(const glm::vec4& v);

}  // namespace pb::gltf
