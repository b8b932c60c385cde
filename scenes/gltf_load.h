// glTF 2.0 files as scenes: .gltf and .glb, with embedded data or external files.
#pragma once

#include <optional>
#include <string>

#include "scenes/scene.h"

namespace pb {

// Nodes keep the file's order except that parents come before their children; those outside of the file's scene are
// left out. Animations are merged. Throws an input Error naming the file for anything damaged or required but not
// supported; what is merely ignored becomes a warning of the scene. `environment` takes the place of what the file
// says. If both say nothing, lights shine before a black environment, and a scene without lights gets the procedural
// sky.
Scene loadGltf(const std::string& path, const std::optional<Environment>& environment = {});

}  // namespace pb
