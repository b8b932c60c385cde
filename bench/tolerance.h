// How far a metric may move from its baseline before the gate calls it changed.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pb {

// plain: |value - baseline| may be at most max(absolute, relative * |baseline|).
// any, all: within at least one, or every one, of `children` (never empty).
struct Tolerance {
  enum class Kind { plain, any, all };
  Kind kind = Kind::plain;
  double absolute = 0, relative = 0;  // finite and not negative
  std::vector<Tolerance> children;

  friend bool operator==(const Tolerance&, const Tolerance&) = default;
};

// By metric key (see metricTable()), in the order of the suite. A metric without one is not gated.
using Tolerances = std::vector<std::pair<std::string, Tolerance>>;

// The largest |value - baseline| that is within the tolerance; a tree's is the largest or smallest of its children's.
double largestAllowedDelta(const Tolerance& tolerance, double baseline);

}  // namespace pb
