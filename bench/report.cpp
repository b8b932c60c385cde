#include "bench/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "bench/attribution_table.h"
#include "bench/metric_audit.h"
#include "bench/recommend.h"
#include "bench/report_parts.h"
#include "bench/sections.h"
#include "bench/tables.h"
#include "scenes/error.h"
#include "scenes/files.h"

namespace pb {
namespace {

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
  std::string text =
      fmt::format("## {}{}\n\n{}", escapeMarkdown(first.scene),
                  first.camera.empty() ? "" : ", camera " + escapeMarkdown(first.camera), framesText(section));
  std::vector<std::string> fixed = section.fixed;
  std::erase_if(fixed, [&](const std::string& axis) { return std::ranges::find(shared, axis) != shared.end(); });
  if (!fixed.empty()) text += fmt::format("; {}", fmt::join(fixed, ", "));
  text += "\n\n";
  if (!hasOwn) return text + externalText(section);
  return text + questionsText(section) + errorsText(section) + objectsText(section) + costsText(section) +
         externalText(section) + workText(section);
}

constexpr char kLegend[] =
    "Errors are against the reference; `mask` is the pixels of reflective and refractive objects. `~` marks cells that "
    "are not clear of the reference's own noise (relMSE below 10 times its floor). Against the best: by FLIP-HDR; "
    "equal where the difference of the two, which have the noise of one reference in common, is within its 95 % "
    "interval, below the floor where it is and neither error is clear of the noise. p95 is the value that "
    "95 % of the frames do not exceed. Costs are medians with their 95 % "
    "interval, of frames with one sample a pixel; `x plain` is relative to a frame of the same scene and size without "
    "captures; times by pass come from frames that were taken apart, which costs some of their overlap. A render is "
    "one view of the scene, a cube face or the final image; N probes, B bounce iterations. Face age counts frames "
    "since the "
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
  std::string text;
  for (const std::string& line : lines) text += fmt::format("- {}\n", escapeMarkdown(line));
  return lines.empty() ? "" : text + '\n';
}

}  // namespace

std::string makeReport(const Results& results, const AxisValues& defaults) {
  const std::vector<Section> sections = sectionsOf(results.cells);
  std::string text = fmt::format("# {}: error and cost of reflection probes\n\n{} cells, control {}.\n\n",
                                 escapeMarkdown(results.provenance.suiteName), results.cells.size(),
                                 results.provenance.controlOutcome);
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
