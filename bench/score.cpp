#include "bench/score.h"

#include "bench/clusters.h"
#include "bench/flicker.h"
#include "bench/noise.h"
#include "raster/probe_layout.h"

namespace pb {
namespace {

const Mask* maskOf(const Truth& truth) { return truth.mask.empty() ? nullptr : &truth.mask; }

FramePair pairOf(const RenderedFrame& frame) { return {*frame.image, frame.truth->mean, frame.truth->mask}; }

// From the errors against the converged truth where that is the truth that matches.
MatchedErrors matchedErrors(const Truth& truth, int depth, const Image& image, const MetricsResult& converged) {
  const TruncatedTruth& truncated = truth.truncated.at(depth);
  if (truncated.converged) return {depth, true, converged.whole, converged.masked, truth.floor, truth.maskFloor};
  const MetricsResult scores = truncated.compare(image, maskOf(truth));
  return {depth, false, scores.whole, scores.masked, truncated.floor, truncated.maskFloor};
}

}  // namespace

PictureScores scorePicture(const Truth& truth, const Image& image, const std::optional<int>& depth) {
  PictureScores scores{
      .errors = truth.metrics.compare(image, maskOf(truth)), .matched = {}, .materials = {}, .clusters = {}};
  if (depth) scores.matched = matchedErrors(truth, *depth, image, scores.errors);
  scores.unbiasedMse = computeUnbiasedMse(image, truth.halfA, truth.halfB);
  const Snapshot& snapshot = *truth.snapshot;
  scores.materials =
      computeMaterialErrors(*snapshot.scene, truth.materials, truth.mean, image, scores.errors.flipHdrMap);
  scores.clusters = findClusters(truth.mean, image, truth.objects.inReference, objectNames(snapshot));
  return scores;
}

void fillIn(const PictureScores& scores, const ScoredFrame& scored, CellResult& cell) {
  const Truth& truth = *scored.frame.truth;
  // External techniques have no counters.
  if (!cell.counters.empty()) cell.counters.emplace_back("reference_rays", truth.raysTraced);
  cell.metrics = scores.errors.whole;
  cell.maskMetrics = scores.errors.masked;
  cell.floor = truth.floor;
  cell.maskFloor = truth.maskFloor;
  cell.unbiased = {{"mse", scores.unbiasedMse}};
  cell.matched = scores.matched;
  cell.materials = scores.materials;
  cell.clusters = scores.clusters;
  if (scored.before)
    cell.flicker =
        computeFlicker(pairOf(scored.frame), pairOf(*scored.before), scored.frame.number - scored.before->number);
  ProbeLayout layout(scored.technique);
  cell.objects = computeObjectErrors(*truth.snapshot, layout.apply(*truth.snapshot), truth.objects, truth.mean,
                                     *scored.frame.image, scores.errors.flipHdrMap);
}

}  // namespace pb
