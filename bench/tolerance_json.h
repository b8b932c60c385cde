// Tolerances as results.json and baselines hold them.
#pragma once

#include "bench/json_document.h"
#include "bench/tolerance.h"

namespace pb {

Json tolerancesToJson(const Tolerances& tolerances);
Tolerances tolerancesFromJson(const Json& json);

// The members "tolerance", "warn_tolerance" and "scene_tolerances" of a document; only the first is always there.
void writeTolerances(Json& document, const ToleranceLevels& levels, const SceneTolerances& scenes);
ToleranceLevels readTolerances(const Json& document);
SceneTolerances readSceneTolerances(const Json& document);

}  // namespace pb
