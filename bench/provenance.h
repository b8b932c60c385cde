// Circumstances of a run: a number never travels without them.
#pragma once

#include "bench/results.h"
#include "bench/runner.h"

namespace pb {

// Everything but the control's outcome.
Provenance makeProvenance(const Suite& suite, const Scenes& scenes, const GlInfo& gl, int threads);

// Of all that determines the cells of a run: suite, scene contents, part of the plan, program and GL driver.
std::string fingerprint(const Provenance& provenance, const Plan& plan, const Suite& suite);

}  // namespace pb
