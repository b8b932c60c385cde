// What a technique's refraction asks of the draws of transmitting surfaces: pure functions.
#pragma once

#include <string>

#include "raster/technique.h"
#include "scenes/scene.h"

namespace pb {

// Glass that fills its mesh, as opposed to thin walls, through which light goes straight whatever the technique.
bool isSolidGlass(const Material& material);

// Whether fragments read the object's back faces, which are drawn before it (raster/back_faces.h).
bool readsBackFaces(const Technique& technique, const Material& material);

// Whether the object's back faces stand in the captures of its own probe.
bool isCapturedFromInside(const Technique& technique, const Material& material);

// Of the shaders that draw the material (raster/shaders/refraction.glsl); empty for what doesn't transmit.
std::string refractionDefines(const Technique& technique, const Material& material);

}  // namespace pb
