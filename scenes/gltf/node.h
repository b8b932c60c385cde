// glTF nodes and the cameras and lights at them as those of the scene model. Errors name the node.
#pragma once

#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace pb::gltf {

// "node 'name'" or "node 3".
std::string placeOfNode(const Document& document, std::size_t node);

// The node's name, transform and probe; its parent is left to the caller.
Node readNode(const Document& document, std::size_t node, std::vector<std::string>& warnings);

// What stands at a node; `sceneNode` is the node's index in the scene. nullopt, with a warning, for orthographic
// cameras.
std::optional<Camera> readCamera(const Document& document, std::size_t node, int sceneNode,
                                 std::vector<std::string>& warnings);
std::optional<PunctualLight> readLight(const Document& document, std::size_t node, int sceneNode);

// A rotation as xyzw made to length 1, as it is if it is that already. Throws an input Error for one without direction.
glm::vec4 unitQuaternion(glm::vec4 xyzw);

}  // namespace pb::gltf
