// How far a metric may move from its baseline before the gate calls it changed.
#pragma once

#include <map>
#include <string>
#include <string_view>
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

// Stands among the metrics for all of CellResult::integrity.
inline constexpr char kIntegrityTolerance[] = "integrity";

// A change beyond `fail` fails the gate; one beyond `warn`, which holds some of the metrics of `fail`, is reported
// only.
struct ToleranceLevels {
  Tolerances fail, warn;
  friend bool operator==(const ToleranceLevels&, const ToleranceLevels&) = default;
};

// What holds on one scene in place of what holds for all, by toleranceScope(). A metric that stands in its `fail` has
// the warning level there, or none.
using SceneTolerances = std::map<std::string, ToleranceLevels>;

// "scene=NAME camera=NAME": how the keys of its cells begin.
std::string toleranceScope(const std::string& scene, const std::string& camera);

const Tolerance* findTolerance(const Tolerances& tolerances, std::string_view metric);  // nullptr: there is none

// Named sets of both levels, by increasing width; docs/gate.md says what each is for.
struct TolerancePreset {
  std::string name;
  ToleranceLevels levels;
};
const std::vector<TolerancePreset>& tolerancePresets();

// The largest |value - baseline| that is within the tolerance; a tree's is the largest or smallest of its children's.
double largestAllowedDelta(const Tolerance& tolerance, double baseline);

}  // namespace pb
