#include "bench/tolerance.h"

#include <gtest/gtest.h>

#include "tests/unit/gate_fixture.h"

namespace pb {
namespace {

TEST(Tolerance, OfATree_IsItsLargestOrSmallestChild) {
  EXPECT_EQ(largestAllowedDelta(plain(0.5, 0.1), 2.0), 0.5);
  EXPECT_EQ(largestAllowedDelta(plain(0.5, 0.1), -20.0), 2.0);
  EXPECT_EQ(largestAllowedDelta(any({plain(1, 0), plain(3, 0), plain(2, 0)}), 0.0), 3.0);
  EXPECT_EQ(largestAllowedDelta(all({plain(2, 0), plain(1, 0), plain(3, 0)}), 0.0), 1.0);
  EXPECT_EQ(largestAllowedDelta(all({plain(4, 0), any({plain(1, 0), plain(2, 0)})}), 0.0), 2.0);
}

TEST(TolerancePresets, GateKnownMetricsAndWidenInTheirOrder) {
  double narrower = 0;
  for (const TolerancePreset& preset : tolerancePresets()) {
    for (const auto& [metric, tolerance] : preset.levels.fail) {
      if (metric == kIntegrityTolerance) continue;
      EXPECT_NO_THROW(metricValue({}, metric)) << metric;
    }
    const double limit = largestAllowedDelta(*findTolerance(preset.levels.fail, "flip_hdr"), 0.1);
    EXPECT_GT(limit, narrower) << preset.name;
    narrower = limit;
  }
}

TEST(TolerancePresets, WarnBeforeTheyFail) {
  for (const TolerancePreset& preset : tolerancePresets())
    for (const auto& [metric, tolerance] : preset.levels.fail)
      EXPECT_LT(largestAllowedDelta(*findTolerance(preset.levels.warn, metric), 0.1),
                largestAllowedDelta(tolerance, 0.1))
          << preset.name << ' ' << metric;
}

}  // namespace
}  // namespace pb
