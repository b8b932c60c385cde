#include "bench/cell_json.h"

namespace pb {
namespace {

constexpr Field<CostResult, double> kCostNumbers[] = {
    {"frame_ms", &CostResult::frameMs},
    {"frame_ms_low", &CostResult::frameMsLow},
    {"frame_ms_high", &CostResult::frameMsHigh},
    {"plain_ms", &CostResult::plainMs},
    {"ratio", &CostResult::ratio},
    {"ratio_low", &CostResult::ratioLow},
    {"ratio_high", &CostResult::ratioHigh},
    {"final_ms", &CostResult::finalMs},
    {"renders_per_frame", &CostResult::rendersPerFrame},
    {"measured_renders_per_frame", &CostResult::measuredRendersPerFrame},
};

constexpr Field<CostPeaks, double> kPeaks[] = {
    {"p50", &CostPeaks::p50}, {"p95", &CostPeaks::p95}, {"p99", &CostPeaks::p99}, {"worst", &CostPeaks::worst}};

}  // namespace

Json costToJson(const std::optional<CostResult>& cost) {
  if (!cost) return nullptr;
  Json json;
  json["repetitions"] = cost->repetitions;
  for (const auto& field : kCostNumbers) json[field.key] = (*cost).*field.member;
  if (!cost->ratios.empty()) json["ratios"] = cost->ratios;
  if (cost->peaks)
    for (const auto& field : kPeaks) json["peaks"][field.key] = (*cost->peaks).*field.member;
  json["shadow_ms"] = cost->shadowMs;
  json["capture_ms"] = cost->captureMs;
  json["prefilter_ms"] = cost->prefilterMs;
  json["renders_formula"] = cost->rendersFormula;
  return json;
}

std::optional<CostResult> costFromJson(const Json& json) {
  if (json.is_null()) return std::nullopt;
  CostResult cost;
  cost.repetitions = json.at("repetitions").get<int>();
  for (const auto& field : kCostNumbers) cost.*field.member = json.at(field.key).get<double>();
  cost.ratios = json.value("ratios", std::vector<double>());
  if (const auto peaks = json.find("peaks"); peaks != json.end()) {
    cost.peaks.emplace();
    for (const auto& field : kPeaks) (*cost.peaks).*field.member = peaks->at(field.key).get<double>();
  }
  cost.captureMs = json.at("capture_ms").get<std::vector<double>>();
  cost.shadowMs = json.value("shadow_ms", 0.0);  // older results have neither
  cost.prefilterMs = json.value("prefilter_ms", 0.0);
  cost.rendersFormula = json.at("renders_formula").get<std::string>();
  return cost;
}

Json reportedCostToJson(const ReportedCost& cost) {
  const auto orNull = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  return {{"program", cost.program},           {"frames", cost.frames},
          {"frame_ms", cost.frameMs},          {"frame_ms_low", cost.frameMsLow},
          {"frame_ms_high", cost.frameMsHigh}, {"plain_ms", orNull(cost.plainMs)},
          {"ratio", orNull(cost.ratio())}};
}

// `ratio` follows from the rest.
ReportedCost reportedCostFromJson(const Json& json) {
  ReportedCost cost;
  cost.program = json.at("program").get<std::string>();
  cost.frames = json.at("frames").get<int>();
  cost.frameMs = json.at("frame_ms").get<double>();
  cost.frameMsLow = json.at("frame_ms_low").get<double>();
  cost.frameMsHigh = json.at("frame_ms_high").get<double>();
  if (const Json& plain = json.at("plain_ms"); !plain.is_null()) cost.plainMs = plain.get<double>();
  return cost;
}

}  // namespace pb
