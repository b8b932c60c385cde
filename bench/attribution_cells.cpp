#include "bench/attribution_cells.h"

#include <algorithm>
#include <map>
#include <regex>

#include "bench/axes.h"
#include "scenes/error.h"

namespace pb {
namespace {

std::size_t differingAxes(const Technique& a, const Technique& b) {
  const AxisValues valuesA = describe(a), valuesB = describe(b);
  std::size_t count = 0;
  for (std::size_t i = 0; i < valuesA.size(); ++i) count += valuesA[i] != valuesB[i] ? 1 : 0;
  return count;
}

// Those that are measured, of which every or the last one is wanted.
std::vector<int> wantedFrames(const Suite& suite, const PlannedSequence& sequence) {
  if (suite.attribution->everyFrame) return sequence.frames;
  return {sequence.frames.back()};
}

std::vector<int> matchingFrames(const Suite& suite, const PlannedSequence& sequence, const std::regex& expression) {
  std::vector<int> frames = wantedFrames(suite, sequence);
  std::erase_if(frames,
                [&](int frame) { return !std::regex_search(makeCell(suite, sequence, frame).key(), expression); });
  return frames;
}

// Of each scene the sequence that is nearest to the suite's base technique, the first of several.
void chooseNearest(const Suite& suite, std::vector<PlannedSequence>& sequences) {
  std::map<std::size_t, std::pair<std::size_t, PlannedSequence*>> nearest;  // by scene, with the axes that differ
  for (PlannedSequence& sequence : sequences) {
    if (sequence.external) continue;
    const std::size_t axes = differingAxes(sequence.technique, suite.technique);
    const auto [found, isNew] = nearest.try_emplace(sequence.scene, axes, &sequence);
    if (!isNew && axes < found->second.first) found->second = {axes, &sequence};
  }
  for (const auto& [scene, chosen] : nearest) chosen.second->attributedFrames = wantedFrames(suite, *chosen.second);
}

}  // namespace

void requireAttributedCells(const Suite& suite, const std::vector<PlannedSequence>& sequences) {
  if (!suite.attribution || !suite.attribution->cells) return;
  const std::regex expression(*suite.attribution->cells);
  const bool any = std::ranges::any_of(
      sequences, [&](const PlannedSequence& sequence) { return !matchingFrames(suite, sequence, expression).empty(); });
  if (!any)
    throwInputError("'cells' of 'attribution', '{}', matches no cell of suite '{}'{}", *suite.attribution->cells,
                    suite.name, suite.attribution->everyFrame ? "" : " at the last frame of a sequence");
}

void chooseAttributedCells(const Suite& suite, std::vector<PlannedSequence>& sequences) {
  if (!suite.attribution) return;
  if (!suite.attribution->cells) return chooseNearest(suite, sequences);
  const std::regex expression(*suite.attribution->cells);
  for (PlannedSequence& sequence : sequences) sequence.attributedFrames = matchingFrames(suite, sequence, expression);
}

}  // namespace pb
