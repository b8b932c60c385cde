#include "bench/attribution_cells.h"

#include <algorithm>

#include "bench/axes.h"

namespace pb {
namespace {

std::size_t differingAxes(const Technique& a, const Technique& b) {
  const AxisValues valuesA = describe(a), valuesB = describe(b);
  std::size_t count = 0;
  for (std::size_t i = 0; i < valuesA.size(); ++i) count += valuesA[i] != valuesB[i] ? 1 : 0;
  return count;
}

// Of each scene the sequence that is nearest to the suite's base technique, the first of several. Shards of a run agree
// on it: it is chosen from the whole suite.
std::vector<PlannedSequence> baseSequences(const Suite& suite) {
  std::vector<PlannedSequence> nearest;
  std::size_t fewest = 0;
  for (const PlannedSequence& sequence : makePlan(suite).sequences) {
    if (sequence.external) continue;
    const std::size_t axes = differingAxes(sequence.technique, suite.technique);
    const bool isNewScene = nearest.empty() || nearest.back().scene != sequence.scene;
    if (isNewScene)
      nearest.push_back(sequence);
    else if (axes < fewest)
      nearest.back() = sequence;
    else
      continue;
    fewest = axes;
  }
  return nearest;
}

}  // namespace

AttributedCells::AttributedCells(const Suite& suite) : settings_(*suite.attribution) {
  if (settings_.cells)
    expression_.assign(*settings_.cells);
  else
    base_ = baseSequences(suite);
}

bool AttributedCells::includes(const PlannedSequence& sequence, const CellResult& cell) const {
  if (!settings_.everyFrame && cell.frame != sequence.frames.back()) return false;
  if (settings_.cells) return std::regex_search(cell.key(), expression_);
  return std::ranges::any_of(base_, [&](const PlannedSequence& base) {
    return base.scene == sequence.scene && base.technique == sequence.technique && !sequence.external;
  });
}

std::size_t countAttributedCells(const Suite& suite, const Plan& plan) {
  if (!suite.attribution) return 0;
  const AttributedCells chosen(suite);
  std::size_t count = 0;
  for (const PlannedSequence& sequence : plan.sequences)
    for (const int frame : sequence.frames)
      count += chosen.includes(sequence, makeCell(suite, sequence, frame)) ? 1 : 0;
  return count;
}

}  // namespace pb
