// Which pixels of an image show reflective or refractive objects.
#pragma once

#include "bench/metrics/metrics.h"
#include "scenes/snapshot.h"

namespace pb {

// One flag per instance of the snapshot: its material is specular-dominant.
std::vector<unsigned char> specularInstances(const Snapshot& snapshot);

// Adds to `mask` every pixel in which any primary sample shows one of the instances; `ids` has samplesPerAxis^2 samples
// a pixel. Called with the object ids of both renderers it makes their union.
void addPixelsOf(const std::vector<unsigned char>& instances, const Grid<SampleId>& ids, int samplesPerAxis,
                 Mask& mask);

}  // namespace pb
