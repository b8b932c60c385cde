// Of which of a plan's cells a suite wants to know where the error comes from.
#pragma once

#include <cstddef>
#include <regex>
#include <vector>

#include "bench/plan.h"
#include "bench/suite.h"

namespace pb {

class AttributedCells {
 public:
  // Of a suite with attribution.
  explicit AttributedCells(const Suite& suite);

  bool includes(const PlannedSequence& sequence, const CellResult& cell) const;

 private:
  AttributionSettings settings_;
  std::regex expression_;
  std::vector<PlannedSequence> base_;
};

// How many cells of the plan that are; 0 for a suite without attribution.
std::size_t countAttributedCells(const Suite& suite, const Plan& plan);

}  // namespace pb
