#include "bench/score.h"

#include "bench/clusters.h"
#include "bench/flicker.h"
#include "bench/noise.h"
#include "raster/probe_layout.h"

namespace pb {
namespace {

const Mask* maskOf(const Truth& truth) { return truth.mask.empty() ? nullptr : &truth.mask; }

FramePair pairOf(const RenderedFrame& frame) { return {*frame.image, frame.truth->mean, frame.truth->mask}; }

// From the cell's errors against the converged truth where that is the truth that matches.
MatchedErrors matchedErrors(const Truth& truth, int depth, const Image& image, const CellResult& cell) {
  const TruncatedTruth& truncated = truth.truncated.at(depth);
  if (truncated.converged) return {depth, true, cell.metrics, cell.maskMetrics, cell.floor, cell.maskFloor};
  MetricsResult scores = truncated.compare(image, maskOf(truth));
  return {depth, false, scores.whole, scores.masked, truncated.floor, truncated.maskFloor};
}

void addTables(const ScoreRequest& request, const Plane& flipHdrMap, CellResult& cell) {
  const Truth& truth = *request.frame.truth;
  const Image& image = *request.frame.image;
  ProbeLayout layout(request.technique);
  cell.materials = computeMaterialErrors(*truth.snapshot->scene, truth.materials, truth.mean, image, flipHdrMap);
  cell.objects =
      computeObjectErrors(*truth.snapshot, layout.apply(*truth.snapshot), truth.objects, truth.mean, image, flipHdrMap);
  cell.clusters = findClusters(truth.mean, image, truth.objects.inReference, objectNames(*truth.snapshot));
}

}  // namespace

Plane scoreCell(const ScoreRequest& request, CellResult& cell) {
  const Truth& truth = *request.frame.truth;
  const Image& image = *request.frame.image;
  MetricsResult scores = truth.metrics.compare(image, maskOf(truth));
  cell.metrics = scores.whole;
  cell.maskMetrics = scores.masked;
  cell.floor = truth.floor;
  cell.maskFloor = truth.maskFloor;
  cell.unbiased = {{"mse", computeUnbiasedMse(image, truth.halfA, truth.halfB)}};
  if (request.depth) cell.matched = matchedErrors(truth, *request.depth, image, cell);
  if (request.before)
    cell.flicker =
        computeFlicker(pairOf(request.frame), pairOf(*request.before), request.frame.number - request.before->number);
  addTables(request, scores.flipHdrMap, cell);
  return std::move(scores.flipHdrMap);
}

}  // namespace pb
