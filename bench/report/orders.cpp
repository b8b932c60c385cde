#include "bench/report/orders.h"

#include <algorithm>
#include <set>
#include <string>

#include "bench/verdict.h"

namespace pb {
namespace {

const MetricIntervals& intervalsOf(const CellResult& cell, Region region) {
  return region == Region::mask ? cell.maskIntervals : cell.intervals;
}

// Metrics of which some interval has a width.
std::set<std::string> noisyMetrics(const Section& section, Region region) {
  std::set<std::string> metrics;
  for (const Sequence& sequence : section.sequences)
    for (const CellResult* cell : sequence)
      for (const auto& [metric, interval] : intervalsOf(*cell, region))
        if (interval.low < interval.high) metrics.insert(metric);
  return metrics;
}

std::string betterThan(const CandidateSet& set, std::size_t a) {
  std::string text;
  for (std::size_t b = 0; b < set.candidates.size(); ++b)
    text += a != b && verdictOf(set, a, b) == Verdict::better ? '1' : '0';
  return text;
}

}  // namespace

Json ordersToJson(const std::vector<CellResult>& cells) {
  Json orders = Json::array();
  for (const Section& section : sectionsOf(cells))
    for (const auto& [region, name] : {std::pair{Region::mask, "mask"}, std::pair{Region::whole, "whole"}})
      for (const std::string& metric : noisyMetrics(section, region)) {
        Selection selection;
        selection.metric = metric;
        selection.region = region;
        const CandidateSet set = candidatesOf({section}, selection);
        Json order = {{"metric", metric}, {"region", name}, {"cells", Json::array()}, {"better", Json::array()}};
        for (std::size_t i = 0; i < set.candidates.size(); ++i) {
          order["cells"].push_back(set.candidates[i].worstCells.front() - cells.data());
          order["better"].push_back(betterThan(set, i));
        }
        orders.push_back(std::move(order));
      }
  return orders;
}

}  // namespace pb
