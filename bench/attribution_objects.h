// The objects of an attribution, and each one's share of a step's errors.
#pragma once

#include <string>
#include <vector>

#include "bench/attribution.h"
#include "scenes/image.h"
#include "scenes/snapshot.h"

namespace pb {

// Index into Snapshot::instances of what most primary samples of a pixel show, the first of them where several do; -1
// for the environment. `ids` has samplesPerAxis^2 samples a pixel.
Grid<int> instanceMap(const Grid<SampleId>& ids, int samplesPerAxis);

struct ScoredImage {
  const Image& reference;
  const Image& test;
  const Plane& flipHdrMap;
};

// Appends a step to each object in sight, which are made with the first one.
void addObjects(std::vector<ObjectAttribution>& objects, const std::string& step, const Snapshot& snapshot,
                const Grid<int>& instances, const ScoredImage& image);

}  // namespace pb
