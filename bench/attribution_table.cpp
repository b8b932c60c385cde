#include "bench/attribution_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "bench/tables.h"

namespace pb {
namespace {

constexpr std::size_t kMostObjects = 5;
constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

constexpr char kLegend[] =
    "Images with one approximation more than the one before, from the truth to the technique as it was run, each "
    "scored "
    "against the converged truth. A bar is the difference to the image before: it "
    "may be negative, and the bars sum to the error of the last image.\n\n";

double valueOf(const std::vector<std::pair<std::string, double>>& values, const char* metric) {
  const auto found = std::ranges::find(values, metric, &std::pair<std::string, double>::first);
  return found == values.end() ? kUndefined : found->second;
}

const std::vector<std::pair<std::string, double>>& regionOf(const AttributionStep& step) {
  return step.maskMetrics.empty() ? step.metrics : step.maskMetrics;
}

std::string percent(double share) { return std::isfinite(share) ? fmt::format("{:.1f} %", 100.0 * share) : "-"; }

std::string titleOf(const Attribution& attribution, const AxisValues& defaults) {
  std::string axes;
  for (const auto& axis : attribution.technique)
    if (std::ranges::find(defaults, axis) == defaults.end()) axes += fmt::format(" {}={}", axis.first, axis.second);
  return fmt::format("### {}, {}, frame {}:{}\n\n", attribution.scene, attribution.camera, attribution.frame,
                     axes.empty() ? " every axis at its default" : axes);
}

Table stepTable(const Attribution& attribution) {
  const bool onMask = !attribution.steps.front().maskMetrics.empty();
  const std::string region = onMask ? " (mask)" : "";
  Table table{
      {{"image", Align::left}, {"flip_hdr" + region}, {"bar"}, {"share"}, {"relmse" + region}, {"bar"}, {"share"}}, {}};
  const auto totalOf = [&](const char* metric) { return valueOf(regionOf(attribution.steps.back()), metric); };
  double flipBefore = 0.0, relmseBefore = 0.0;
  for (const AttributionStep& step : attribution.steps) {
    const double flip = valueOf(regionOf(step), "flip_hdr"), relmse = valueOf(regionOf(step), "relmse");
    table.rows.push_back({step.step, formatSignificant(flip), formatSignificant(flip - flipBefore),
                          percent((flip - flipBefore) / totalOf("flip_hdr")), formatSignificant(relmse),
                          formatSignificant(relmse - relmseBefore),
                          percent((relmse - relmseBefore) / totalOf("relmse"))});
    flipBefore = flip;
    relmseBefore = relmse;
  }
  return table;
}

// The largest sums of squared errors first.
std::vector<const ObjectAttribution*> worstObjects(const Attribution& attribution) {
  std::vector<const ObjectAttribution*> objects;
  for (const ObjectAttribution& object : attribution.objects) objects.push_back(&object);
  std::ranges::stable_sort(objects, std::greater(), [](const ObjectAttribution* object) {
    return static_cast<double>(object->pixels) * valueOf(object->steps.back().metrics, "mse");
  });
  objects.resize(std::min(objects.size(), kMostObjects));
  return objects;
}

Table objectTable(const Attribution& attribution) {
  Table table{{{"object", Align::left}, {"pixels"}}, {}};
  for (const AttributionStep& step : attribution.steps) table.columns.push_back({step.step});
  table.columns.push_back({"flip_hdr"});
  for (const ObjectAttribution* object : worstObjects(attribution)) {
    std::vector<std::string> row = {object->object, std::to_string(object->pixels)};
    double before = 0.0;
    for (const AttributionStep& step : object->steps) {
      const double flip = valueOf(step.metrics, "flip_hdr");
      row.push_back(formatSignificant(flip - before));
      before = flip;
    }
    row.push_back(formatSignificant(before));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

std::string attributionTables(const std::vector<Attribution>& attributions, const AxisValues& defaults) {
  if (attributions.empty()) return {};
  std::string text = std::string("## Where the error comes from\n\n") + kLegend;
  for (const Attribution& attribution : attributions) {
    if (attribution.steps.empty()) continue;
    text += titleOf(attribution, defaults) + toMarkdown(stepTable(attribution)) + "\n";
    if (!attribution.objects.empty())
      text += "Bars of flip_hdr by object, those with the largest squared errors:\n\n" +
              toMarkdown(objectTable(attribution)) + "\n";
  }
  return text;
}

}  // namespace pb
