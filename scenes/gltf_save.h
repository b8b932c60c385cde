// Scenes as binary glTF 2.0 files (.glb).
#pragma once

#include <string>

#include "scenes/scene.h"

namespace pb {

// Writes all of the scene: geometry bit by bit; textures as PNG with 8 bits a channel where that loses nothing, else
// 16; the environment, the ambient light, probes and frame rate in extras (results/schema/scene-extras.schema.json).
// loadGltf() of the file gives the scene again, with the instances sorted by node. The file is complete or absent;
// throws an environment Error where it can't be written.
void saveGlb(const Scene& scene, const std::string& path);

}  // namespace pb
