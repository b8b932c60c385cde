// [attribution] of a suite: of which cells it is wanted to know where their error comes from.
#pragma once

#include <optional>
#include <string>

#include "bench/toml_reader.h"

namespace pb {

struct AttributionSettings {
  // Regular expression (ECMAScript) searched in the cells' keys. None: of each scene the technique that differs from
  // the suite's base technique in the fewest axes.
  std::optional<std::string> cells;
  bool everyFrame = false;  // otherwise the last measured frame of a sequence
  int resolution = 1024;    // of the traced maps that stand for perfect ones, at least the technique's own
  std::optional<int> spp;   // samples per texel of traced maps; none: as the reference begins with, at least 16
};

// nullopt without the table. Throws input Errors.
std::optional<AttributionSettings> readAttribution(TomlReader& suite);

// One setting a line, for Suite's canonicalText(); empty without settings.
std::string canonicalText(const std::optional<AttributionSettings>& settings);

}  // namespace pb
