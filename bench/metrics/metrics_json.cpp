#include "bench/metrics/metrics_json.h"

#include <nlohmann/json.hpp>

#include "bench/json_document.h"

namespace pb {
namespace {

template <class T>
struct Field {
  const char* key;
  double T::*member;
};

constexpr Field<ErrorSums> kSums[] = {
    {"bias", &ErrorSums::bias},     {"mse", &ErrorSums::mse},        {"rmse", &ErrorSums::rmse},
    {"mae", &ErrorSums::mae},       {"max_abs", &ErrorSums::maxAbs}, {"psnr", &ErrorSums::psnr},
    {"relmse", &ErrorSums::relmse}, {"smape", &ErrorSums::smape},
};

constexpr Field<FlipPooled> kFlip[] = {
    {"mean", &FlipPooled::mean},
    {"weighted_q1", &FlipPooled::weightedQ1},
    {"weighted_median", &FlipPooled::weightedMedian},
    {"weighted_q3", &FlipPooled::weightedQ3},
    {"min", &FlipPooled::min},
    {"max", &FlipPooled::max},
};

Json flipToJson(const FlipPooled& flip, double ppd) {
  Json json;
  for (const auto& field : kFlip) json[field.key] = encodeNumber(flip.*field.member);
  json["ppd"] = encodeNumber(ppd);
  return json;
}

Json flipHdrToJson(const Metrics& metrics) {
  if (!metrics.flipHdr) return nullptr;
  Json json = flipToJson(*metrics.flipHdr, metrics.ppd);
  json["start_exposure"] = encodeNumber(metrics.startExposure);
  json["stop_exposure"] = encodeNumber(metrics.stopExposure);
  json["num_exposures"] = metrics.numExposures;
  return json;
}

FlipPooled flipFromJson(const Json& json) {
  FlipPooled flip;
  for (const auto& field : kFlip) flip.*field.member = decodeNumber(json.at(field.key));
  return flip;
}

void appendSsim(const std::optional<Ssim>& ssim, Json& json) {
  json["ssim"] = ssim ? encodeNumber(ssim->mean) : nullptr;
  Json& channels = json["ssim_channels"] = nullptr;
  if (ssim)
    for (const double channel : ssim->channels) channels.push_back(encodeNumber(channel));
  json["ssim_luma"] = ssim ? encodeNumber(ssim->luma) : nullptr;
}

std::optional<Ssim> ssimFromJson(const Json& json) {
  if (json.at("ssim").is_null()) return std::nullopt;
  Ssim ssim;
  ssim.mean = decodeNumber(json.at("ssim"));
  ssim.luma = decodeNumber(json.at("ssim_luma"));
  const Json& channels = json.at("ssim_channels");
  for (std::size_t i = 0; i < ssim.channels.size(); ++i)
    ssim.channels[i] = decodeNumber(channels.is_null() ? Json() : channels.at(i));
  return ssim;
}

}  // namespace

Json metricsToJson(const Metrics& metrics) {
  Json json;
  for (const auto& field : kSums) json[field.key] = encodeNumber(metrics.sums.*field.member);
  appendSsim(metrics.ssim, json);
  json["ms_ssim"] = metrics.msSsim ? encodeNumber(*metrics.msSsim) : nullptr;
  json["flip_ldr"] = flipToJson(metrics.flipLdr, metrics.ppd);
  json["flip_hdr"] = flipHdrToJson(metrics);
  return json;
}

Metrics metricsFromJson(const Json& json) {
  Metrics metrics;
  for (const auto& field : kSums) metrics.sums.*field.member = decodeNumber(json.at(field.key));
  metrics.ssim = ssimFromJson(json);
  if (const Json& msSsim = json.at("ms_ssim"); !msSsim.is_null()) metrics.msSsim = decodeNumber(msSsim);
  metrics.flipLdr = flipFromJson(json.at("flip_ldr"));
  metrics.ppd = decodeNumber(json.at("flip_ldr").at("ppd"));
  if (const Json& hdr = json.at("flip_hdr"); !hdr.is_null()) {
    metrics.flipHdr = flipFromJson(hdr);
    metrics.startExposure = decodeNumber(hdr.at("start_exposure"));
    metrics.stopExposure = decodeNumber(hdr.at("stop_exposure"));
    metrics.numExposures = hdr.at("num_exposures").get<int>();
  }
  return metrics;
}

}  // namespace pb
