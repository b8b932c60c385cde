// The sequences of one scene that this program renders itself: those without an external technique.
#pragma once

#include <algorithm>
#include <vector>

#include "bench/plan.h"

namespace pb {

struct RasterSequences {
  std::vector<const PlannedSequence*> sequences;
  std::vector<Technique> techniques;  // of each
  int first = 0, last = 0;            // frames that have to be rendered, of all of them
};

// Of sequences of one scene, which starts at frame `first`.
inline RasterSequences rasterSequencesOf(const std::vector<const PlannedSequence*>& sequences, int first) {
  RasterSequences own{{}, {}, first, first};
  for (const PlannedSequence* sequence : sequences) {
    if (sequence->external) continue;
    own.sequences.push_back(sequence);
    own.techniques.push_back(sequence->technique);
    own.last = std::max(own.last, sequence->frames.back());
  }
  return own;
}

}  // namespace pb
