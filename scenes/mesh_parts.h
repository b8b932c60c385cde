// A mesh cut into the pieces that it is made of.
#pragma once

#include <memory>
#include <vector>

#include "scenes/scene.h"

namespace pb {

// The connected parts of a mesh: triangles that share a corner's position belong together. The largest boxes first; at
// most `most` parts (at least 1), the smallest of a mesh with more being joined to the part whose box's centre is
// nearest. Vertices keep their attributes.
std::vector<std::shared_ptr<const Mesh>> connectedParts(const std::shared_ptr<const Mesh>& mesh, std::size_t most);

}  // namespace pb
