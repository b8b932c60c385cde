// What a scene holds, as text for people: `probebench scenes info`.
#pragma once

#include <string>

#include "scenes/scene.h"

namespace pb {

// Counts, duration, bounds, cameras, which instances get a probe and why, the environment, notes and warnings; one fact
// a line.
std::string describe(const Scene& scene);

}  // namespace pb
