#include "bench/report/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "bench/differences.h"
#include "bench/report/circumstances.h"
#include "bench/report_verdict.h"
#include "bench/sections.h"
#include "bench/tables.h"

namespace pb {
namespace {

constexpr std::size_t kShownChanges = 12;

// A number with what is known of its uncertainty.
struct Measured {
  double value = 0;
  std::optional<Interval> interval{};
};

Region regionOf(const CellResult& before, const CellResult& after) {
  return before.maskMetrics && after.maskMetrics ? Region::mask : Region::whole;
}

std::optional<Measured> measuredError(const CellResult& cell, Region region, const std::string& metric) {
  const std::optional<double> value = errorOf(cell, region, metric);
  if (!value || std::isnan(*value)) return std::nullopt;
  Measured measured{*value};
  for (const auto& [name, interval] : region == Region::mask ? cell.maskIntervals : cell.intervals)
    if (name == metric) measured.interval = interval;
  if (!measured.interval && isNoiseKnown(cell, region, metric)) measured.interval = Interval{*value, *value};
  return measured;
}

std::optional<Measured> frameMsOf(const CellResult& cell) {
  if (!cell.cost) return std::nullopt;
  return Measured{cell.cost->frameMs, Interval{cell.cost->frameMsLow, cell.cost->frameMsHigh}};
}

std::optional<Measured> ratioOf(const CellResult& cell) {
  if (!cell.cost) return std::nullopt;
  return Measured{cell.cost->ratio, Interval{cell.cost->ratioLow, cell.cost->ratioHigh}};
}

struct Quantity {
  const char* name;
  const char* title;
  std::optional<Measured> (*costOf)(const CellResult&);  // null: a metric, by its name
};

constexpr std::array<Quantity, 5> kQuantities = {{
    {"flip_hdr", "FLIP-HDR", nullptr},
    {"relmse", "relMSE", nullptr},
    {"ssim", "SSIM", nullptr},
    {"frame_ms", "frame ms", frameMsOf},
    {"ratio", "x plain", ratioOf},
}};

constexpr std::pair<Change, const char*> kChangeNames[] = {{Change::better, "better"},
                                                           {Change::worse, "worse"},
                                                           {Change::equal, "equal"},
                                                           {Change::belowFloor, "below the floor"},
                                                           {Change::changed, "changed"}};

const char* nameOf(Change change) {
  return std::ranges::find(kChangeNames, change, &std::pair<Change, const char*>::first)->second;
}

Change changeOf(std::optional<Verdict> verdict) {
  if (!verdict) return Change::changed;
  switch (*verdict) {
    case Verdict::better:
      return Change::better;
    case Verdict::worse:
      return Change::worse;
    case Verdict::belowFloor:
      return Change::belowFloor;
    case Verdict::equal:
      break;
  }
  return Change::equal;
}

Estimate estimateOf(const Measured& cost) { return {cost.value, cost.interval->low, cost.interval->high}; }

// Where both are scored against the same reference.
std::optional<Interval> pairedInterval(const CellResult& before, const CellResult& after, const std::string& metric,
                                       Region region) {
  Selection selection;
  selection.metric = metric;
  const std::optional<Difference> difference = differenceOf(after, before, selection, region);
  if (!difference || !difference->isPaired) return std::nullopt;
  const double low = metricOfLoss(metric, difference->loss.low), high = metricOfLoss(metric, difference->loss.high);
  return Interval{std::min(low, high), std::max(low, high)};
}

std::vector<ComparedValue> compareCells(const CellResult& before, const CellResult& after, bool withCosts) {
  std::vector<ComparedValue> values;
  const Region region = regionOf(before, after);
  for (const Quantity& quantity : kQuantities) {
    const auto of = [&](const CellResult& cell) {
      return quantity.costOf ? quantity.costOf(cell) : measuredError(cell, region, quantity.name);
    };
    if (quantity.costOf && !withCosts) continue;
    const std::optional<Measured> a = of(before), b = of(after);
    if (!a || !b) continue;
    const Change change = changeOf(quantity.costOf ? verdictOf(estimateOf(*b), estimateOf(*a))
                                                   : knownVerdict(after, before, quantity.name, region));
    values.push_back({quantity.name, a->value, b->value, a->interval, b->interval, change});
    if (!quantity.costOf) values.back().differenceInterval = pairedInterval(before, after, quantity.name, region);
  }
  return values;
}

Json intervalToJson(const std::optional<Interval>& interval) {
  return interval ? Json::array({encodeNumber(interval->low), encodeNumber(interval->high)}) : Json();
}

// --- Which cells are the same

std::set<std::string> varyingAxes(const Results& before, const Results& after) {
  std::set<std::string> varying = {kExternalAxis};  // which only some cells have
  for (const Results* run : {&before, &after})
    for (const auto& [axis, values] : valuesByAxis(*run))
      if (values.size() > 1) varying.insert(axis);
  return varying;
}

std::string keyOf(CellResult cell, const std::set<std::string>& varying) {
  std::erase_if(cell.technique, [&](const auto& axis) { return !varying.contains(axis.first); });
  return cell.key();
}

// --- The report

// By which factor a value changed, as a distance from no change; what comes from or goes to 0 changed most.
double sizeOf(const ComparedValue& value) {
  if (value.before == value.after) return 0;
  const double size = std::abs(std::log(value.after / value.before));
  return std::isnan(size) ? std::abs(value.difference()) : size;
}

// "+0.002", with its interval where it is paired "+0.002 +- 0.001".
std::string differenceText(const ComparedValue& value) {
  const double difference = value.difference();
  std::string text = fmt::format("{}{}", difference > 0 ? "+" : "", formatSignificant(difference));
  if (const std::optional<Interval>& interval = value.differenceInterval)
    text += formatUncertainty({difference, interval->low, interval->high});
  return text;
}

std::string percentText(const ComparedValue& value) {
  const double percent = 100.0 * value.difference() / std::abs(value.before);
  return std::isfinite(percent) ? fmt::format("{:+.1f} %", percent) : "-";
}

Table countTable(const Comparison& comparison) {
  Table table{
      {{"value", Align::left}, {"better"}, {"worse"}, {"equal"}, {"below the floor"}, {"changed"}, {"largest change"}},
      {}};
  for (const Quantity& quantity : kQuantities) {
    std::map<Change, int> counts;
    const ComparedValue* largest = nullptr;
    for (const ComparedCell& cell : comparison.cells)
      for (const ComparedValue& value : cell.values) {
        if (value.name != quantity.name) continue;
        ++counts[value.change];
        if (!largest || sizeOf(value) > sizeOf(*largest)) largest = &value;
      }
    if (largest)
      table.rows.push_back({quantity.title, std::to_string(counts[Change::better]),
                            std::to_string(counts[Change::worse]), std::to_string(counts[Change::equal]),
                            std::to_string(counts[Change::belowFloor]), std::to_string(counts[Change::changed]),
                            percentText(*largest)});
  }
  return table;
}

// The largest changes that are more than noise, as far as that is known. Costs as multiples of a plain frame:
// milliseconds tell how busy the machine was as well.
Table changeTable(const Comparison& comparison, const Results& after, const AxisValues& defaults) {
  struct Row {
    const ComparedCell* cell;
    const ComparedValue* value;
  };
  std::vector<Row> rows;
  for (const ComparedCell& cell : comparison.cells)
    for (const ComparedValue& value : cell.values)
      if (value.change != Change::equal && value.change != Change::belowFloor && value.name != "frame_ms")
        rows.push_back({&cell, &value});
  std::ranges::stable_sort(rows, std::greater(), [](const Row& row) { return sizeOf(*row.value); });
  if (rows.size() > kShownChanges) rows.resize(kShownChanges);
  Table table{
      {{"cell", Align::left}, {"value", Align::left}, {"before"}, {"after"}, {"difference"}, {""}, {"", Align::left}},
      {}};
  for (const Row& row : rows)
    table.rows.push_back({shortKey(after.cells[row.cell->after].key(), defaults), row.value->name,
                          formatSignificant(row.value->before), formatSignificant(row.value->after),
                          differenceText(*row.value), percentText(*row.value), nameOf(row.value->change)});
  return table;
}

}  // namespace

Comparison compareRuns(const Results& before, const Results& after) {
  const std::set<std::string> varying = varyingAxes(before, after);
  std::map<std::string, std::size_t> earlier;
  for (std::size_t i = 0; i < before.cells.size(); ++i) earlier[keyOf(before.cells[i], varying)] = i;
  Comparison comparison;
  std::set<std::string> withCosts;  // sequences
  for (std::size_t i = 0; i < after.cells.size(); ++i) {
    const auto found = earlier.find(keyOf(after.cells[i], varying));
    if (found == earlier.end()) {
      comparison.onlyAfter.push_back(i);
      continue;
    }
    const bool isFirst = withCosts.insert(after.cells[i].sequenceKey()).second;
    comparison.cells.push_back({found->second, i, compareCells(before.cells[found->second], after.cells[i], isFirst)});
    earlier.erase(found);
  }
  for (const auto& [key, index] : earlier) comparison.onlyBefore.push_back(index);
  std::ranges::sort(comparison.onlyBefore);
  return comparison;
}

std::string makeComparisonReport(const Results& before, const Results& after, const AxisValues& defaults) {
  const Comparison comparison = compareRuns(before, after);
  std::string text = fmt::format("# {}: before and after\n\n{} cells compared",
                                 escapeMarkdown(after.provenance.suiteName), comparison.cells.size());
  if (const std::size_t count = comparison.onlyBefore.size()) text += fmt::format(", {} only before", count);
  if (const std::size_t count = comparison.onlyAfter.size()) text += fmt::format(", {} only after", count);
  text += ".\n\n";
  if (!comparison.cells.empty()) {
    text += toMarkdown(countTable(comparison)) + '\n';
    text +=
        "Errors are those of the mask, where a scene has one. `equal`: the same, or the difference is within its 95 % "
        "interval (paired where both runs have the same reference, else by overlap of the two intervals); `below the "
        "floor`: neither is clear of the reference's own noise, and MSE is not sure either; `changed`: not the same, "
        "and no interval is "
        "known. Costs are counted once a technique and scene, errors once a frame.\n\n";
    const Table changes = changeTable(comparison, after, defaults);
    if (!changes.rows.empty()) text += "What changed most:\n\n" + toMarkdown(changes) + '\n';
  }
  return text + circumstancesText(before, after);
}

std::string comparisonToCsv(const Results& before, const Results& after, const AxisValues& defaults) {
  const auto quoted = [](const std::string& text) {
    std::string result;
    for (const char c : text) result.append(c == '"' ? 2 : 1, c);
    return fmt::format("\"{}\"", result);
  };
  std::string text = "cell,value,before,after,difference,change\n";
  for (const ComparedCell& cell : compareRuns(before, after).cells)
    for (const ComparedValue& value : cell.values)
      text += fmt::format("{},{},{},{},{},{}\n", quoted(shortKey(after.cells[cell.after].key(), defaults)), value.name,
                          value.before, value.after, value.difference(), nameOf(value.change));
  return text;
}

Json toJson(const Comparison& comparison) {
  Json json = {{"cells", Json::array()}, {"onlyBefore", comparison.onlyBefore}, {"onlyAfter", comparison.onlyAfter}};
  for (const ComparedCell& cell : comparison.cells) {
    Json values = Json::object();
    for (const ComparedValue& value : cell.values)
      values[value.name] = {{"before", encodeNumber(value.before)},
                            {"after", encodeNumber(value.after)},
                            {"beforeInterval", intervalToJson(value.beforeInterval)},
                            {"afterInterval", intervalToJson(value.afterInterval)},
                            {"differenceInterval", intervalToJson(value.differenceInterval)},
                            {"change", nameOf(value.change)}};
    json["cells"].push_back({{"before", cell.before}, {"after", cell.after}, {"values", values}});
  }
  return json;
}

}  // namespace pb
