// The refresh policies, one file each; refresh.cpp has the table.
#pragma once

#include "raster/refresh.h"
#include "scenes/spec.h"

namespace pb {

RefreshPolicy everyFramePolicy();
RefreshPolicy everyNPolicy();
RefreshPolicy facesPolicy();
RefreshPolicy onChangePolicy();
RefreshPolicy staticPolicy();

// All faces of all probes, ordered by probe, then face.
std::vector<ProbeFace> allFaces(const Snapshot& snapshot);

// Reads a policy's parameters; name them all, then finish().
SpecReader policyReader(const Spec& spec);

}  // namespace pb
