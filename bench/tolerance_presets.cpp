// The named sets of tolerances.
#include "bench/tolerance.h"

namespace pb {
namespace {

// A change is reported from this share of the one that fails.
constexpr double kWarnShare = 0.25;

Tolerance scaled(Tolerance tolerance, double factor) {
  tolerance.absolute *= factor;
  tolerance.relative *= factor;
  return tolerance;
}

// The metrics that say different things about an image, in the order of metricTable(). `relative` is a share of the
// error; the absolute limits, `unit` times these, keep errors near zero from failing for a rounding. bias is signed and
// passes through zero, ssim is a similarity: a share of either would mean nothing.
TolerancePreset preset(const std::string& name, double relative, double unit) {
  using Kind = Tolerance::Kind;
  ToleranceLevels levels;
  levels.fail = {{"bias", {Kind::plain, 10 * unit, 0, {}}},
                 {"mae", {Kind::plain, unit, relative, {}}},
                 {"relmse", {Kind::plain, unit, relative, {}}},
                 {"ssim", {Kind::plain, 100 * unit, 0, {}}},
                 {"flip_ldr", {Kind::plain, 10 * unit, relative, {}}},
                 {"flip_hdr", {Kind::plain, 10 * unit, relative, {}}},
                 {kIntegrityTolerance, {Kind::plain, 10 * unit, relative, {}}}};
  for (const auto& [metric, tolerance] : levels.fail) levels.warn.emplace_back(metric, scaled(tolerance, kWarnShare));
  return {name, std::move(levels)};
}

}  // namespace

const std::vector<TolerancePreset>& tolerancePresets() {
  static const std::vector<TolerancePreset> presets = {
      preset("strict", 1e-3, 1e-6),   // the same program on the same driver repeats its bits: only roundings pass
      preset("default", 0.02, 1e-5),  // smaller than a reader sees
      preset("loose", 0.1, 1e-4)};    // another driver or machine, where sample positions and filters differ
  return presets;
}

}  // namespace pb
