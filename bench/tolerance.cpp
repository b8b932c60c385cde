#include "bench/tolerance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace pb {

std::string toleranceScope(const std::string& scene, const std::string& camera) {
  return fmt::format("scene={} camera={}", scene, camera);
}

const Tolerance* findTolerance(const Tolerances& tolerances, std::string_view metric) {
  const auto found = std::ranges::find(tolerances, metric, &Tolerances::value_type::first);
  return found == tolerances.end() ? nullptr : &found->second;
}

double largestAllowedDelta(const Tolerance& tolerance, double baseline) {
  if (tolerance.kind == Tolerance::Kind::plain)
    return std::max(tolerance.absolute, tolerance.relative * std::abs(baseline));
  assert(!tolerance.children.empty());
  const bool any = tolerance.kind == Tolerance::Kind::any;
  double limit = any ? 0.0 : std::numeric_limits<double>::infinity();
  for (const Tolerance& child : tolerance.children) {
    const double childLimit = largestAllowedDelta(child, baseline);
    limit = any ? std::max(limit, childLimit) : std::min(limit, childLimit);
  }
  return limit;
}

}  // namespace pb
