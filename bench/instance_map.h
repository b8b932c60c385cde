// What the pixels of an image show, by the object ids of their primary samples.
#pragma once

#include <functional>

#include "scenes/image.h"
#include "scenes/snapshot.h"

namespace pb {

// By pixel: the most frequent value of its samples, the first of them where several are. `ids` has samplesPerAxis^2
// samples a pixel.
Grid<int> mostFrequent(const Grid<SampleId>& ids, int samplesPerAxis, const std::function<int(const SampleId&)>& value);

// Index into Snapshot::instances of what most samples of a pixel show; -1 for the environment.
Grid<int> instanceMap(const Grid<SampleId>& ids, int samplesPerAxis);

}  // namespace pb
