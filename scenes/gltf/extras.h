// What glTF can't say. Written to and read from scenes[].extras.probebench (skies, ambient light, screens, shadows,
// near plane of probes, room, frame rate), materials[].extras.probebench (a metal's index of refraction, the screen
// that it shows) and nodes[].extras.probe; their JSON Schema is results/schema/scene-extras.schema.json. Also read are
// the extras of two other benchmarks' scenes: ambientRadiance, sky, skyRadiance, diffuse, cubeCamera.near.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenes/gltf/document.h"
#include "scenes/gltf/environment_extras.h"
#include "scenes/scene.h"

namespace pb::gltf {

// Sets what the extras of a glTF scene say; returns whether that included an environment. extras.probebench has the
// last word. Wants the scene's materials, whose screens are checked.
bool readSceneExtras(const Document& document, const nlohmann::json& extras, Scene& scene);

// nodes[].extras.probe: true, false or {"enabled": ..., "position": [x, y, z], "box": {"lower": ..., "upper": ...}}.
// Warnings about other members name the node.
std::optional<ProbeSettings> readProbeExtras(const nlohmann::json& extras, const std::string& node,
                                             std::vector<std::string>& warnings);

// nodes[].extras.probebench: {"wave": {...}}, a deformation that glTF has not. Warnings name the node.
std::optional<Wave> readWaveExtras(const nlohmann::json& extras, const std::string& node,
                                   std::vector<std::string>& warnings);

// materials[].extras.probebench. Warnings start with `owner`, the material.
void readMaterialExtras(const nlohmann::json& extras, const std::string& owner, Material& material,
                        std::vector<std::string>& warnings);

nlohmann::json sceneExtras(const Scene& scene, const AddBufferView& addBufferView);
// null where there is nothing to say.
nlohmann::json nodeExtras(const Node& node);
nlohmann::json materialExtras(const Material& material);

}  // namespace pb::gltf
