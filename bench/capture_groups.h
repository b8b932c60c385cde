// Which sequences of a scene are rendered together because their captures are equal (raster/equal_captures.h). Pure.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "bench/bounce_depth.h"
#include "raster/technique.h"

namespace pb {

// Of sequences of the frames `first` to `last` each. Indices into `techniques`: groups by their first member, members
// in order, at most kMostInGroup of them, so that memory doesn't grow with the number of techniques. What holds shadow
// maps or back faces of its own stays alone: mayShareCaptures().
inline constexpr std::size_t kMostInGroup = 16;
using CaptureGroups = std::vector<std::vector<std::size_t>>;
CaptureGroups captureGroups(const std::vector<Technique>& techniques, int first, int last,
                            const SnapshotOfFrame& snapshotOf, int heightPx);

}  // namespace pb
