#include "bench/traced_maps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace pb {
namespace {

// Everything that determines traced maps but the scene and the frame.
std::string keyOf(const ProbeViews& views, const ReferenceSettings& settings, bool withDistances) {
  std::string key =
      fmt::format("depth {} spp {} distances {}", settings.depth.value_or(0), settings.spp, withDistances ? 1 : 0);
  for (const ProbeView& probe : views.probes)
    key += fmt::format(" | {} {} {} {} {} [{}]", probe.position.x, probe.position.y, probe.position.z, probe.zNear,
                       probe.resolutionPx, fmt::join(probe.hidden, ","));
  return key;
}

std::size_t bytesOf(const OracleMaps& maps) {
  std::size_t bytes = 0;
  for (const auto& faces : maps.faces)
    for (const Image& face : faces) bytes += face.size() * sizeof(glm::vec3);
  for (const auto& distances : maps.distances)
    for (const Plane& face : distances) bytes += face.size() * sizeof(float);
  return bytes;
}

}  // namespace

const OracleMaps& TracedMaps::obtain(const ProbeViews& views, const ReferenceSettings& settings, bool withDistances) {
  std::string key = keyOf(views, settings, withDistances);
  const auto found = std::ranges::find(kept_, key, &Kept::first);
  if (found == kept_.end())
    kept_.emplace_back(std::move(key), traceMaps(views, settings, withDistances));
  else
    std::rotate(found, found + 1, kept_.end());
  while (kept_.size() > 1 && totalBytes() > kMostBytes) kept_.erase(kept_.begin());
  return kept_.back().second;
}

std::size_t TracedMaps::totalBytes() const {
  return std::accumulate(kept_.begin(), kept_.end(), std::size_t{0},
                         [](std::size_t sum, const Kept& kept) { return sum + bytesOf(kept.second); });
}

}  // namespace pb
