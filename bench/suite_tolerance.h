// The tolerances of a suite, and those that a scene of it has in their place.
#pragma once

#include "bench/tolerance.h"
#include "bench/toml_reader.h"

namespace pb {

// [tolerance]: a preset, and metrics in place of its own. Empty if there is none.
ToleranceLevels readSuiteTolerances(TomlReader& suite);

// `tolerance` of a [[scene]], for metrics that have one in `ofSuite`; of a preset those count alone.
ToleranceLevels readSceneTolerances(TomlReader& scene, const ToleranceLevels& ofSuite);

}  // namespace pb
