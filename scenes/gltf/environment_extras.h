// Skies and ambient light as glTF's extras state them.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace pb::gltf {

// Adds bytes to the file and returns their buffer view.
using AddBufferView = std::function<int(std::string_view bytes)>;

// A gradient whose channels are bounded by `limit` (0: unbounded).
shading::Sky readSky(const nlohmann::json& sky, const std::string& place, float limit);

Environment readEnvironment(const Document& document, const nlohmann::json& value, const std::string& place,
                            std::vector<std::string>& warnings);

// Whether times increase is for finishScene() to check.
std::vector<EnvironmentChange> readEnvironmentChanges(const Document& document, const nlohmann::json& values,
                                                      const std::string& place, std::vector<std::string>& warnings);

nlohmann::json toJson(const Environment& source, const AddBufferView& addBufferView);

}  // namespace pb::gltf
