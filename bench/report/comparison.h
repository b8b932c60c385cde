// Two runs, cell by cell: what changed, and whether by more than is known to be uncertain.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/json_document.h"
#include "bench/results.h"

namespace pb {

// Of errors as bench/verdict.h has it, of costs by their intervals. equal: the same, or the difference is within its
// 95 % interval; belowFloor: so, and neither error is clear of the reference's noise; changed: differs, and no interval
// is known.
enum class Change { better, worse, equal, belowFloor, changed };

struct ComparedValue {
  std::string name;  // flip_hdr, relmse, ssim, frame_ms, ratio
  double before = 0, after = 0;
  std::optional<Interval> beforeInterval, afterInterval;
  Change change = Change::equal;
  std::optional<Interval> differenceInterval{};  // where both are scored against the same reference

  double difference() const { return after - before; }
};

struct ComparedCell {
  std::size_t before = 0, after = 0;  // indices into the runs' cells
  // Those that both have; of the mask where there is one. Costs are those of a sequence and stand with the first of its
  // cells only.
  std::vector<ComparedValue> values;
};

// Cells are the same that have the scene, the camera, the frame and all axes in common that vary in one of the runs. So
// a run of an older program, which knew fewer axes, can be compared, and one whose base technique was changed.
struct Comparison {
  std::vector<ComparedCell> cells;                 // of both runs, in the order of the later one
  std::vector<std::size_t> onlyBefore, onlyAfter;  // indices into the runs' cells
};

Comparison compareRuns(const Results& before, const Results& after);

// Markdown, short enough for a pull request: counts of changes, the cells that changed most, circumstances that differ.
std::string makeComparisonReport(const Results& before, const Results& after, const AxisValues& defaults);

// One row per cell and value: cell,value,before,after,difference,change.
std::string comparisonToCsv(const Results& before, const Results& after, const AxisValues& defaults);

// For the page.
Json toJson(const Comparison& comparison);

}  // namespace pb
