#include "raster/probe_owners.h"

#include <algorithm>
#include <utility>

namespace pb {

std::vector<std::vector<int>> ownersOfProbes(const Snapshot& snapshot) {
  std::vector<std::vector<int>> owners;
  for (const Probe& probe : snapshot.probes) std::ranges::sort(owners.emplace_back(probe.owners));
  return owners;
}

std::vector<int> probesBefore(const std::vector<std::vector<int>>& before, const std::vector<std::vector<int>>& now) {
  std::vector<int> probes;
  for (const std::vector<int>& owners : now) {
    const auto found = std::ranges::find(before, owners);
    probes.push_back(found == before.end() ? kNewProbe : static_cast<int>(found - before.begin()));
  }
  return probes;
}

std::optional<std::vector<int>> ProbeFollower::follow(const Snapshot& snapshot) {
  const std::vector<std::vector<int>> before = std::exchange(owners_, ownersOfProbes(snapshot));
  if (before.empty() || before == owners_) return std::nullopt;
  return probesBefore(before, owners_);
}

}  // namespace pb
