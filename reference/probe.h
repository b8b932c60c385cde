// Oracle probes: cube maps whose texels are ray-traced at the probe's position, in the orientation of
// scenes/shading/cubemap.glsl. They are what a capture would hold that approximated nothing but its resolution.
#pragma once

#include <array>
#include <atomic>

#include "reference/renderer.h"

namespace pb {

// The map of `probe`, resolutionPx texels along the edge of a face: linear radiance, faces in GL order, row 0 first in
// memory. settings.samplesPerAxis is S: the mean of S x S rays on a regular grid in each texel. A rasterised capture
// has one sample a texel, at its centre: that is S = 1.
//
// The probe's owners are invisible to the rays that leave the probe, as in a capture, and to no others: mirrors that
// the probe sees show them. settings.depth counts the specular hits of these rays; to a viewer who sees the map in a
// mirror that is one hit more. settings.hiddenFromPrimary is replaced. Throws as ReferenceScene::render() does.
std::array<Image, 6> traceProbe(const ReferenceScene& scene, const Probe& probe, int resolutionPx,
                                ReferenceSettings settings, const std::atomic<bool>* cancelled = nullptr);

// Metres along the axis of the face to what the texels' centres show, infinity where that is the environment.
std::array<Plane, 6> traceProbeDistances(const ReferenceScene& scene, const Probe& probe, int resolutionPx);

}  // namespace pb
