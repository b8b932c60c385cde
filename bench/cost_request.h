// What the cost measurement of a planned sequence renders.
#pragma once

#include <memory>
#include <vector>

#include "bench/cost.h"
#include "bench/plan.h"
#include "bench/suite.h"

namespace pb {

// Named by the sequence's key. `scenes`: one a scene of the suite.
CostRequest makeCostRequest(const Suite& suite, const std::vector<std::shared_ptr<const Scene>>& scenes,
                            const PlannedSequence& sequence);

}  // namespace pb
