// Lookups: how a shaded point turns a reflected or refracted direction into a texel of a probe's map.
//
// Adding one: a file in raster/lookup/ with a Lookup, a line in the table of lookup.cpp, and its GLSL in
// raster/shaders/.
#pragma once

#include <string>
#include <vector>

#include "scenes/spec.h"

namespace pb {

struct Lookup {
  std::string name;
  std::string parameters;   // for `axes info`: "steps = ..., 1 to 32, default 8"; "" for none
  std::string description;  // one sentence
  std::string source;       // paper, or who does it like that
  // Validates the parameters and gives the defines of the shader variant (radiance_lookup.glsl); throws an input Error.
  std::string (*defines)(const Spec&);
};

const std::vector<Lookup>& lookups();

// Throws an input Error for an unknown lookup or parameter.
const Lookup& lookupOf(const Spec& spec);
void checkLookup(const Spec& spec);

}  // namespace pb
