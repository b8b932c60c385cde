// The last steps of a cell: its scores, its pictures, its line in the run's journal. Any thread may take them.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "bench/picture_names.h"
#include "bench/results.h"
#include "bench/runner.h"
#include "bench/score.h"

namespace pb {

using FinishedCells = std::map<std::string, CellResult>;  // by key

class CellFinisher {
 public:
  // Both must outlive it.
  CellFinisher(const RunContext& context, FinishedCells& finished)
      : c_(context), names_(context.suite, context.scenes), finished_(finished) {}

  // A cell that has what doesn't come from its picture. before: the measured frame before it in the sequence.
  void finish(const PlannedSequence& sequence, CellResult cell, const PictureScores& scores, const RenderedFrame& shown,
              const std::optional<RenderedFrame>& before);

  bool isFinished(const PlannedSequence& sequence, int frame);

 private:
  void writeImages(const PlannedSequence& sequence, CellResult& cell, const Image& image, const Plane& flipMap) const;
  std::string imagePath(const std::string& name) const;

  const RunContext& c_;
  const PictureNames names_;
  std::mutex mutex_;
  FinishedCells& finished_;
};

}  // namespace pb
