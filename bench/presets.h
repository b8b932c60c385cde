// Whole techniques by name: what programs and documents do, as values of the axes.
//
// Adding one: a line in the table of presets.cpp.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "raster/technique.h"

namespace pb {

struct Preset {
  std::string name;
  std::vector<std::pair<std::string, std::string>> settings;  // axis and value; all other axes stand at their default
  std::string description;                                    // one sentence
  std::string source;
};

const std::vector<Preset>& presets();

// The technique of that name, nullptr if there is none. Technique::preset is set.
const Technique* presetTechnique(std::string_view name);

}  // namespace pb
