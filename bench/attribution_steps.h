// The chain of an attribution: which techniques render its images. Pure; why they are these: docs/attribution.md.
#pragma once

#include <string>
#include <vector>

#include "bench/suite_attribution.h"
#include "raster/technique.h"

namespace pb {

struct RasterStep {
  std::string step;       // a name of attributionSteps()
  Technique technique;    // ProbeUse::given for traced maps
  bool isTraced = false;  // its maps are traced, else captured afresh
};

// The images between the truncated truth and the technique as it is run, in order. `tracedResolution`: of the maps that
// stand for perfect ones, texels along the edge of a face.
std::vector<RasterStep> rasterSteps(const Technique& technique, int tracedResolution);

// Samples of a texel of traced maps.
int texelSpp(const AttributionSettings& settings, int referenceSpp);

}  // namespace pb
