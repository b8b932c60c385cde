// What the refresh policies, one file each, have in common.
#pragma once

#include "raster/refresh.h"
#include "scenes/spec.h"

namespace pb {

// All faces of all probes, ordered by probe, then face.
std::vector<ProbeFace> allFaces(const Snapshot& snapshot);

// Those of which at least a part is captured.
std::vector<ProbeFace> capturedFaces(const Technique& technique, const Snapshot& snapshot);

// Around all owners of the probe; the probe's position if it has none.
Bounds boundsOfOwners(const Snapshot& snapshot, const Probe& probe);

// The probes whose maps the instance shows.
std::vector<int> probesShownBy(const Technique& technique, const Snapshot& snapshot, int instance);

// Frames since the face was captured: 1 if that was in the frame before.
std::int64_t ageOf(const RefreshHistory& history, const ProbeFace& face);

// Reads a policy's parameters; name them all, then finish().
SpecReader policyReader(const Spec& spec);

}  // namespace pb
