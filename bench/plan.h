// What a suite comes to: its grid expanded into sequences and cells. Pure; nothing is loaded or rendered here.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/results.h"
#include "bench/suite.h"

namespace pb {

// One technique rendering one scene's frames in order. Its cells are the measured frames.
struct PlannedSequence {
  std::size_t scene = 0;  // index into Suite::scenes
  Technique technique;
  std::vector<int> frames;                // increasing
  std::optional<std::size_t> external{};  // index into Suite::externals: that in place of `technique`
  std::vector<int> attributedFrames{};    // of `frames`: those of which it is wanted where their error comes from
};

struct Plan {
  // By scene, then in grid order, the last axis fastest; the external techniques last.
  std::vector<PlannedSequence> sequences;  // by scene: grid order, the last axis fastest, what varies, what is external

  std::size_t cellCount() const;
  std::vector<int> framesOf(std::size_t scene) const;  // measured in any of its sequences, increasing
};

// Part I of N of the sequences; contiguous, so that the parts in order are the whole.
struct Shard {
  int index = 1, count = 1;
};
Shard parseShard(std::string_view text);  // "I/N"; an input Error otherwise

struct PlanFilter {
  std::optional<std::string> only;  // regular expression (ECMAScript) searched in the cells' keys
  Shard shard;
};

// Throws an input Error for an invalid expression, for a scene or an axis value that stands twice, and when nothing is
// left, when the suite's attribution names no cell of it, or the grid is absurdly large.
Plan makePlan(const Suite& suite, const PlanFilter& filter = {});

// A cell as results name it, with nothing measured yet.
CellResult makeCell(const Suite& suite, const PlannedSequence& sequence, int frame);

// Counts of what the plan comes to, for --dry-run and the start of a run.
std::string printPlan(const Suite& suite, const Plan& plan);

}  // namespace pb
