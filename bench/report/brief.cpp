#include "bench/report/brief.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "bench/sections.h"
#include "bench/tables.h"

namespace pb {
namespace {

constexpr char kMetric[] = "flip_hdr";

std::string techniqueText(const Section& section, const Sequence& sequence) {
  std::vector<std::string> axes;
  for (const VaryingAxis& axis : section.axes)
    axes.push_back(fmt::format("{}={}", axis.name, axisValue(sequence, axis.name)));
  if (const std::string external = axisValue(sequence, kExternalAxis); !external.empty()) return external;
  return axes.empty() ? "the only technique" : fmt::format("{}", fmt::join(axes, ", "));
}

std::string numbersText(const Section& section, const Sequence& sequence) {
  const std::string error = formatSignificant(meanError(sequence, section.region, kMetric));
  const std::optional<CostResult>& cost = sequence.front()->cost;
  return cost ? fmt::format("{} at {} x plain", error, formatSignificant(cost->ratio)) : error;
}

// The sequence with the smallest value, of several the cheapest; those without one come last.
template <class Value>
const Sequence& smallest(const Section& section, Value value) {
  return *std::ranges::min_element(section.sequences, {}, [&](const Sequence& sequence) {
    const double v = value(sequence);
    return std::tuple{std::isnan(v), v, costRank(*sequence.front())};
  });
}

Table tableOf(const std::vector<Section>& sections) {
  Table table{
      {{"scene", Align::left}, {"smallest error", Align::left}, {"FLIP-HDR"}, {"cheapest", Align::left}, {"FLIP-HDR"}},
      {}};
  for (Section section : sections) {
    if (section.sequences.empty()) section.sequences = section.externals;
    const Sequence& best = smallest(section, [&](const Sequence& s) { return meanError(s, section.region, kMetric); });
    const Sequence& cheapest =
        smallest(section, [](const Sequence& s) { return s.front()->cost ? s.front()->cost->frameMs : 0.0; });
    const bool hasCost = cheapest.front()->cost.has_value();
    table.rows.push_back({best.front()->scene, techniqueText(section, best), numbersText(section, best),
                          hasCost ? techniqueText(section, cheapest) : "-",
                          hasCost ? numbersText(section, cheapest) : "-"});
  }
  return table;
}

}  // namespace

std::string makeBrief(const Results& results, const std::vector<std::string>& answer) {
  const Provenance& p = results.provenance;
  std::string text = fmt::format("## {}: error and cost of reflection probes\n\n", escapeMarkdown(p.suiteName));
  for (const std::string& line : answer) text += fmt::format("- {}\n", escapeMarkdown(line));
  if (!answer.empty()) text += '\n';
  const std::vector<Section> sections = sectionsOf(results.cells);
  text += toMarkdown(tableOf(sections));
  return text + fmt::format("\n{} cells, control {}; probebench {} ({}), {} {}, {}\n", results.cells.size(),
                            escapeMarkdown(p.controlOutcome), p.toolVersion, p.gitHash, p.glBackend, p.glRenderer,
                            p.startedAt);
}

}  // namespace pb
