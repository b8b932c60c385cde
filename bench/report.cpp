#include "bench/report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <system_error>

#include "bench/attribution_table.h"
#include "bench/metric_audit.h"
#include "bench/recommend.h"
#include "bench/sections.h"
#include "bench/tables.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr char kNotClearMark[] = " ~";

// Perceptual, and defined for scene-referred images: the error that the tables of one question show.
constexpr char kMainMetric[] = "flip_hdr";

// --- Cells of tables

const std::optional<CostResult>& costOf(const Sequence& sequence) { return sequence.front()->cost; }

bool hasCost(const Section& section) {
  return std::ranges::any_of(section.sequences, [](const Sequence& sequence) { return costOf(sequence).has_value(); });
}

std::string meanErrorText(const Sequence& sequence, Region region, const std::string& metric) {
  return formatSignificant(meanError(sequence, region, metric)) +
         (isClearOfFloor(sequence, region) ? "" : kNotClearMark);
}

std::string worstErrorText(const Sequence& sequence, Region region, const std::string& metric) {
  return formatSignificant(largestError(sequence, region, metric));
}

std::string intervalText(double low, double high) {
  return fmt::format("{}..{}", formatSignificant(low), formatSignificant(high));
}

std::string captureText(const std::vector<double>& captureMs) {
  std::vector<std::string> texts;
  for (const double ms : captureMs) texts.push_back(formatSignificant(ms));
  return fmt::format("{}", fmt::join(texts, " + "));
}

// Means over the frames: whole numbers where every frame does the same.
std::string countText(double mean) {
  if (std::isnan(mean)) return formatSignificant(mean);
  return mean == std::trunc(mean) ? fmt::format("{:.0f}", mean) : fmt::format("{:.1f}", mean);
}

std::string counterText(const Sequence& sequence, const std::string& counter) {
  return countText(meanCounter(sequence, counter));
}

std::string mebibytesText(const Sequence& sequence, const std::string& counter) {
  constexpr double kBytesPerMebibyte = 1024.0 * 1024.0;
  return formatSignificant(meanCounter(sequence, counter) / kBytesPerMebibyte);
}

// --- Tables of everything: one row a technique

// A column of such a table and how to fill it.
struct Quantity {
  Column column;
  std::function<std::string(const Sequence&)> text;
};

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

Quantity errorQuantity(const std::string& title, Region region, const std::string& metric) {
  return {{title}, [=](const Sequence& sequence) { return meanErrorText(sequence, region, metric); }};
}

Quantity worstQuantity(Region region, const std::string& metric) {
  return {{"worst"}, [=](const Sequence& sequence) { return worstErrorText(sequence, region, metric); }};
}

void addErrors(std::vector<Quantity>& quantities, const Section& section, Region region) {
  const char* place = region == Region::mask ? "mask" : "whole";
  for (const auto& [metric, name] : {std::pair{kMainMetric, "FLIP-HDR"}, std::pair{"relmse", "relMSE"}}) {
    quantities.push_back(errorQuantity(fmt::format("{} {}", name, place), region, metric));
    if (section.severalFrames) quantities.push_back(worstQuantity(region, metric));
  }
}

Table errorTable(const Section& section) {
  std::vector<Quantity> quantities;
  if (section.region == Region::mask) addErrors(quantities, section, Region::mask);
  addErrors(quantities, section, Region::whole);
  quantities.push_back(
      {{"face age"}, [](const Sequence& sequence) { return formatSignificant(meanFaceAge(sequence)); }});
  quantities.push_back(
      {{"oldest face"}, [](const Sequence& sequence) { return formatSignificant(largestFaceAge(sequence)); }});
  return tableOfAll(section, quantities);
}

