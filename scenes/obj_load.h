// Wavefront .obj files as scenes, with their .mtl libraries, through tinyobjloader (scenes/obj, and nowhere else).
#pragma once

#include <optional>
#include <string>

#include "scenes/scene.h"

namespace pb {

// Every object or group (whichever was named last) becomes a node, its faces of one material an instance. Without
// normals faces are flat. Throws an input Error naming the file for anything damaged or missing; what is merely ignored
// becomes a warning of the scene. Without `environment` the scene gets the procedural sky.
Scene loadObj(const std::string& path, const std::optional<Environment>& environment = {});

}  // namespace pb
