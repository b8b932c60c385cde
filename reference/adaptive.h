// Where a picture needs how many samples.
#pragma once

#include "reference/renderer.h"

namespace pb {

struct AdaptiveGoal {
  double maxNoise;  // relMSE of the mean's noise floor
  int maxSpp;       // of any pixel
};

// Samples per primary point of every pixel with which a new picture is expected to have at most the goal's noise, for
// the least samples in all: n in proportion to the pixel's standard deviation over sqrt(r^2 + 0.01), rounded to
// pilotSamples times a power of two. Samples grow where the pilot has noise, unless they are at the limit already; all
// pixels are at the limit where that is not enough.
//
// The pilot's own samples must not enter the new picture, which needs another seed: then what its pixels show doesn't
// depend on their number of samples, and every mean stays unbiased.
SampleMap planSamples(const ReferenceImage& pilot, const SampleMap& pilotSamples, const AdaptiveGoal& goal);

}  // namespace pb
