// Where an image's error lies, by material.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/image.h"
#include "scenes/snapshot.h"

namespace pb {

// Errors of the pixels that show a material.
struct MaterialError {
  std::string material;  // its name, "environment" where no object is seen
  std::int64_t pixels = 0;
  double mse = 0;      // mean over the pixels and channels
  double relmse = 0;   // likewise, of (test - reference)^2 / (reference^2 + 0.01)
  double bias = 0;     // mean of test - reference
  double flipHdr = 0;  // mean of the whole image's map
  double share = 0;    // of the image's sum of squared errors, 0 to 1

  friend bool operator==(const MaterialError&, const MaterialError&) = default;
};

// The material of each pixel, as an index into Scene::materials or -1 for the environment: the one that most of its
// primary samples show, the first of them where several do. `ids` has samplesPerAxis^2 samples a pixel.
Grid<int> materialMap(const Snapshot& snapshot, const Grid<SampleId>& ids, int samplesPerAxis);

// One entry a material in sight, in the scene's order, the environment last. All images are of one size.
std::vector<MaterialError> computeMaterialErrors(const Scene& scene, const Grid<int>& materials, const Image& reference,
                                                 const Image& test, const Plane& flipHdrMap);

}  // namespace pb
