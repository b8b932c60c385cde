// What a program stands on, as far as it takes part in numbers: GL driver and libraries.
#pragma once

#include <string>
#include <vector>

#include "bench/results.h"

namespace pb {

struct PlatformDifference {
  std::string what, before, after;  // "GL renderer", "Embree", ...
};

// Empty where both were made with the same. A library that one of the two doesn't name is not compared: programs learn
// to name more.
std::vector<PlatformDifference> platformDifferences(const Provenance& before, const Provenance& after);

// Whether counters and costs of the two are comparable at all: same GL renderer and version.
bool sameDriver(const Provenance& a, const Provenance& b);

// "Embree is 4.3.0, was 3.13.5; ...".
std::string describe(const std::vector<PlatformDifference>& differences);

}  // namespace pb
