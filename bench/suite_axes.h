// Axes and their values as suites give them: the base technique, the grid, and what a scene varies.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/toml_reader.h"
#include "raster/technique.h"

namespace pb {

using GridAxis = std::pair<std::string, std::vector<std::string>>;  // axis and its values, canonical

// Each of the values for itself, on top of each of the grid's techniques with `on` set.
struct Variation {
  std::vector<std::pair<std::string, std::string>> on;  // axes and their values, canonical
  std::vector<GridAxis> values;

  friend bool operator==(const Variation&, const Variation&) = default;
};

// All throw input Errors with file and line. Axes are in the order of the axis table. "*" in a list of values, or in
// its place, stands for every name of the axis that doesn't stand before it.
Technique readTechnique(TomlReader& suite);
std::vector<GridAxis> readAxes(TomlReader& owner, std::string_view key);

// `vary` of a scene: a table of axes, or an array of such tables, each with `on = {...}` if it wants other values
// below.
std::vector<Variation> readVariations(TomlReader& scene);

// The axes that have several values then, in the order of the axis table.
std::vector<std::string> variedAxes(const std::vector<Variation>& variations);

// What is varied in the scene of that name, one axis a line.
std::string canonicalText(const std::string& scene, const Variation& variation);

}  // namespace pb
