#include "bench/cell_finisher.h"

#include <utility>

#include "bench/kept_pictures.h"
#include "bench/progress.h"
#include "bench/run_directory.h"
#include "scenes/image_io.h"

namespace pb {

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
  else if (isAttributed(sequence, cell.frame))
    keepPicture(c_.directory, names_.ofFrame(sequence, cell.frame), *shown.image);
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
