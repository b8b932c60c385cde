// Where an image's error lies, by material.
#pragma once

#include <string>
#include <vector>

#include "bench/region_errors.h"
#include "scenes/image.h"
#include "scenes/snapshot.h"

namespace pb {

// Errors of the pixels that show a material.
struct MaterialError : RegionErrors {
  std::string material;  // its name, "environment" where no object is seen

  friend bool operator==(const MaterialError&, const MaterialError&) = default;
};

// The material of each pixel, as an index into Scene::materials or -1 for the environment: the one that most of its
// primary samples show, the first of them where several do. `ids` has samplesPerAxis^2 samples a pixel.
Grid<int> materialMap(const Snapshot& snapshot, const Grid<SampleId>& ids, int samplesPerAxis);

// One entry a material in sight, in the scene's order, the environment last. All images are of one size.
std::vector<MaterialError> computeMaterialErrors(const Scene& scene, const Grid<int>& materials, const Image& reference,
                                                 const Image& test, const Plane& flipHdrMap);

}  // namespace pb
