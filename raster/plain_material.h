// Materials without their textures, as captures may draw them: pure functions.
#pragma once

#include <vector>

#include "raster/programs.h"
#include "scenes/scene.h"

namespace pb {

// The variant without textures, but for those that make holes or are blended: without them the shape is another one.
SurfaceVariant plainVariant(const SurfaceVariant& variant, const Mesh& mesh);

// The constants with the mean texel of each texture that plainVariant() leaves out. Normal and occlusion maps have
// none: surfaces are smooth and nowhere occluded. screens: pictures of Scene::screens.
shading::MaterialConstants plainConstants(const Scene& scene, const std::vector<Texture>& screens,
                                          const Material& material);

}  // namespace pb
