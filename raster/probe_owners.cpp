#include "raster/probe_owners.h"

#include <algorithm>

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

}  // namespace pb
