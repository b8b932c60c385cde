// glTF animations as tracks of the scene model.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace pb::gltf {

// The tracks of all animations of the file. `sceneNodes` gives each node's index in the scene, -1 for those that are
// not in it: their tracks are left out. Where two animations move the same property of a node, the first counts; that
// and what else is ignored becomes a warning.
std::vector<Track> readTracks(const Document& document, std::span<const int> sceneNodes,
                              std::vector<std::string>& warnings);

}  // namespace pb::gltf
