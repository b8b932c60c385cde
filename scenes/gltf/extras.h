// What glTF can't say: sky, ambient light, probes, frame rate. Written to and read from scenes[].extras.probebench
// (schema: results/schema/scene-extras.schema.json); also read are nodes[].extras.probe and the extras of the three.js
// cube-camera benchmark: ambientRadiance, sky, skyRadiance, cubeCamera.near.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace pb::gltf {

// Sets what the extras of a glTF scene say; returns whether that included an environment.
bool readSceneExtras(const Document& document, const nlohmann::json& extras, Scene& scene);

// nodes[].extras.probe: true, false or {"enabled": ..., "position": [x, y, z]}. Warnings about other members name the
// node.
std::optional<ProbeSettings> readProbeExtras(const nlohmann::json& extras, const std::string& node,
                                             std::vector<std::string>& warnings);

// Adds bytes to the file and returns their buffer view.
using AddBufferView = std::function<int(std::string_view bytes)>;

nlohmann::json sceneExtras(const Scene& scene, const AddBufferView& addBufferView);
nlohmann::json probeExtras(const ProbeSettings& probe);

}  // namespace pb::gltf
