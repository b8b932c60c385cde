// Pictures of sequences that go through the frames of a scene together, with what their cells have besides scores:
// rendered here, or kept from before (bench/kept_pictures.h).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bench/bounce_depth.h"
#include "bench/integrity.h"
#include "bench/runner.h"
#include "raster/shared_sequence.h"

namespace pb {

using Sequences = std::vector<const PlannedSequence*>;

// A measured frame of a sequence. The cell has no scores.
struct ShownFrame {
  Image image;
  CellResult cell;
};

class PictureSource {
 public:
  virtual ~PictureSource() = default;

  // Goes on to the next frame of the scene. isMeasured: one of its pictures is measured.
  virtual void advance(int frame, bool isMeasured) = 0;

  // The picture of that frame, of one of the sequences.
  virtual ShownFrame show(std::size_t sequence) = 0;
};

// Those of a scene's sequences that are to be rendered together (bench/capture_groups.h), without external ones. With a
// planted fault each is alone: faults may act otherwise on captures that are shared.
std::vector<Sequences> renderedTogether(const RunContext& context, const Sequences& sequences);

// Renders them from the first frame of their scene on.
class RasterSource : public PictureSource {
 public:
  // `snapshotOf` should give equal frames in equal objects, by which the meter knows what it has traced.
  RasterSource(const RunContext& context, const Sequences& sequences, SnapshotOfFrame snapshotOf,
               IntegrityMeter& integrity);

  void advance(int frame, bool isMeasured) override;
  ShownFrame show(std::size_t sequence) override;

 private:
  const RunContext& c_;
  const Sequences sequences_;
  const SnapshotOfFrame snapshotOf_;
  IntegrityMeter& meter_;
  SharedSequence raster_;
  int frame_ = 0;
  std::shared_ptr<const Snapshot> snapshot_;
  std::optional<MetricValues> integrity_;  // of the frame, of maps that they share
};

}  // namespace pb
