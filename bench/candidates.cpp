#include "bench/candidates.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <set>

#include "bench/regex.h"
#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr char kPresetAxis[] = "preset";
constexpr char kNoPreset[] = "none";

// The numbers that results hold of single objects and materials.
constexpr std::pair<const char*, double RegionErrors::*> kRegionMetrics[] = {{"mse", &RegionErrors::mse},
                                                                             {"relmse", &RegionErrors::relmse},
                                                                             {"bias", &RegionErrors::bias},
                                                                             {"flip_hdr", &RegionErrors::flipHdr}};

double valueIn(const RegionErrors& errors, const std::string& metric) {
  for (const auto& [key, member] : kRegionMetrics)
    if (metric == key) return errors.*member;
  throwInputError("of single objects there are mse, relmse, bias and flip_hdr, got '{}'", metric);
}

// Several parts may have one name: mean over their pixels.
template <class Part>
std::optional<double> errorOf(const std::vector<Part>& parts, std::string Part::*name, const Selection& selection) {
  double sum = 0;
  double pixels = 0;
  for (const Part& part : parts) {
    if (part.*name != selection.object) continue;
    sum += static_cast<double>(part.pixels) * valueIn(part, selection.metric);
    pixels += static_cast<double>(part.pixels);
  }
  return pixels > 0 ? std::optional(sum / pixels) : std::nullopt;
}

std::optional<double> errorOfObject(const CellResult& cell, const Selection& selection) {
  if (const auto error = errorOf(cell.objects, &ObjectError::object, selection)) return error;
  return errorOf(cell.materials, &MaterialError::material, selection);
}

std::vector<Section> chosenSections(const Results& results, const std::string& pattern) {
  std::vector<Section> sections = sectionsOf(results.cells);
  std::erase_if(sections, [](const Section& section) { return section.sequences.empty(); });
  const std::regex regex = compileRegex(pattern, "--scene");
  std::vector<std::string> names;
  for (const Section& section : sections) names.push_back(section.sequences.front().front()->scene);
  std::erase_if(sections, [&](const Section& section) {
    return !std::regex_search(section.sequences.front().front()->scene, regex);
  });
  if (sections.empty() && !names.empty()) throwInputError("--scene {}", unknownMessage(pattern, names));
  if (sections.empty()) throwInputError("the run has no cells of its own techniques");
  return sections;
}

void requireObject(const std::vector<Section>& sections, const std::string& object) {
  std::set<std::string> names;
  for (const Section& section : sections)
    for (const Sequence& sequence : section.sequences)
      for (const CellResult* cell : sequence) {
        for (const ObjectError& error : cell->objects) names.insert(error.object);
        for (const MaterialError& error : cell->materials) names.insert(error.material);
      }
  if (names.contains(object)) return;
  throwInputError("object {}", unknownMessage(object, std::vector(names.begin(), names.end())));
}

struct SequenceLoss {
  Estimate loss;
  int worstFrame = 0;
  Sequence frames{};  // that it is of
};

// Over the frames.
std::optional<SequenceLoss> sequenceLoss(const Sequence& sequence, const Selection& selection, Region region) {
  std::vector<Estimate> losses;
  Sequence frames;
  std::optional<SequenceLoss> worst;
  for (const CellResult* cell : sequence) {
    const std::optional<Estimate> loss = lossOf(*cell, selection, region);
    if (!loss) continue;
    if (!worst || loss->value > worst->loss.value) worst = {*loss, cell->frame, {cell}};
    losses.push_back(*loss);
    frames.push_back(cell);
  }
  if (!worst) return std::nullopt;
  const Estimate mean = meanOverFrames(losses);
  if (!selection.worstFrame) return SequenceLoss{mean, worst->worstFrame, frames};
  if (worst->loss.isKnown()) return worst;
  const double value = worst->loss.value;
  worst->loss = {value, value - (mean.value - mean.low), value + (mean.high - mean.value)};
  return worst;
}

void takeLarger(std::optional<Estimate>& largest, const Estimate& other) {
  if (!largest || other.value > largest->value) largest = other;
}

// Takes the scene's numbers in where they are the worst so far; false if the error is undefined there.
bool addScene(Candidate& candidate, const Sequence& sequence, const Selection& selection, Region region) {
  const std::optional<SequenceLoss> found = sequenceLoss(sequence, selection, region);
  if (!found) return false;
  if (candidate.worstCells.empty() || found->loss.value > candidate.loss.value) {
    candidate.loss = found->loss;
    candidate.worstFrame = found->worstFrame;
    candidate.region = region;
    candidate.worstScene = sequence.front()->scene;
    candidate.worstCells = sequence;
    candidate.clearOfFloor = isClearOfFloor(found->frames, region);
  }
  if (const std::optional<CostResult>& cost = sequence.front()->cost) {
    takeLarger(candidate.ratio, {cost->ratio, cost->ratioLow, cost->ratioHigh});
    takeLarger(candidate.frameMs, {cost->frameMs, cost->frameMsLow, cost->frameMsHigh});
  }
  candidate.probeBytes = std::fmax(candidate.probeBytes, meanCounter(sequence, "probe_bytes"));
  return true;
}

