// Where an image's error lies, by object.
#pragma once

#include <optional>
#include <string>

#include "bench/region_errors.h"

namespace pb {

// Errors of the pixels in which either renderer shows an object.
struct ObjectError : RegionErrors {
  std::string object;                     // its name; "environment" where neither renderer shows one
  std::string material;                   // its name, empty for the environment
  std::optional<int> probe;               // that it looks up, an index into the technique's probes
  std::optional<double> probeDistance{};  // metres from the seen surface to the probe, mean over the pixels
  double roughness = 0;                   // the material's factor

  friend bool operator==(const ObjectError&, const ObjectError&) = default;
};

}  // namespace pb
