// SSIM in two steps, so that the whole image and a mask share the maps.
#pragma once

#include <array>
#include <optional>

#include "bench/metrics/metrics.h"
#include "scenes/image.h"

namespace pb {

// Similarity at each pixel that is at least 5 from the border; empty where a side is shorter than 11 pixels.
struct SsimMaps {
  std::array<Grid<double>, 3> channels;
  Grid<double> luma;
};
SsimMaps computeSsimMaps(const Image& reference, const Image& test);

// As computeSsim(), which is both steps.
std::optional<Ssim> averageSsim(const SsimMaps& maps, const Mask* mask = nullptr);

}  // namespace pb
