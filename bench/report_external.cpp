// External techniques: known by name, with times of their own clocks.
#include "bench/report_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace pb {
namespace {

// A quantity of the times that the program states, "-" where it states none.
Quantity reportedQuantity(const std::string& title, std::function<std::string(const ReportedCost&)> text) {
  return {{title}, [=](const Sequence& sequence) {
            const std::optional<ReportedCost>& cost = sequence.front()->reportedCost;
            return cost ? text(*cost) : "-";
          }};
}

std::string orDash(const std::optional<double>& value) { return value ? formatSignificant(*value) : "-"; }

}  // namespace

std::string externalText(const Section& section) {
  if (section.externals.empty()) return {};
  Section externals = section;
  externals.sequences = section.externals;
  externals.axes = {{kExternalAxis, {}}};
  std::vector<Quantity> quantities;
  if (section.region == Region::mask) addErrors(quantities, section, Region::mask);
  addErrors(quantities, section, Region::whole);
  std::string text = "### External techniques\n\n" + toMarkdown(tableOfAll(externals, quantities)) + '\n';
  const auto reports = [](const Sequence& sequence) { return sequence.front()->reportedCost.has_value(); };
  if (std::ranges::none_of(section.externals, reports)) return text;
  const Table times = tableOfAll(
      externals,
      {reportedQuantity("frame ms", [](const ReportedCost& c) { return formatSignificant(c.frameMs); }),
       reportedQuantity("95 %", [](const ReportedCost& c) { return intervalText(c.frameMsLow, c.frameMsHigh); }),
       reportedQuantity("frames", [](const ReportedCost& c) { return std::to_string(c.frames); }),
       reportedQuantity("plain ms", [](const ReportedCost& c) { return orDash(c.plainMs); }),
       reportedQuantity("x its plain", [](const ReportedCost& c) { return orDash(c.ratio()); }),
       reportedQuantity("measured with", [](const ReportedCost& c) { return c.program; })});
  return text + "Times as these programs report them, by their own clocks: not comparable with the costs above.\n\n" +
         toMarkdown(times) + '\n';
}

}  // namespace pb
