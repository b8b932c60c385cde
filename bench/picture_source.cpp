#include "bench/picture_source.h"

#include <numeric>

#include "bench/capture_groups.h"
#include "bench/raster_sequences.h"
#include "raster/fault.h"

namespace pb {
namespace {

std::vector<std::pair<std::string, std::int64_t>> namedCounters(const FrameStats& stats) {
  const FrameCounters& counters = stats.counters;
  const std::vector<int>& ofProbes = stats.coats.ofProbes;
  const std::vector<int>& mirrors = stats.mirrors.ofProbes;
  return {{"faces_captured", counters.facesCaptured},
          {"draws", counters.draws},
          {"triangles", counters.triangles},
          {"fragments", counters.fragments},
          {"probe_bytes", counters.probeBytes},
          {"texels_filtered", counters.texelsFiltered},
          {"coats_from_probe", std::accumulate(ofProbes.begin(), ofProbes.end(), std::int64_t{0})},
          {"coats_from_environment", stats.coats.fromEnvironment},
          {"mirrors_from_probe", std::accumulate(mirrors.begin(), mirrors.end(), std::int64_t{0})},
          {"mirrors_from_environment", stats.mirrors.fromEnvironment}};
}

void fillIn(const FrameStats& stats, CellResult& cell) {
  cell.counters = namedCounters(stats);
  cell.faceAgeFrames = stats.faceAgeFrames;
  cell.coatsOfProbes = stats.coats.ofProbes;
}

std::vector<Technique> techniquesOf(const Sequences& sequences) {
  std::vector<Technique> techniques;
  for (const PlannedSequence* sequence : sequences) techniques.push_back(sequence->technique);
  return techniques;
}

}  // namespace

std::vector<Sequences> renderedTogether(const RunContext& context, const Sequences& sequences) {
  std::vector<Sequences> groups;
  if (sequences.empty()) return groups;
  const std::size_t scene = sequences.front()->scene;
  const RasterSequences own = rasterSequencesOf(sequences, context.suite.scenes[scene].startFrame());
  if (isFaultPlanted(context.device)) {
    for (const PlannedSequence* sequence : own.sequences) groups.push_back({sequence});
    return groups;
  }
  for (const std::vector<std::size_t>& members : captureGroups(
           own.techniques, own.first, own.last, [&](int frame) { return makeSnapshot(context, scene, frame); },
           context.suite.image.heightPx)) {
    Sequences& group = groups.emplace_back();
    for (const std::size_t member : members) group.push_back(own.sequences[member]);
  }
  return groups;
}

RasterSource::RasterSource(const RunContext& context, const Sequences& sequences, SnapshotOfFrame snapshotOf,
                           IntegrityMeter& integrity)
    : c_(context),
      sequences_(sequences),
      snapshotOf_(std::move(snapshotOf)),
      meter_(integrity),
      raster_(c_.device, techniquesOf(sequences), c_.suite.image.widthPx, c_.suite.image.heightPx,
              c_.suite.image.samplesPerAxis) {}

void RasterSource::advance(int frame, bool isMeasured) {
  frame_ = frame;
  snapshot_ = snapshotOf_(frame);
  integrity_.reset();
  raster_.capture(snapshot_, isMeasured);
}

ShownFrame RasterSource::show(std::size_t sequence) {
  const PlannedSequence& planned = *sequences_[sequence];
  const FrameStats stats = raster_.show(sequence);
  ShownFrame shown{raster_.readImage(), makeCell(c_.suite, planned, frame_)};
  fillIn(stats, shown.cell);
  if (frame_ == planned.frames.back()) {
    if (!integrity_) integrity_ = meter_.measure(raster_.maps(), planned.technique, snapshot_, c_.suite.image.heightPx);
    shown.cell.integrity = *integrity_;
  }
  return shown;
}

}  // namespace pb
