#include "bench/cell_finisher.h"

#include <numeric>
#include <utility>

#include "bench/progress.h"
#include "bench/run_directory.h"
#include "scenes/image_io.h"

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

}  // namespace

void fillIn(const FrameStats& stats, CellResult& cell) {
  cell.counters = namedCounters(stats);
  cell.faceAgeFrames = stats.faceAgeFrames;
  cell.coatsOfProbes = stats.coats.ofProbes;
}

bool CellFinisher::isFinished(const PlannedSequence& sequence, int frame) {
  const std::lock_guard lock(mutex_);
  return finished_.contains(makeCell(c_.suite, sequence, frame).key());
}

void CellFinisher::finish(const PlannedSequence& sequence, CellResult cell, const PictureScores& scores,
                          const RenderedFrame& shown, const std::optional<RenderedFrame>& before) {
  fillIn(scores, {shown, before, sequence.technique}, cell);
  cell.pictures.reference = imagePath(names_.ofReference(sequence.scene, cell.frame));
  if (c_.suite.pictures.everyFrame || cell.frame == sequence.frames.back())
    writeImages(sequence, cell, *shown.image, scores.errors.flipHdrMap);
  c_.directory.append(cell);
  const std::lock_guard lock(mutex_);
  finished_.emplace(cell.key(), std::move(cell));
  c_.progress.step();
}

// The last frame of a sequence shows its whole history; where the others are not kept, they come from `probebench
// render --frame`.
void CellFinisher::writeImages(const PlannedSequence& sequence, CellResult& cell, const Image& image,
                               const Plane& flipMap) const {
  const std::string name = names_.ofFrame(sequence, cell.frame);
  cell.pictures.rendered = imagePath(name + ".exr");
  cell.pictures.flip = imagePath(name + "-flip.png");
  writeExr((c_.directory.folder() / cell.pictures.rendered).string(), image);
  writePngEncoded((c_.directory.folder() / cell.pictures.flip).string(), magma(flipMap));
}

// As it stands in results: relative to the run's folder.
std::string CellFinisher::imagePath(const std::string& name) const {
  return (c_.directory.imagesFolder().filename() / name).generic_string();
}

}  // namespace pb
