// glTF materials and textures as those of the scene model.
#pragma once

#include <string>
#include <vector>

#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace pb::gltf {

// Appends all materials of the document, in its order, and then glTF's default material if a primitive has none; and
// the textures that they use, decoded to linear. Warnings name what is read but not drawn.
void readMaterials(const Document& document, Scene& scene);

// Index in scene.materials of a primitive's material.
int materialIndex(const Document& document, const tinygltf::Primitive& primitive);

}  // namespace pb::gltf
