// The parts of results.json that baselines share with it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/json_document.h"
#include "bench/results.h"

namespace pb {

Json provenanceToJson(const Provenance& provenance);
Provenance provenanceFromJson(const Json& json);

Json axisValuesToJson(const AxisValues& values);
AxisValues axisValuesFromJson(const Json& json);

Json countersToJson(const std::vector<std::pair<std::string, std::int64_t>>& counters);
std::vector<std::pair<std::string, std::int64_t>> countersFromJson(const Json& json);

// The cell as it stands in results.json, and back from JSON that the schema has accepted.
Json cellToJson(const CellResult& cell);
CellResult cellFromJson(const Json& json);

}  // namespace pb
