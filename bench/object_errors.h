// Where an image's error lies, by object.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/region_errors.h"
#include "scenes/image.h"
#include "scenes/snapshot.h"

namespace pb {

// Errors of the pixels in which either renderer shows an object.
struct ObjectError : RegionErrors {
  std::string object;                     // its name; "environment" where neither renderer shows one
  std::string material;                   // its name, empty for the environment
  std::optional<int> probe;               // its own one, an index into the technique's probes
  std::optional<double> probeDistance{};  // metres from the seen surface to the probe, mean over the pixels
  double roughness = 0;                   // the material's factor

  friend bool operator==(const ObjectError&, const ObjectError&) = default;
};

// What the pixels of an image show: indices into Snapshot::instances, -1 for the environment. A renderer shows in a
// pixel what most of its primary samples do.
struct ObjectMap {
  Grid<int> inReference, inRaster;
  Grid<int> atCentre;           // what the reference's ray through the pixel's centre meets
  Grid<glm::vec3> positions{};  // where it does, in the world
};

// Names of the instances' objects, those of the glTF nodes: instances of the same name and material are numbered,
// "ball (2)", in their order.
std::vector<std::string> objectNames(const Snapshot& snapshot);

// One entry an object in sight, in the scene's order, the environment last. A pixel in which the renderers show
// different objects counts for both, so that shares may add up to a little more than 1. `laidOut` is the snapshot with
// the technique's probes (raster/probe_layout.h). Of objects that it cuts into parts with a probe each, `probe` is the
// first and the distance that to the nearest. All images are of one size.
std::vector<ObjectError> computeObjectErrors(const Snapshot& snapshot, const Snapshot& laidOut, const ObjectMap& shown,
                                             const Image& reference, const Image& test, const Plane& flipHdrMap);

}  // namespace pb