// A quantity of the measured cost, "-" where none was measured.
Quantity costQuantity(const std::string& title, std::function<std::string(const CostResult&)> text) {
  return {{title}, [=](const Sequence& sequence) { return costOf(sequence) ? text(*costOf(sequence)) : "-"; }};
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

// The technique of smallest error, by the metric and region of the tables above.
const Sequence& bestOf(const Section& section) {
  return *std::ranges::min_element(section.sequences, [&](const Sequence& a, const Sequence& b) {
    return meanError(a, section.region, kMainMetric) < meanError(b, section.region, kMainMetric);
  });
}

// The last frame's, largest share first.
Table materialTable(const Sequence& sequence) {
  std::vector<MaterialError> materials = sequence.back()->materials;
  std::ranges::stable_sort(materials, std::greater(), &MaterialError::share);
  Table table{{{"material", Align::left}, {"pixels"}, {"share of squared error"}, {"FLIP-HDR"}, {"relMSE"}, {"bias"}},
              {}};
  for (const MaterialError& e : materials)
    table.rows.push_back({e.material, fmt::format("{}", e.pixels), fmt::format("{:.1f} %", 100.0 * e.share),
                          formatSignificant(e.flipHdr), formatSignificant(e.relmse), formatSignificant(e.bias)});
  return table;
}

std::string materialText(const Section& section) {
  const Sequence& best = bestOf(section);
  if (best.back()->materials.empty()) return {};
  std::string technique;
  for (const VaryingAxis& axis : section.axes)
    technique += fmt::format(", {}={}", axis.name, axisValue(best, axis.name));
  return fmt::format("### Errors by material\n\nframe {}, technique of the smallest error{}\n\n{}\n",
                     best.back()->frame, technique, toMarkdown(materialTable(best)));
}

// --- External techniques: known by name, with times of their own clocks

// A quantity of the times that the program states, "-" where it states none.
Quantity reportedQuantity(const std::string& title, std::function<std::string(const ReportedCost&)> text) {
  return {{title}, [=](const Sequence& sequence) {
            const std::optional<ReportedCost>& cost = sequence.front()->reportedCost;
            return cost ? text(*cost) : "-";
          }};
}

std::string orDash(const std::optional<double>& value) { return value ? formatSignificant(*value) : "-"; }

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

// --- Tables of one question: rows are one axis, columns another, the rest is fixed

// Where an axis stands while others are varied: at its largest number, or else at its first value.
std::string standingValue(const VaryingAxis& axis) {
  const auto number = [](const std::string& value) { return parseNumber(value); };
  if (!std::ranges::all_of(axis.values, [&](const std::string& value) { return number(value).has_value(); }))
    return axis.values.front();
  return *std::ranges::max_element(axis.values, {}, number);
}

using Assignment = std::map<std::string, std::string>;  // axis -> value

std::string textAt(const Section& section, const Assignment& place, const Quantity& quantity) {
  const auto matches = [&](const Sequence& sequence) {
    return std::ranges::all_of(place,
                               [&](const auto& entry) { return axisValue(sequence, entry.first) == entry.second; });
  };
  const auto found = std::ranges::find_if(section.sequences, matches);
  return found == section.sequences.end() ? "-" : quantity.text(*found);
}

struct Question {
  const VaryingAxis& rows;
  const VaryingAxis* columns;  // null if only one axis varies
  Assignment fixed;
};

Question questionAbout(const Section& section, std::size_t axis) {
  Question question{section.axes[axis], nullptr, {}};
  if (section.axes.size() > 1) question.columns = &section.axes[(axis + 1) % section.axes.size()];
  for (const VaryingAxis& other : section.axes)
    if (&other != &question.rows && &other != question.columns) question.fixed[other.name] = standingValue(other);
  return question;
}

Table questionTable(const Section& section, const Question& question, const Quantity& quantity) {
  const VaryingAxis single{"", {quantity.column.title}};
  const VaryingAxis& columns = question.columns ? *question.columns : single;
  Table table{{{question.rows.name, Align::left}}, {}};
  for (const std::string& value : columns.values)
    table.columns.push_back({question.columns ? fmt::format("{}={}", columns.name, value) : value});
  for (const std::string& value : question.rows.values) {
    std::vector<std::string>& row = table.rows.emplace_back(1, value);
    Assignment place = question.fixed;
    place[question.rows.name] = value;
    for (const std::string& columnValue : columns.values) {
      if (question.columns) place[columns.name] = columnValue;
      row.push_back(textAt(section, place, quantity));
    }
  }
  return table;
}

std::string fixedText(const Assignment& fixed) {
  std::string text;
  for (const auto& [axis, value] : fixed) text += fmt::format(", {}={}", axis, value);
  return text;
}

Quantity mainError(const Section& section) {
  const Region region = section.region;
  const bool severalFrames = section.severalFrames;
  const std::string title = fmt::format("FLIP-HDR on the {}{}", region == Region::mask ? "mask" : "whole image",
                                        severalFrames ? ", mean over the frames (worst frame)" : "");
  return {{title}, [=](const Sequence& sequence) {
            const std::string mean = meanErrorText(sequence, region, kMainMetric);
            return severalFrames ? fmt::format("{} ({})", mean, worstErrorText(sequence, region, kMainMetric)) : mean;
          }};
}

Quantity mainCost() {
  Quantity quantity = costQuantity("", [](const CostResult& cost) { return formatSignificant(cost.ratio); });
  quantity.column.title = "frame time as a multiple of a plain frame";
  return quantity;
}

std::string questionsText(const Section& section) {
  const Quantity error = mainError(section), cost = mainCost();
  std::string text;
  for (std::size_t i = 0; i < section.axes.size(); ++i) {
    const Question question = questionAbout(section, i);
    const auto add = [&](const char* what, const Quantity& quantity) {
      text += fmt::format("### {} versus {}\n\n{}{}\n\n{}\n", what, question.rows.name, quantity.column.title,
                          fixedText(question.fixed), toMarkdown(questionTable(section, question, quantity)));
    };
    add("Error", error);
    if (hasCost(section)) add("Cost", cost);
  }
  return text;
}

// --- The report

std::string framesText(const Section& section) {
  std::vector<int> frames;
  for (const std::vector<Sequence>* sequences : {&section.sequences, &section.externals})
    for (const Sequence& sequence : *sequences)
      for (const CellResult* cell : sequence) frames.push_back(cell->frame);
  std::ranges::sort(frames);
  frames.erase(std::ranges::unique(frames).begin(), frames.end());
  return fmt::format("{} {}", frames.size() > 1 ? "frames" : "frame", fmt::join(frames, " "));
}

// "axis=value" of the program's own axes that stand at one value in the whole run.
std::vector<std::string> sharedAxes(const std::vector<Section>& sections) {
  std::optional<std::vector<std::string>> shared;
  for (const Section& section : sections) {
    if (section.sequences.empty()) continue;
    if (!shared) shared = section.fixed;
    std::erase_if(*shared, [&](const std::string& axis) {
      return std::ranges::find(section.fixed, axis) == section.fixed.end();
    });
  }
  return shared.value_or(std::vector<std::string>{});
}

std::string sectionText(const Section& section, const std::vector<std::string>& shared) {
  const bool hasOwn = !section.sequences.empty();
  const CellResult& first = *(hasOwn ? section.sequences : section.externals).front().front();
  std::string text = fmt::format("## {}{}\n\n{}", first.scene, first.camera.empty() ? "" : ", camera " + first.camera,
                                 framesText(section));
  std::vector<std::string> fixed = section.fixed;
  std::erase_if(fixed, [&](const std::string& axis) { return std::ranges::find(shared, axis) != shared.end(); });
  if (!fixed.empty()) text += fmt::format("; {}", fmt::join(fixed, ", "));
  text += "\n\n";
  if (!hasOwn) return text + externalText(section);
  text += questionsText(section);
  text += "### All errors\n\n" + toMarkdown(errorTable(section)) + '\n';
  text += materialText(section);
  if (hasCost(section)) text += "### All costs\n\n" + toMarkdown(costTable(section)) + '\n';
  text += externalText(section);
  text += "### Work per frame\n\n" + toMarkdown(workTable(section)) + '\n';
  return text;
}

constexpr char kLegend[] =
    "Errors are against the reference; `mask` is the pixels of reflective and refractive objects. `~` marks cells that "
    "are not clear of the reference's own noise (relMSE below 10 times its floor). Costs are medians with their 95 % "
    "interval, of frames with one sample a pixel; `x plain` is relative to a frame of the same scene and size without "
    "captures; times by pass come from frames that were taken apart, which costs some of their overlap. A render is "
    "one view of "
    "the scene, a cube face or the final image; N probes, B bounce iterations. Face age counts frames since the "
    "capture, in the mean over all faces and of the oldest one.\n\n";

void appendAll(Table& table, const std::string& prefix, const auto& pairs) {
  for (const auto& [name, value] : pairs) table.rows.push_back({prefix + name, value});
}

std::string circumstances(const Provenance& p) {
  Table table{{{"circumstance", Align::left}, {"value", Align::left}}, {}};
  const std::pair<std::string, std::string> fixed[] = {
      {"probebench", fmt::format("{} ({})", p.toolVersion, p.gitHash)},
      {"suite", fmt::format("{} ({})", p.suiteName, p.suiteHash)},
      {"started", p.startedAt},
      {"control", p.controlOutcome},
      {"seed", fmt::format("{}", p.seed)},
      {"CPU", fmt::format("{}, {} threads", p.cpu, p.threads)},
      {"GL", fmt::format("{}: {}, {}", p.glBackend, p.glRenderer, p.glVersion)},
  };
  appendAll(table, "", fixed);
  appendAll(table, "", p.settings);
  appendAll(table, "scene ", p.sceneHashes);
  appendAll(table, "", p.libraries);
  return "## Circumstances\n\n" + toMarkdown(table);
}

// What is fixed in the whole run, in words short enough to be read.
std::string fixedText(std::vector<std::string> shared, const AxisValues& defaults) {
  const std::size_t all = shared.size();
  std::erase_if(shared, [&](const std::string& setting) {
    return std::ranges::any_of(defaults, [&](const auto& d) { return setting == d.first + "=" + d.second; });
  });
  if (all == 0) return "";
  const bool hasOthers = shared.size() < all;
  if (shared.empty()) return "Axes that don't vary stand at their defaults.\n\n";
  return fmt::format("Fixed in the whole run: {}{}.\n\n", fmt::join(shared, ", "),
                     hasOthers ? "; other axes that don't vary stand at their defaults" : "");
}

std::string answerText(const Results& results, const AxisValues& defaults) {
  const std::vector<std::string> lines = summaryLines(results, {.defaults = defaults});
  return lines.empty() ? "" : fmt::format("- {}\n\n", fmt::join(lines, "\n- "));
}

}  // namespace

std::string makeReport(const Results& results, const AxisValues& defaults) {
  const std::vector<Section> sections = sectionsOf(results.cells);
  std::string text = fmt::format("# {}: error and cost of reflection probes\n\n{} cells, control {}.\n\n",
                                 results.provenance.suiteName, results.cells.size(), results.provenance.controlOutcome);
  text += answerText(results, defaults) + kLegend;
  const std::vector<std::string> shared = sharedAxes(sections);
  text += fixedText(shared, defaults);
  for (const Section& section : sections) text += sectionText(section, shared);
  text += attributionTables(results.attribution, defaults);
  text += metricAuditText(auditMetrics(results.cells));
  return text + circumstances(results.provenance);
}

void makeReportFolder(const std::string& directory) {
  std::error_code failure;
  std::filesystem::create_directories(directory, failure);
  if (failure) throwEnvironmentError("can't make directory '{}': {}", directory, failure.message());
}

void writeReport(const Results& results, const std::string& directory, const AxisValues& defaults) {
  makeReportFolder(directory);
  writeFileAtomically(directory + "/report.md", makeReport(results, defaults));
  writeFileAtomically(directory + "/report.csv", toCsv(results, defaults));
}

}  // namespace pb
