// Sequences of external techniques (bench/external.h).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/picture_source.h"

namespace pb {

// What it is and why it was skipped: a pair of SkippedExternals.
using Skipped = std::pair<std::string, std::string>;

// The first of the pair.
std::string nameOfExternal(const RunContext& context, const PlannedSequence& sequence);

// Calls `take` for each of the frames, which are measured ones of the sequence, in order. Says what the program says.
// It may measure its times: nothing else should run.
std::optional<Skipped> renderExternal(const RunContext& context, const PlannedSequence& sequence,
                                      const std::vector<int>& frames, const std::function<void(ShownFrame)>& take);

}  // namespace pb
