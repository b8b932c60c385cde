#include "bench/report_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bench/over_time.h"

namespace pb {
namespace {

constexpr char kNotClearMark[] = " ~";

const std::optional<CostResult>& costOf(const Sequence& sequence) { return sequence.front()->cost; }

Quantity errorQuantity(const std::string& title, Region region, const std::string& metric) {
  return {{title}, [=](const Sequence& sequence) { return meanErrorText(sequence, region, metric); }};
}

Quantity summaryQuantity(const std::string& title, double FrameSummary::*member, Region region,
                         const std::string& metric) {
  return {{title}, [=](const Sequence& sequence) {
            const std::optional<FrameSummary> summary = summarizeErrors(sequence, region, metric);
            return summary ? formatSignificant((*summary).*member) : "-";
          }};
}

}  // namespace

Table tableOfAll(const Section& section, const std::vector<Quantity>& quantities) {
  Table table;
  for (const VaryingAxis& axis : section.axes) table.columns.push_back({axis.name, Align::left});
  for (const Quantity& quantity : quantities) table.columns.push_back(quantity.column);
  for (const Sequence& sequence : section.sequences) {
    std::vector<std::string>& row = table.rows.emplace_back();
    for (const VaryingAxis& axis : section.axes) row.push_back(axisValue(sequence, axis.name));
    for (const Quantity& quantity : quantities) row.push_back(quantity.text(sequence));
  }
  return table;
}

std::string meanErrorText(const Sequence& sequence, Region region, const std::string& metric) {
  return formatSignificant(meanError(sequence, region, metric)) +
         (isClearOfFloor(sequence, region) ? "" : kNotClearMark);
}

std::string worstErrorText(const Sequence& sequence, Region region, const std::string& metric) {
  return formatSignificant(largestError(sequence, region, metric));
}

void addErrors(std::vector<Quantity>& quantities, const Section& section, Region region) {
  const char* place = region == Region::mask ? "mask" : "whole";
  for (const auto& [metric, name] : {std::pair{kMainMetric, "FLIP-HDR"}, std::pair{"relmse", "relMSE"}}) {
    quantities.push_back(errorQuantity(fmt::format("{} {}", name, place), region, metric));
    if (!section.severalFrames) continue;
    quantities.push_back(summaryQuantity("p95", &FrameSummary::p95, region, metric));
    quantities.push_back(summaryQuantity("worst", &FrameSummary::worst, region, metric));
  }
}

bool hasCost(const Section& section) {
  return std::ranges::any_of(section.sequences, [](const Sequence& sequence) { return costOf(sequence).has_value(); });
}

Quantity costQuantity(const std::string& title, std::function<std::string(const CostResult&)> text) {
  return {{title}, [=](const Sequence& sequence) { return costOf(sequence) ? text(*costOf(sequence)) : "-"; }};
}

std::string intervalText(double low, double high) {
  return fmt::format("{}..{}", formatSignificant(low), formatSignificant(high));
}

std::string countText(double mean) {
  if (std::isnan(mean)) return formatSignificant(mean);
  return mean == std::trunc(mean) ? fmt::format("{:.0f}", mean) : fmt::format("{:.1f}", mean);
}

const Sequence& bestOf(const Section& section) {
  return *std::ranges::min_element(section.sequences, {}, [&](const Sequence& sequence) {
    const double error = meanError(sequence, section.region, kMainMetric);
    return std::tuple{std::isnan(error), error, costRank(*sequence.front())};
  });
}

std::string axesText(const Section& section, const Sequence& sequence) {
  std::string text;
  for (const VaryingAxis& axis : section.axes)
    text += fmt::format(", {}={}", axis.name, axisValue(sequence, axis.name));
  return text;
}

}  // namespace pb
