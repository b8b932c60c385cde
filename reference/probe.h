// Oracle probes: cube maps whose texels are ray-traced at the probe's position, in the orientation of
// scenes/shading/cubemap.glsl. They are what a capture would hold that approximated nothing but its resolution.
#pragma once

#include <array>
#include <atomic>

#include "reference/renderer.h"

namespace pb {

struct OracleProbe {
  std::array<Image, 6> faces;      // linear radiance, GL order, row 0 first in memory
  std::array<Plane, 6> distances;  // metres along the face's axis to what the texel's centre shows; infinity: nothing
};

// The map of `probe`, resolutionPx texels along the edge of a face. settings.samplesPerAxis is S: the mean of S x S
// rays on a regular grid in each texel. A rasterised capture has one sample a texel, at its centre: that is S = 1.
//
// The probe's owners are invisible to the rays that leave the probe, as in a capture, and to no others: mirrors that
// the probe sees show them. settings.depth counts the specular hits after those rays' start; to a viewer who sees the
// map in a mirror that is one hit more. settings.hiddenFromPrimary is replaced. Throws as ReferenceScene::render()
// does.
OracleProbe traceProbe(const ReferenceScene& scene, const Probe& probe, int resolutionPx, ReferenceSettings settings,
                       const std::atomic<bool>* cancelled = nullptr);

}  // namespace pb
