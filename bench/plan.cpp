#include "bench/plan.h"

#include <algorithm>
#include <set>

#include "bench/attribution_cells.h"
#include "bench/axes.h"
#include "bench/counted.h"
#include "bench/regex.h"
#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr std::size_t kMaxSequences = 100'000;

std::vector<Technique> expandGrid(const Suite& suite) {
  std::vector<Technique> techniques{suite.technique};
  for (const auto& [axis, values] : suite.grid) {
    std::vector<Technique> expanded;
    for (const Technique& base : techniques)
      for (const std::string& value : values) {
        expanded.push_back(base);
        setAxis(expanded.back(), axis, value);
      }
    if (expanded.size() * suite.scenes.size() > kMaxSequences)
      throwInputError("a grid may have at most {} techniques times scenes, got more at axis '{}'", kMaxSequences, axis);
    techniques = std::move(expanded);
  }
  return techniques;
}

void addDistinct(std::vector<Technique>& techniques, const Technique& technique) {
  if (std::ranges::find(techniques, technique) == techniques.end()) techniques.push_back(technique);
}

// The grid's techniques, and on top of each of them what the scene varies, one value at a time. What varies to what was
// there is left out.
std::vector<Technique> techniquesOf(const SuiteScene& scene, const std::vector<Technique>& grid) {
  std::vector<Technique> techniques = grid;
  for (const Variation& variation : scene.vary) {
    std::vector<Technique> bases = grid;
    for (Technique& base : bases) {
      for (const auto& [axis, value] : variation.on) setAxis(base, axis, value);
      addDistinct(techniques, base);
    }
    for (const auto& [axis, values] : variation.values)
      for (const std::string& value : values)
        for (Technique varied : bases) {
          setAxis(varied, axis, value);
          addDistinct(techniques, varied);
        }
  }
  return techniques;
}

// Cells are told apart by their keys.
void requireDistinct(const Suite& suite, const std::vector<PlannedSequence>& sequences) {
  std::set<std::string> keys;
  for (const PlannedSequence& sequence : sequences)
    if (const std::string key = makeCell(suite, sequence, 0).sequenceKey(); !keys.insert(key).second)
      throwInputError("a scene or an axis value may be given once, suite '{}' comes to '{}' twice", suite.name,
                      shortKey(key, describe(Technique())));
}

void keepOnly(const Suite& suite, const std::string& expression, std::vector<PlannedSequence>& sequences) {
  const std::regex regex = compileRegex(expression, "--only");
  for (PlannedSequence& sequence : sequences)
    std::erase_if(sequence.frames,
                  [&](int frame) { return !std::regex_search(makeCell(suite, sequence, frame).key(), regex); });
  std::erase_if(sequences, [](const PlannedSequence& sequence) { return sequence.frames.empty(); });
  if (sequences.empty()) throwInputError("--only '{}' matches no cell of suite '{}'", expression, suite.name);
}

void keepShard(const Shard& shard, std::vector<PlannedSequence>& sequences) {
  const auto boundary = [&](int part) { return static_cast<std::ptrdiff_t>(sequences.size()) * part / shard.count; };
  sequences = std::vector(sequences.begin() + boundary(shard.index - 1), sequences.begin() + boundary(shard.index));
  if (sequences.empty()) throwInputError("shard {}/{} is empty, use fewer shards", shard.index, shard.count);
}

}  // namespace

std::size_t Plan::cellCount() const {
  std::size_t count = 0;
  for (const PlannedSequence& sequence : sequences) count += sequence.frames.size();
  return count;
}

std::vector<int> Plan::framesOf(std::size_t scene) const {
  std::set<int> frames;
  for (const PlannedSequence& sequence : sequences)
    if (sequence.scene == scene) frames.insert(sequence.frames.begin(), sequence.frames.end());
  return {frames.begin(), frames.end()};
}

Shard parseShard(std::string_view text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const std::optional<long long> index = parseInteger(text.substr(0, slash));
  const std::optional<long long> count = parseInteger(text.substr(std::min(slash + 1, text.size())));
  if (!index || !count || *index < 1 || *count < *index || *count > static_cast<long long>(kMaxSequences))
    throwInputError("--shard wants I/N with 1 <= I <= N, got '{}'", text);
  return {static_cast<int>(*index), static_cast<int>(*count)};
}

Plan makePlan(const Suite& suite, const PlanFilter& filter) {
  const std::vector<Technique> grid = expandGrid(suite);
  Plan plan;
  for (std::size_t scene = 0; scene < suite.scenes.size(); ++scene) {
    for (const Technique& technique : techniquesOf(suite.scenes[scene], grid))
      plan.sequences.push_back({scene, technique, suite.scenes[scene].frames});
    for (std::size_t external = 0; external < suite.externals.size(); ++external)
      plan.sequences.push_back({scene, suite.technique, suite.scenes[scene].frames, external});
  }
  requireDistinct(suite, plan.sequences);
  requireAttributedCells(suite, plan.sequences);
  if (filter.only) keepOnly(suite, *filter.only, plan.sequences);
  chooseAttributedCells(suite, plan.sequences);  // of what is left, and for all shards alike
  keepShard(filter.shard, plan.sequences);
  return plan;
}

CellResult makeCell(const Suite& suite, const PlannedSequence& sequence, int frame) {
  CellResult cell;
  cell.scene = suite.scenes[sequence.scene].name;
  cell.camera = suite.scenes[sequence.scene].camera;
  cell.frame = frame;
  // What an external program does is known by its name only.
  if (sequence.external)
    cell.technique = {{kExternalAxis, suite.externals[*sequence.external].name}};
  else
    cell.technique = describe(sequence.technique);
  return cell;
}

std::string printPlan(const Suite& suite, const Plan& plan) {
  std::string text = fmt::format("suite {}: {}x{}, {} samples a pixel\n", suite.name, suite.image.widthPx,
                                 suite.image.heightPx, suite.image.samplesPerAxis * suite.image.samplesPerAxis);
  for (const auto& [axis, values] : suite.grid) text += fmt::format("  {}: {}\n", axis, fmt::join(values, ", "));
  std::size_t references = 0;
  for (std::size_t scene = 0; scene < suite.scenes.size(); ++scene) {
    const std::size_t frames = plan.framesOf(scene).size();
    references += frames;
    const auto sequences = std::ranges::count(plan.sequences, scene, &PlannedSequence::scene);
    text += fmt::format("  {}: {}, {}\n", suite.scenes[scene].name,
                        counted(static_cast<std::size_t>(sequences), "sequence"), counted(frames, "measured frame"));
  }
  const auto isExternal = [](const PlannedSequence& sequence) { return sequence.external.has_value(); };
  const auto externals = static_cast<std::size_t>(std::ranges::count_if(plan.sequences, isExternal));
  const std::size_t rasters = plan.sequences.size() - externals;
  const std::string external = externals > 0 ? " and " + counted(externals, "external one") : "";
  const auto repetitions = static_cast<std::size_t>(suite.cost.repetitions);
  text += fmt::format("{} in {}{}, {}, {} of {}\n", counted(plan.cellCount(), "cell"),
                      counted(rasters, "raster sequence"), external, counted(references, "reference"),
                      counted(repetitions > 0 ? rasters : 0, "cost measurement"), counted(repetitions, "repetition"));
  std::size_t attributed = 0;
  for (const PlannedSequence& sequence : plan.sequences) attributed += sequence.attributedFrames.size();
  if (attributed > 0) text += fmt::format("attribution of {}\n", counted(attributed, "cell"));
  return text;
}

}  // namespace pb
