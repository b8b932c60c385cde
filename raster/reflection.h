// What an instance's specular lobe looks up: pure functions.
#pragma once

#include <vector>

#include "raster/technique.h"
#include "scenes/snapshot.h"

namespace pb {

enum class ReflectionSource { probe, environment, nothing };

struct Reflection {
  ReflectionSource source;
  int probe = -1;   // whose cube map is looked up, once it is captured; the environment until then
  int second = -1;  // mixed with that of a second one, if both are captured, else the one that is
  float secondWeight = 0.0f;
};

// An instance's own probe; without one, coats and gloss see what the technique's `coats` says, mirrors and glass what
// its `withoutProbe` says.
//
// Blended are the two probes nearest to the centre of the instance's bounds, at the distances a <= b, with weights in
// the ratio of 1/a - 1/c to 1/b - 1/c, c the distance of the third one (1/c = 0 without): inverse distances, lowered so
// that the weights of an instance that moves are continuous where its second probe becomes another one.
Reflection reflectionOf(const Technique& technique, const Snapshot& snapshot, const SnapshotInstance& instance);

// What serves instances without a probe of their own, once all probes are captured: how many of them look up the cube
// map of each probe (the nearer one, where two are blended), and how many the environment.
struct LookupSources {
  std::vector<int> ofProbes;
  int fromEnvironment = 0;

  friend bool operator==(const LookupSources&, const LookupSources&) = default;
};
LookupSources coatSources(const Technique& technique, const Snapshot& snapshot);    // of coats and gloss
LookupSources mirrorSources(const Technique& technique, const Snapshot& snapshot);  // of mirrors and glass

// The levels above level 0 that the maps of probes have: the filter's if rough lobes look one up, box-filtered ones if
// only smooth lobes do, by Technique::mips. The same for all frames of a sequence: instances keep their materials, and
// one scene has the same number of probes.
ProbeFilter levelFilter(const Technique& technique, const Snapshot& snapshot);

// By probe: whether lobes look up its levels.
std::vector<bool> probesWithLevels(const Technique& technique, const Snapshot& snapshot);

}  // namespace pb
