// Techniques with equal captures (raster/equal_captures.h) rendering one sequence together: its probes are captured
// once a frame and shown by all of them. Pictures and statistics are, in every bit, those of a RasterSequence each.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "raster/renderer.h"

namespace pb {

class SharedSequence {
 public:
  // At least one technique; a single one may be any, several must be mayShareCaptures() with equal keys, on a device
  // without a planted fault. The device must outlive it. Throws for any of them as RasterSequence does.
  SharedSequence(RasterDevice& device, const std::vector<Technique>& techniques, int widthPx, int heightPx,
                 int samplesPerAxis);
  ~SharedSequence();
  SharedSequence(const SharedSequence&) = delete;
  SharedSequence& operator=(const SharedSequence&) = delete;

  // Captures what is due in the next frame of the sequence.
  void capture(const std::shared_ptr<const Snapshot>& snapshot, bool countFragments = false);

  // Renders the final image of one of the techniques, any number of them a frame in any order.
  FrameStats show(std::size_t technique);

  // What show() rendered last.
  Image readImage() { return captures_.readImage(); }

  // Whose maps these are, for reading them.
  RasterSequence& maps() { return captures_; }

 private:
  struct FinalPass;

  FrameStats showShared(FinalPass& own);

  RasterSequence captures_;
  std::vector<std::unique_ptr<FinalPass>> finalPasses_;  // by technique; none for a single one
  std::shared_ptr<const Snapshot> snapshot_;             // of the frame
  bool countFragments_ = false;
  FrameStats ofSingle_;  // its frame, rendered by capture()
};

}  // namespace pb
