#include "raster/probe_resolution.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "raster/refresh/policies.h"

namespace pb {
namespace {

constexpr int kLeastTexels = 8;

int resolutionOf(int most, float diameterPx) {
  const float wanted = std::clamp(std::ceil(diameterPx), static_cast<float>(kLeastTexels), static_cast<float>(most));
  return std::min(most, static_cast<int>(std::bit_ceil(static_cast<unsigned>(wanted))));
}

}  // namespace

float projectedSize(const Snapshot& snapshot, const Bounds& box) {
  const float radius = 0.5f * glm::length(box.extent());
  const float distance = glm::distance(box.centre(), glm::vec3(snapshot.camera.origin));
  const float tangent = glm::length(glm::vec3(snapshot.camera.down));  // of half the field of view
  return distance > radius ? radius / (distance * tangent) : std::numeric_limits<float>::infinity();
}

std::vector<int> probeResolutions(const Technique& technique, const Snapshot& snapshot, int heightPx) {
  std::vector<int> resolutions(snapshot.probes.size(), technique.resolution);
  if (technique.resolutionScale == ResolutionScale::fixed) return resolutions;
  for (std::size_t probe = 0; probe < resolutions.size(); ++probe)
    resolutions[probe] = resolutionOf(
        technique.resolution,
        static_cast<float>(heightPx) * projectedSize(snapshot, boundsOfOwners(snapshot, snapshot.probes[probe])));
  return resolutions;
}

}  // namespace pb
