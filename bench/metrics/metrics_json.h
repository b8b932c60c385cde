// Metrics as the JSON object that `compare --json` prints and results.json holds in each cell.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "bench/metrics/metrics.h"

namespace pb {

// Keys in fixed order; null where a metric is undefined, "inf" for the psnr of equal images.
nlohmann::ordered_json metricsToJson(const Metrics& metrics);

// Inverse of metricsToJson for objects that the schema accepts.
Metrics metricsFromJson(const nlohmann::ordered_json& object);

}  // namespace pb
