#include "bench/attribution_steps.h"

#include <algorithm>

#include "bench/oracle.h"

namespace pb {
namespace {

// Texels are seen magnified, their noise too, where a map has few of them.
constexpr int kTexelSpp = 16;

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

// All that is captured is of this very moment. In a world that stands still each render adds one bounce iteration to
// those before, so that any number of them can be had. Techniques that only differ in what is gone then, or in name,
// are equal, so that they are rendered once; a single iteration repeats nothing.
Technique withFreshCaptures(Technique technique) {
  technique.preset = Technique().preset;
  technique.refresh = Spec{"every-frame", {}};
  technique.bounces = 1;
  technique.iterations = Iterations::bruteForce;
  technique.feedback = Feedback::previousFrame;
  technique.hysteresis = 0.0f;
  return technique;
}

}  // namespace

std::vector<RasterStep> rasterSteps(const Technique& technique, int tracedResolution) {
  const Technique fresh = withFreshCaptures(technique);
  Technique traced = withGivenMaps(withBestMaps(fresh));
  traced.bounceOrder = Technique().bounceOrder;  // of captures
  Technique perfect = traced;
  perfect.resolution = std::max(tracedResolution, technique.resolution);
  perfect.resolutionScale = ResolutionScale::fixed;
  return {{.step = "lookup", .technique = perfect, .isTraced = true},
          {.step = "resolution", .technique = traced, .isTraced = true},
          {.step = "capture", .technique = withBestMaps(fresh)},
          {.step = "filtered/format", .technique = withMapsAsStored(fresh, technique)}};
}

int texelSpp(const AttributionSettings& settings, int referenceSpp) {
  return settings.spp.value_or(std::max(kTexelSpp, referenceSpp));
}

}  // namespace pb
