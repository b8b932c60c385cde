// glTF skins as those of the scene model.
#pragma once

#include <span>
#include <vector>

#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace pb::gltf {

// All skins that nodes of the scene use, in the order of these nodes, and at the nodes their index. `sceneNodes` gives
// each node's index in the scene, -1 for those that are not in it. Throws an input Error naming the skin for joints
// outside of the scene and for matrices that are too few or not affine.
void readSkins(const Document& document, std::span<const int> sceneNodes, Scene& scene);

}  // namespace pb::gltf
