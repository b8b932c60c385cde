// Who a probe is from frame to frame: probes are numbered anew when others are joined or part (Technique::sharing), and
// are the same as long as they have the same owners. Pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenes/snapshot.h"

namespace pb {

// By probe: the instances that own it, in order.
std::vector<std::vector<int>> ownersOfProbes(const Snapshot& snapshot);

// By probe of `now`: the one of `before` with the same owners, kNewProbe if there was none.
inline constexpr int kNewProbe = -1;
std::vector<int> probesBefore(const std::vector<std::vector<int>>& before, const std::vector<std::vector<int>>& now);

// What is known by probe, in the new order; `ofNewProbes` for those that there weren't.
template <class T>
std::vector<T> reordered(std::vector<T> byProbe, const std::vector<int>& before, const T& ofNewProbes) {
  std::vector<T> result;
  for (const int probe : before) {
    const bool isKnown = probe != kNewProbe && static_cast<std::size_t>(probe) < byProbe.size();
    result.push_back(isKnown ? byProbe[static_cast<std::size_t>(probe)] : ofNewProbes);
  }
  return result;
}

// Follows the probes of a sequence.
class ProbeFollower {
 public:
  // By probe of the frame: the one of the frame before; nothing if they are the same, and in the first frame.
  std::optional<std::vector<int>> follow(const Snapshot& snapshot);

 private:
  std::vector<std::vector<int>> owners_;  // by probe, of the frame before
};

}  // namespace pb
