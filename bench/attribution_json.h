// Attributions as they stand in results.json.
#pragma once

#include <vector>

#include "bench/attribution.h"
#include "bench/json_document.h"

namespace pb {

Json attributionToJson(const std::vector<Attribution>& attributions);
// Of a document that was checked against the schema.
std::vector<Attribution> attributionFromJson(const Json& json);

}  // namespace pb
