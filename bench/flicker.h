// Change over time that only one renderer shows.
#pragma once

#include "bench/metrics/metrics.h"
#include "bench/results.h"
#include "scenes/image.h"

namespace pb {

// What a renderer shows and what is true, at one frame.
struct FramePair {
  const Image& image;
  const Image& reference;
  const Mask& mask;  // specular-dominant objects; empty if there are none in sight
};

// Means over pixels and channels of |(I_f - I_e) - (R_f - R_e)| / (f - e), radiance a frame; the reference's noise adds
// to it. All images are of one size. frames: f - e, at least 1.
Flicker computeFlicker(const FramePair& frame, const FramePair& before, int frames);

}  // namespace pb
