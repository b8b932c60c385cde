// How far two errors are apart, as far as the reference's noise lets that be known.
//
// Errors against the same reference have its noise in common: a bright sample too many is missing in both pictures. So
// where both cells keep their replicates against the same batches (equal referenceHash, which two runs can have, too),
// the difference is jackknifed as a number of its own: *paired*. Elsewhere nothing is known of what the two have in
// common, and the difference has every value that the two intervals leave open, which excludes 0 exactly where they
// don't overlap. It is unknown if one of the two is.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "bench/candidates.h"
#include "bench/estimate.h"
#include "bench/results.h"
#include "bench/sections.h"

namespace pb {

struct Difference {
  Estimate loss;  // that of the first one less that of the second, see lossOf(): below 0 the first one is better
  bool isPaired = false;
};

// Of two cells of the same scene, camera and frame; nullopt where the error of one is undefined.
std::optional<Difference> differenceOf(const CellResult& a, const CellResult& b, const Selection& selection,
                                       Region region);

// Of two candidates of a set, by its selection. Paired where both are worst on the same scene and all their frames with
// an interval are.
Difference differenceOf(const CandidateSet& set, std::size_t a, std::size_t b);
// In the same frames by another metric; nullopt where that is not paired.
std::optional<Estimate> pairedDifference(const CandidateSet& set, std::size_t a, std::size_t b,
                                         const std::string& metric);

}  // namespace pb
