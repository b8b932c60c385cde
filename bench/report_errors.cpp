// All errors of the techniques: against the truth, against the truth of as many bounces, and over time.
#include <fmt/format.h>

#include <algorithm>

#include "bench/over_time.h"
#include "bench/report_parts.h"
#include "bench/report_verdict.h"

namespace pb {
namespace {

constexpr std::size_t kShownAges = 4;

const char* nameOf(Region region) { return region == Region::mask ? "mask" : "whole"; }

// --- Verdicts

const CellResult* cellAt(const Sequence& sequence, int frame) {
  const auto found = std::ranges::find(sequence, frame, &CellResult::frame);
  return found == sequence.end() ? nullptr : *found;
}

// The cell of smallest error in a frame, of several the cheapest; null if none has one.
const CellResult* bestAt(const Section& section, int frame) {
  const CellResult* best = nullptr;
  const auto rank = [&](const CellResult& cell) {
    return std::pair(*errorOf(cell, section.region, kMainMetric), costRank(cell));
  };
  for (const Sequence& sequence : section.sequences) {
    const CellResult* cell = cellAt(sequence, frame);
    if (!cell || !errorOf(*cell, section.region, kMainMetric)) continue;
    if (!best || rank(*cell) < rank(*best)) best = cell;
  }
  return best;
}

// Against the best of the last frame, whose interval is known in all runs that have any.
void addVerdict(std::vector<Quantity>& quantities, const Section& section) {
  const int frame = section.sequences.front().back()->frame;
  const CellResult* best = bestAt(section, frame);
  if (!best || section.sequences.size() < 2) return;
  const std::string title =
      section.severalFrames ? fmt::format("frame {} against the best", frame) : "against the best";
  quantities.push_back({{title, Align::left}, [=, region = section.region](const Sequence& sequence) -> std::string {
                          const CellResult* cell = cellAt(sequence, frame);
                          if (!cell) return "-";
                          if (cell == best) return "the best";
                          const std::optional<Verdict> verdict = knownVerdict(*cell, *best, kMainMetric, region);
                          return verdict ? printVerdict(*verdict) : "-";
                        }});
}

Table errorTable(const Section& section) {
  std::vector<Quantity> quantities;
  if (section.region == Region::mask) addErrors(quantities, section, Region::mask);
  addErrors(quantities, section, Region::whole);
  addVerdict(quantities, section);
  quantities.push_back(
      {{"face age"}, [](const Sequence& sequence) { return formatSignificant(meanFaceAge(sequence)); }});
  quantities.push_back(
      {{"oldest face"}, [](const Sequence& sequence) { return formatSignificant(largestFaceAge(sequence)); }});
  return tableOfAll(section, quantities);
}

// --- Against the truth that has the technique's number of bounces

std::string matchedMeanText(const Sequence& sequence, Region region, const std::string& metric) {
  double sum = 0;
  int frames = 0;
  for (const CellResult* cell : sequence) {
    if (!cell->matched || (region == Region::mask && !cell->matched->maskMetrics)) continue;
    const Metrics& metrics = region == Region::mask ? *cell->matched->maskMetrics : cell->matched->metrics;
    if (const std::optional<double> value = metricValue(metrics, metric)) {
      sum += *value;
      ++frames;
    }
  }
  return frames > 0 ? formatSignificant(sum / frames) : "-";
}

std::string depthText(const Sequence& sequence) {
  const std::optional<MatchedErrors>& matched = sequence.back()->matched;
  if (!matched) return "-";
  return fmt::format("{}{}", matched->depth, matched->converged ? " (all there are)" : "");
}

std::string matchedText(const Section& section) {
  const auto isMatched = [](const CellResult* cell) { return cell->matched.has_value(); };
  if (std::ranges::none_of(section.sequences, [&](const Sequence& s) { return std::ranges::any_of(s, isMatched); }))
    return {};
  const Region region = section.region;
  const auto matched = [&](const char* title, const char* metric) {
    return Quantity{{fmt::format("{} {}", title, nameOf(region))},
                    [=](const Sequence& sequence) { return matchedMeanText(sequence, region, metric); }};
  };
  const Quantity converged = {{"against all bounces"},
                              [=](const Sequence& sequence) { return meanErrorText(sequence, region, kMainMetric); }};
  const Table table = tableOfAll(section, {{{"hits"}, depthText},
                                           matched("FLIP-HDR", kMainMetric),
                                           converged,
                                           matched("relMSE", "relmse"),
                                           matched("SSIM", "ssim")});
  return "### Errors against the truth with the technique's own number of bounces\n\n" + toMarkdown(table) + '\n';
}

// --- Over time

// "0: 0.012, 3: 0.034": mean error of the frames whose faces have that age.
std::string staleText(const Sequence& sequence, Region region) {
  std::vector<StaleMean> means = meansByAge(errorsByStaleness(sequence, region, kMainMetric));
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (i + 1 < means.size() && texts.size() + 1 >= kShownAges) continue;  // the first ones and the oldest
    texts.push_back(fmt::format("{}: {}", means[i].age, formatSignificant(means[i].error)));
  }
  return texts.empty() ? "-" : fmt::format("{}", fmt::join(texts, ", "));
}

Quantity flickerQuantity(const char* title, double FrameSummary::*member, Region region) {
  return {{title}, [=](const Sequence& sequence) {
            const std::optional<FrameSummary> summary = summarizeFlicker(sequence, region);
            return summary ? formatSignificant((*summary).*member) : "-";
          }};
}

std::string overTimeText(const Section& section) {
  if (!section.severalFrames) return {};
  const Region region = section.region;
  const Quantity worstFrame = {{"worst frame"}, [=](const Sequence& sequence) {
                                 const auto summary = summarizeErrors(sequence, region, kMainMetric);
                                 return summary ? std::to_string(summary->worstFrame) : "-";
                               }};
  const Quantity stale = {{"FLIP-HDR by mean age of faces", Align::left},
                          [=](const Sequence& sequence) { return staleText(sequence, region); }};
  const Table table = tableOfAll(section, {flickerQuantity("flicker", &FrameSummary::mean, region),
                                           flickerQuantity("p95", &FrameSummary::p95, region),
                                           flickerQuantity("worst", &FrameSummary::worst, region), worstFrame, stale});
  return fmt::format("### Over time\n\nof the {}; flicker is change that only one of the two renderers shows\n\n{}\n",
                     region == Region::mask ? "mask" : "whole image", toMarkdown(table));
}

}  // namespace

std::string errorsText(const Section& section) {
  return "### All errors\n\n" + toMarkdown(errorTable(section)) + '\n' + matchedText(section) + overTimeText(section);
}

}  // namespace pb
