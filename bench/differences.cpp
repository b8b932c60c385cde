#include "bench/differences.h"

#include <algorithm>

#include "bench/jackknife.h"

namespace pb {
namespace {

const std::vector<double>* replicatesOf(const CellResult& cell, const std::string& metric, Region region) {
  const MetricReplicates& all = region == Region::mask ? cell.maskReplicates : cell.replicates;
  const auto found = std::ranges::find(all, metric, &MetricReplicates::value_type::first);
  return found == all.end() ? nullptr : &found->second;
}

// Of the metric itself; nullopt without replicates against the same batches.
std::optional<Interval> pairedInterval(const CellResult& a, const CellResult& b, const std::string& metric,
                                       Region region) {
  const std::vector<double>* replicatesA = replicatesOf(a, metric, region);
  const std::vector<double>* replicatesB = replicatesOf(b, metric, region);
  if (!replicatesA || !replicatesB || replicatesA->size() != replicatesB->size()) return std::nullopt;
  if (a.referenceHash.empty() || a.referenceHash != b.referenceHash) return std::nullopt;
  return jackknifeDifference(*errorOf(a, region, metric), *replicatesA, *errorOf(b, region, metric), *replicatesB);
}

const CellResult* cellAt(const Sequence& sequence, int frame) {
  const auto found = std::ranges::find(sequence, frame, &CellResult::frame);
  return found == sequence.end() ? nullptr : *found;
}

bool isSameView(const CellResult& a, const CellResult& b) { return a.scene == b.scene && a.camera == b.camera; }

// Of two errors at one frame. nullopt where there is something to know of one of them, but not of what they have in
// common.
std::optional<Difference> pairedAtFrame(const CellResult& a, const CellResult& b, const Selection& selection,
                                        Region region) {
  const std::optional<Difference> difference = differenceOf(a, b, selection, region);
  if (!difference || difference->isPaired || difference->loss.isExact()) return difference;
  const bool isAnythingKnown = lossOf(a, selection, region)->isKnown() || lossOf(b, selection, region)->isKnown();
  return isAnythingKnown ? std::nullopt : difference;
}

// Of the frames whose difference decides: all, or the one that is worst for both. nullopt where one of them has an
// interval and no partner, or none has one.
std::optional<Estimate> pairedOverFrames(const Candidate& a, const Candidate& b, const Selection& selection) {
  std::vector<Estimate> frames;
  bool isAnyPaired = false;
  for (const CellResult* cell : a.worstCells) {
    const CellResult* other = cellAt(b.worstCells, cell->frame);
    if (selection.worstFrame && (cell->frame != a.worstFrame || cell->frame != b.worstFrame)) continue;
    const auto loss = lossOf(*cell, selection, a.region);
    if (!loss) continue;
    const auto difference = other ? pairedAtFrame(*cell, *other, selection, a.region) : std::nullopt;
    if (!difference) return std::nullopt;
    isAnyPaired = isAnyPaired || difference->isPaired;
    frames.push_back(difference->loss);
  }
  if (!isAnyPaired || frames.size() != (selection.worstFrame ? 1 : b.worstCells.size())) return std::nullopt;
  return meanOverFrames(frames);
}

}  // namespace

std::optional<Difference> differenceOf(const CellResult& a, const CellResult& b, const Selection& selection,
                                       Region region) {
  const std::optional<Estimate> lossA = lossOf(a, selection, region), lossB = lossOf(b, selection, region);
  if (!lossA || !lossB) return std::nullopt;
  const std::optional<Interval> paired =
      selection.object.empty() ? pairedInterval(a, b, selection.metric, region) : std::nullopt;
  if (!paired) return Difference{unpairedDifference(*lossA, *lossB)};
  const double value = lossA->value - lossB->value;
  if (isLowerBetter(selection.metric)) return Difference{{value, paired->low, paired->high}, true};
  return Difference{{value, -paired->high, -paired->low}, true};
}

Difference differenceOf(const CandidateSet& set, std::size_t a, std::size_t b) {
  if (const auto paired = pairedDifference(set, a, b, set.selection.metric)) return {*paired, true};
  return {unpairedDifference(set.candidates[a].loss, set.candidates[b].loss)};
}

std::optional<Estimate> pairedDifference(const CandidateSet& set, std::size_t a, std::size_t b,
                                         const std::string& metric) {
  const Candidate &first = set.candidates[a], &second = set.candidates[b];
  if (first.worstCells.empty() || second.worstCells.empty()) return std::nullopt;
  if (!isSameView(*first.worstCells.front(), *second.worstCells.front())) return std::nullopt;
  Selection selection = set.selection;
  selection.metric = metric;
  return pairedOverFrames(first, second, selection);
}

}  // namespace pb
