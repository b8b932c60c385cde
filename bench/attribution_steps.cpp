#include "bench/attribution_steps.h"

#include <algorithm>

#include "bench/oracle.h"

namespace pb {
namespace {

// After as many bounces the reference, too, takes no care to follow all paths.
constexpr int kMostIterations = 16;

// Maps are stored and filtered as well as the raster can.
Technique withBestMaps(Technique technique) {
  const Technique best;
  technique.format = best.format;
  technique.storage = best.storage;
  technique.filter = ProbeFilter::ggxPrefiltered;
  technique.mips = false;
  technique.seamless = true;
  return technique;
}

Technique withMapsAsStored(Technique technique, const Technique& stored) {
  technique.format = stored.format;
  technique.storage = stored.storage;
  technique.filter = stored.filter;
  technique.mips = stored.mips;
  technique.seamless = stored.seamless;
  return technique;
}

// All that is captured is of this very moment.
Technique withFreshCaptures(Technique technique) {
  technique.refresh = Spec{"every-frame", {}};
  technique.hysteresis = 0.0f;
  return technique;
}

// Frames that bring fresh maps as many bounces as the technique's have had the time for.
int freshRenders(const Technique& technique, int framesRendered) {
  if (technique.feedback == Feedback::sky) return 1;
  const int enough = (kMostIterations + technique.bounces - 1) / technique.bounces;
  return std::clamp(framesRendered, 1, enough);
}

}  // namespace

std::vector<RasterStep> rasterSteps(const Technique& technique, int framesRendered, int tracedResolution) {
  const Technique traced = withGivenMaps(withBestMaps(technique));
  Technique perfect = traced;
  perfect.resolution = std::max(tracedResolution, technique.resolution);
  perfect.resolutionScale = ResolutionScale::fixed;
  const Technique fresh = withFreshCaptures(technique);
  const int renders = freshRenders(technique, framesRendered);
  return {{.step = "lookup", .technique = perfect, .isTraced = true},
          {.step = "resolution", .technique = traced, .isTraced = true},
          {.step = "capture", .technique = withBestMaps(fresh), .renders = renders},
          {.step = "filtered/format", .technique = withMapsAsStored(fresh, technique), .renders = renders}};
}

}  // namespace pb
