#include "bench/material_errors.h"

#include <cassert>

#include "bench/instance_map.h"

namespace pb {
namespace {

constexpr int kEnvironment = -1;

int materialOf(const Snapshot& snapshot, const SampleId& id) {
  return id.instance == 0 ? kEnvironment : snapshot.instances[id.instance - 1].material;
}

}  // namespace

Grid<int> materialMap(const Snapshot& snapshot, const Grid<SampleId>& ids, int samplesPerAxis) {
  return mostFrequent(ids, samplesPerAxis, [&](const SampleId& id) { return materialOf(snapshot, id); });
}

std::vector<MaterialError> computeMaterialErrors(const Scene& scene, const Grid<int>& materials, const Image& reference,
                                                 const Image& test, const Plane& flipHdrMap) {
  assert(materials.size() == reference.size() && test.size() == reference.size());
  assert(flipHdrMap.size() == reference.size());
  std::vector<RegionSums> sums(scene.materials.size() + 1);  // the environment last
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const std::size_t entry =
        materials[i] == kEnvironment ? scene.materials.size() : static_cast<std::size_t>(materials[i]);
    sums[entry].add(reference[i], test[i], flipHdrMap[i]);
  }
  double total = 0;
  for (const RegionSums& s : sums) total += s.squares();
  std::vector<MaterialError> errors;
  for (std::size_t m = 0; m < sums.size(); ++m)
    if (sums[m].pixels() > 0)
      errors.push_back({sums[m].errors(total), m < scene.materials.size() ? scene.materials[m].name : "environment"});
  return errors;
}

}  // namespace pb
