#include "bench/attribution_scores.h"

#include "bench/hash.h"

namespace pb {
namespace {

MetricValues definedValues(const Metrics& metrics) {
  MetricValues values;
  for (const MetricInfo& metric : metricTable())
    if (const std::optional<double> value = metric.value(metrics)) values.emplace_back(metric.key, *value);
  return values;
}

AttributionStep stepOf(const std::string& step, const RegionErrors& errors) {
  return {
      step, {{"mse", errors.mse}, {"relmse", errors.relmse}, {"bias", errors.bias}, {"flip_hdr", errors.flipHdr}}, {}};
}

}  // namespace

const AttributionScores::Scored& AttributionScores::score(const Image& image) {
  const std::string hash = hexHash({reinterpret_cast<const char*>(image.data()), image.size() * sizeof(image[0])});
  const auto [found, isNew] = scored_.try_emplace(hash);
  if (isNew) {
    const MetricsResult result = truth_->metrics.compare(image, truth_->mask.empty() ? nullptr : &truth_->mask);
    const Snapshot& snapshot = *truth_->snapshot;
    found->second = {definedValues(result.whole), result.masked ? definedValues(*result.masked) : MetricValues(),
                     computeObjectErrors(snapshot, snapshot, truth_->objects, truth_->mean, image, result.flipHdrMap)};
  }
  return found->second;
}

void addStep(const std::string& step, const AttributionScores::Scored& scored, Attribution& attribution) {
  attribution.steps.push_back({step, scored.metrics, scored.maskMetrics});
  if (attribution.objects.empty())
    for (const ObjectError& object : scored.objects)
      attribution.objects.push_back({object.object, object.material, object.pixels, {}});
  for (std::size_t i = 0; i < scored.objects.size(); ++i)
    attribution.objects[i].steps.push_back(stepOf(step, scored.objects[i]));
}

}  // namespace pb
