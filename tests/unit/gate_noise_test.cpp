#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/gate_fixture.h"

namespace pb {
namespace {

using testing::HasSubstr;

TEST(Gate, NoisyReference_IsInconclusiveUnlessSomethingChanged) {
  const Results before = runWith(0.5);
  Results noisy = withNoise(before, 3.21e-5);
  const GateReport report = check(noisy, baselineOf(before));
  EXPECT_EQ(report.verdict, GateVerdict::inconclusive);
  EXPECT_TRUE(report.findings.empty());
  EXPECT_THAT(report.noisyCells, testing::ElementsAre(noisy.cells[0].key()));
  noisy.cells[0].metrics.sums.relmse = 1.0;
  EXPECT_EQ(verdictOf(before, noisy), GateVerdict::fail);
}

TEST(Gate, NoisyReference_IsSaidOnceAScene) {
  const Results before = samples::makeResults();
  Results noisy = before;
  for (CellResult& cell : noisy.cells)
    if (cell.scene == "builtin:a") cell.floor = {{"relmse", cell.frame == 0 ? 2e-5 : 3.21e-5}};
  EXPECT_THAT(check(noisy, baselineOf(before)).notes,
              testing::ElementsAre("Noise: max_noise is 1e-05, but references of scene 'builtin:a' have up to "
                                   "3.21e-05, in 2 of its frames."));
}

TEST(Gate, NoiseAtTheLimitOrWithoutOne_Passes) {
  const Results before = runWith(0.5);
  EXPECT_EQ(verdictOf(before, withNoise(before, 1e-5)), GateVerdict::pass);
  Results unlimited = withNoise(before, 1.0);
  unlimited.provenance.maxNoise.reset();
  EXPECT_EQ(verdictOf(unlimited, unlimited), GateVerdict::pass);
}

TEST(Gate, LoosenedMaxNoise_DoesNotPassUnnoticed) {
  const Results before = runWith(0.5);
  Results loosened = withNoise(before, 3.21e-5);
  for (const std::optional<double> limit : {std::optional(1.0), std::optional<double>()}) {
    loosened.provenance.maxNoise = limit;
    const GateReport report = check(loosened, baselineOf(before));
    EXPECT_EQ(report.verdict, GateVerdict::inconclusive);
    EXPECT_THAT(report.notes, testing::Contains(HasSubstr("in the baseline")));
  }
}

}  // namespace
}  // namespace pb
