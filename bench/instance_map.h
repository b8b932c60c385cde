// Which object the pixels of an image show.
#pragma once

#include "scenes/image.h"
#include "scenes/snapshot.h"

namespace pb {

// Index into Snapshot::instances of what most primary samples of a pixel show, the first of them where several do; -1
// for the environment. `ids` has samplesPerAxis^2 samples a pixel.
Grid<int> instanceMap(const Grid<SampleId>& ids, int samplesPerAxis);

}  // namespace pb