std::vector<VaryingAxis> varyingAxes(const std::vector<Candidate>& candidates) {
  std::vector<VaryingAxis> axes;
  for (const Candidate& candidate : candidates)
    for (const auto& [name, value] : candidate.technique) {
      auto axis = std::ranges::find(axes, name, &VaryingAxis::name);
      if (axis == axes.end()) axis = axes.insert(axes.end(), VaryingAxis{name, {}});
      if (std::ranges::find(axis->values, value) == axis->values.end()) axis->values.push_back(value);
    }
  std::erase_if(axes, [](const VaryingAxis& axis) { return axis.values.size() < 2; });
  return axes;
}

AxisValues commonValues(const std::vector<Candidate>& candidates, const std::vector<VaryingAxis>& axes) {
  AxisValues common;
  if (axes.size() < 2) return common;  // its values are short enough
  for (const VaryingAxis& axis : axes)
    for (const std::string& value : axis.values) {
      const std::pair setting(axis.name, value);
      const auto having = std::ranges::count_if(candidates, [&](const Candidate& candidate) {
        return std::ranges::find(candidate.technique, setting) != candidate.technique.end();
      });
      if (2 * having > std::ssize(candidates)) common.push_back(setting);
    }
  return common;
}

}  // namespace

Estimate meanOverFrames(const std::vector<Estimate>& frames) {
  assert(!frames.empty());
  double sum = 0, below = 0, above = 0, known = 0;
  for (const Estimate& estimate : frames) {
    sum += estimate.value;
    if (!estimate.isKnown()) continue;
    below += estimate.value - estimate.low;
    above += estimate.high - estimate.value;
    ++known;
  }
  const double value = sum / static_cast<double>(frames.size());
  return known > 0 ? Estimate{value, value - below / known, value + above / known} : Estimate::unknown(value);
}

double lossOf(const std::string& metric, double value) {
  if (metric == "bias") return std::abs(value);
  return isLowerBetter(metric) ? value : -value;
}

double metricOfLoss(const std::string& metric, double loss) { return isLowerBetter(metric) ? loss : -loss; }

std::optional<Estimate> lossOf(const CellResult& cell, const Selection& selection, Region region) {
  const std::optional<double> value =
      selection.object.empty() ? errorOf(cell, region, selection.metric) : errorOfObject(cell, selection);
  if (!value || std::isnan(*value)) return std::nullopt;
  const double loss = lossOf(selection.metric, *value);
  const bool isObject = !selection.object.empty();  // it may lie outside the mask
  const bool isExact = isFreeOfNoise(cell, isObject ? Region::whole : region);
  const MetricIntervals& intervals = region == Region::mask ? cell.maskIntervals : cell.intervals;
  const auto known = std::ranges::find(intervals, selection.metric, &MetricIntervals::value_type::first);
  if (known == intervals.end() || isObject) return isExact ? Estimate::exact(loss) : Estimate::unknown(loss);
  const double a = lossOf(selection.metric, known->second.low), b = lossOf(selection.metric, known->second.high);
  return Estimate{loss, std::min({a, b, loss}), std::max({a, b, loss})};
}

CandidateSet candidatesOf(const Results& results, const Selection& selection) {
  metricValue({}, selection.metric);  // refuses an unknown one
  const std::vector<Section> sections = chosenSections(results, selection.scenes);
  if (!selection.object.empty()) requireObject(sections, selection.object);
  return candidatesOf(sections, selection);
}

CandidateSet candidatesOf(const std::vector<Section>& sections, const Selection& selection) {
  CandidateSet set;
  set.selection = selection;
  std::map<AxisValues, std::size_t> places;            // of techniques in `all`
  std::vector<std::pair<Candidate, std::size_t>> all;  // with the number of scenes
  std::size_t scenes = 0;
  for (const Section& section : sections) {
    const Region region = selection.region.value_or(section.region);
    bool seen = false;
    for (const Sequence& sequence : section.sequences) {
      const auto [place, isNew] = places.try_emplace(sequence.front()->technique, all.size());
      if (isNew) all.emplace_back().first.technique = sequence.front()->technique;
      auto& [candidate, count] = all[place->second];
      if (!addScene(candidate, sequence, selection, region)) continue;
      ++count;
      seen = true;
    }
    if (!seen) continue;  // shows the object nowhere, or the metric is undefined on all of it
    ++scenes;
    set.scenes.push_back(section.sequences.front().front()->scene);
    set.onMask = set.onMask || (region == Region::mask && selection.object.empty());
  }
  for (auto& [candidate, count] : all)
    if (count == scenes && scenes > 0)
      set.candidates.push_back(std::move(candidate));
    else
      ++set.elsewhere;
  set.axes = varyingAxes(set.candidates);
  set.common = commonValues(set.candidates, set.axes);
  return set;
}

std::string techniqueText(const AxisValues& technique, const CandidateSet& set) {
  std::string text;
  for (const auto& setting : technique) {
    if (std::ranges::find(set.axes, setting.first, &VaryingAxis::name) == set.axes.end()) continue;
    if (setting.first == kPresetAxis && setting.second != kNoPreset) return setting.first + '=' + setting.second;
    if (std::ranges::find(set.common, setting) != set.common.end()) continue;
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", setting.first, setting.second);
  }
  if (!text.empty()) return text;
  for (const auto& [axis, value] : technique)
    if (axis == kExternalAxis) return fmt::format("{}={}", axis, value);
  return set.axes.empty() ? "the only technique" : "the base technique";
}

}  // namespace pb
