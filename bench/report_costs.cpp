// What the techniques cost: measured times, their peaks, and the work of a frame.
#include "bench/report_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pb {
namespace {

std::string captureText(const std::vector<double>& captureMs) {
  std::vector<std::string> texts;
  for (const double ms : captureMs) texts.push_back(formatSignificant(ms));
  return fmt::format("{}", fmt::join(texts, " + "));
}

Table costTable(const Section& section) {
  return tableOfAll(
      section,
      {costQuantity("frame ms", [](const CostResult& cost) { return formatSignificant(cost.frameMs); }),
       costQuantity("95 %", [](const CostResult& cost) { return intervalText(cost.frameMsLow, cost.frameMsHigh); }),
       costQuantity("x plain", [](const CostResult& cost) { return formatSignificant(cost.ratio); }),
       costQuantity("95 %", [](const CostResult& cost) { return intervalText(cost.ratioLow, cost.ratioHigh); }),
       costQuantity("renders/frame by formula", [](const CostResult& cost) { return cost.rendersFormula; }),
       costQuantity("measured", [](const CostResult& cost) { return countText(cost.measuredRendersPerFrame); }),
       costQuantity("shadow ms", [](const CostResult& cost) { return formatSignificant(cost.shadowMs); }),
       costQuantity("capture ms by bounce", [](const CostResult& cost) { return captureText(cost.captureMs); }),
       costQuantity("prefilter ms", [](const CostResult& cost) { return formatSignificant(cost.prefilterMs); }),
       costQuantity("final ms", [](const CostResult& cost) { return formatSignificant(cost.finalMs); })});
}

// Of the single frames: what is amortised over frames costs its share in the mean, but all of it in one frame.
Table peakTable(const Section& section) {
  const auto peak = [](const char* title, double CostPeaks::*member) {
    return costQuantity(
        title, [=](const CostResult& cost) { return cost.peaks ? formatSignificant((*cost.peaks).*member) : "-"; });
  };
  const Quantity ratio = costQuantity("worst / p50", [](const CostResult& cost) {
    return cost.peaks ? formatSignificant(cost.peaks->worst / cost.peaks->p50) : "-";
  });
  return tableOfAll(section, {peak("p50 ms", &CostPeaks::p50), peak("p95 ms", &CostPeaks::p95),
                              peak("p99 ms", &CostPeaks::p99), peak("worst ms", &CostPeaks::worst), ratio});
}

bool hasPeaks(const Section& section) {
  return std::ranges::any_of(section.sequences, [](const Sequence& sequence) {
    return sequence.front()->cost && sequence.front()->cost->peaks;
  });
}

std::string counterText(const Sequence& sequence, const std::string& counter) {
  return countText(meanCounter(sequence, counter));
}

std::string mebibytesText(const Sequence& sequence, const std::string& counter) {
  constexpr double kBytesPerMebibyte = 1024.0 * 1024.0;
  return formatSignificant(meanCounter(sequence, counter) / kBytesPerMebibyte);
}

// Most scenes have no coats, and no mirrors, without a probe of their own.
bool hasWithoutProbe(const Section& section, const std::string& what) {
  return std::ranges::any_of(section.sequences, [&](const Sequence& sequence) {
    return meanCounter(sequence, what + "_from_probe") > 0 || meanCounter(sequence, what + "_from_environment") > 0;
  });
}

Table workTable(const Section& section) {
  const auto counter = [](const char* title, const char* name) {
    return Quantity{{title}, [=](const Sequence& sequence) { return counterText(sequence, name); }};
  };
  std::vector<Quantity> quantities = {
      {{"probe MiB"}, [](const Sequence& sequence) { return mebibytesText(sequence, "probe_bytes"); }},
      counter("faces captured", "faces_captured"),
      counter("draws", "draws"),
      counter("triangles", "triangles"),
      counter("fragments", "fragments"),
      counter("texels filtered", "texels_filtered")};
  if (hasWithoutProbe(section, "coats")) {
    quantities.push_back(counter("coats from a probe", "coats_from_probe"));
    quantities.push_back(counter("from the environment", "coats_from_environment"));
  }
  if (hasWithoutProbe(section, "mirrors")) {
    quantities.push_back(counter("mirrors from another's probe", "mirrors_from_probe"));
    quantities.push_back(counter("from the environment", "mirrors_from_environment"));
  }
  return tableOfAll(section, quantities);
}
}  // namespace

std::string costsText(const Section& section) {
  if (!hasCost(section)) return {};
  std::string text = "### All costs\n\n" + toMarkdown(costTable(section)) + '\n';
  if (hasPeaks(section))
    text += "### Peaks of the frame time\n\nover the single frames of all repetitions\n\n" +
            toMarkdown(peakTable(section)) + '\n';
  return text;
}

std::string workText(const Section& section) {
  return "### Work per frame\n\n" + toMarkdown(workTable(section)) + '\n';
}

}  // namespace pb
