// The chain of an attribution: which techniques render its images. Pure; why they are these: docs/attribution.md.
#pragma once

#include <string>
#include <vector>

#include "raster/technique.h"

namespace pb {

struct RasterStep {
  std::string step;       // a name of attributionSteps()
  Technique technique;    // ProbeUse::given for traced maps
  bool isTraced = false;  // its maps are traced, at the technique's resolution
  int renders = 1;        // of captured maps: how often the frame is rendered, standing still
};

// The images between the truncated truth and the technique as it is run, in order. framesRendered counts those of the
// sequence up to the cell's own, which is what previous-frame feedback has had to bring bounces along.
// tracedResolution: of the maps that stand for perfect ones.
std::vector<RasterStep> rasterSteps(const Technique& technique, int framesRendered, int tracedResolution);

}  // namespace pb
