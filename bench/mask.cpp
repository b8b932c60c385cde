#include "bench/mask.h"

#include <cassert>

namespace pb {

std::vector<unsigned char> specularInstances(const Snapshot& snapshot) {
  std::vector<unsigned char> flags;
  for (const SnapshotInstance& instance : snapshot.instances)
    flags.push_back(snapshot.materialOf(instance).isSpecularDominant ? 1 : 0);
  return flags;
}

void addPixelsOf(const std::vector<unsigned char>& instances, const Grid<SampleId>& ids, int samplesPerAxis,
                 Mask& mask) {
  assert(ids.width() == mask.width() * samplesPerAxis && ids.height() == mask.height() * samplesPerAxis);
  for (int y = 0; y < ids.height(); ++y)
    for (int x = 0; x < ids.width(); ++x) {
      const std::uint32_t id = ids(x, y).instance;  // index + 1, 0 for the environment
      if (id > 0 && instances[id - 1] != 0) mask(x / samplesPerAxis, y / samplesPerAxis) = 1;
    }
}

}  // namespace pb
