// Pictures that a run still needs, without loss, in its folder instead of in memory: so that nothing is rendered again,
// not even by a run that was killed and goes on. They go when the run is complete.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>

#include "bench/picture_names.h"
#include "bench/picture_source.h"

namespace pb {

// Whether a cell's own picture is wanted for its attribution.
bool isAttributed(const PlannedSequence& sequence, int frame);

// In place of one that an earlier run may have left; `name` is PictureNames::ofFrame().
void keepPicture(const RunDirectory& directory, const std::string& name, const Image& image);

// The picture of a finished cell: one that the run keeps, else one that keepPicture() has written. Throws an input
// Error if it is gone or damaged.
Image readPictureOf(const RunDirectory& directory, const CellResult& cell, const std::string& name);

// Measured frames that are rendered and not scored yet.
class KeptPictures {
 public:
  // Those that the run's folder holds.
  explicit KeptPictures(const RunContext& context);

  // From any thread.
  void keep(const PlannedSequence& sequence, const ShownFrame& shown);

  // Without scores, its picture being the kept one; nullptr if there is none. While nothing is being kept, as haveAll()
  // and read().
  const CellResult* find(const PlannedSequence& sequence, int frame) const;
  bool haveAll(const PlannedSequence& sequence, const std::vector<int>& frames) const;

  ShownFrame read(const PlannedSequence& sequence, int frame) const;

 private:
  const RunContext& c_;
  const PictureNames names_;
  std::mutex mutex_;
  std::map<std::string, CellResult> cells_;  // by key
};

// Pictures of sequences that have all been kept.
class KeptSource : public PictureSource {
 public:
  KeptSource(const KeptPictures& pictures, const Sequences& sequences) : pictures_(pictures), sequences_(sequences) {}

  void advance(int frame, bool) override { frame_ = frame; }
  ShownFrame show(std::size_t sequence) override { return pictures_.read(*sequences_[sequence], frame_); }

 private:
  const KeptPictures& pictures_;
  const Sequences sequences_;
  int frame_ = 0;
};

// Renders all measured frames of the plan that are not kept yet, external ones too, and keeps them. Wants no
// references. Throws Error(Failure::interrupted) at the next frame after an interrupt; what is kept by then stays.
// Returns what was skipped.
SkippedExternals renderAndKeep(const RunContext& context, KeptPictures& kept);

}  // namespace pb
