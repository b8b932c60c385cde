// Parts of a cell as they stand in results.json. What reads expects JSON that the schema has accepted.
#pragma once

#include <optional>
#include <vector>

#include "bench/json_document.h"
#include "bench/results.h"

namespace pb {

// A member that is written under a key.
template <class T, class Value>
struct Field {
  const char* key;
  Value T::*member;
};

Json metricValuesToJson(const MetricValues& values);
MetricValues metricValuesFromJson(const Json& json);

Json intervalsToJson(const MetricIntervals& intervals);
MetricIntervals intervalsFromJson(const Json& json);

Json replicatesToJson(const MetricReplicates& replicates);
MetricReplicates replicatesFromJson(const Json& json);

Json costToJson(const std::optional<CostResult>& cost);  // null where there is none
std::optional<CostResult> costFromJson(const Json& json);

Json reportedCostToJson(const ReportedCost& cost);
ReportedCost reportedCostFromJson(const Json& json);

Json matchedToJson(const MatchedErrors& matched);
MatchedErrors matchedFromJson(const Json& json);

Json materialsToJson(const std::vector<MaterialError>& materials);
std::vector<MaterialError> materialsFromJson(const Json& json);

Json objectsToJson(const std::vector<ObjectError>& objects);
std::vector<ObjectError> objectsFromJson(const Json& json);

Json clustersToJson(const std::vector<ErrorCluster>& clusters);
std::vector<ErrorCluster> clustersFromJson(const Json& json);

Json flickerToJson(const Flicker& flicker);
Flicker flickerFromJson(const Json& json);

}  // namespace pb
