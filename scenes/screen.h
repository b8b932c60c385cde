// Pictures of a scene's emissive screens at one time: made once a snapshot, so that both renderers read the same
// texels.
#pragma once

#include "scenes/scene.h"

namespace pb {

// Linear radiance with all mip levels; the same bits for any number of threads.
Texture renderScreen(const Screen& screen, double timeSeconds);

// The material shows Scene::screens[screen] as its emission, `scale` times as bright as its program says, over texture
// coordinates [0,1]^2 of set 0.
void showScreen(Material& material, int screen, glm::vec3 scale = glm::vec3(1.0f));

}  // namespace pb
