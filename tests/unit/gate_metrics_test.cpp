#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/gate_fixture.h"

namespace pb {
namespace {

struct MetricRule {
  const char* name;
  Tolerance tolerance;
  double before, after;
  GateVerdict verdict;
};

class GateMetricRule : public testing::TestWithParam<MetricRule> {};

TEST_P(GateMetricRule, GivesItsVerdict) {
  const MetricRule& rule = GetParam();
  Results before = runWith(rule.before);
  before.tolerance = {{"relmse", rule.tolerance}};
  EXPECT_EQ(verdictOf(before, runWith(rule.after)), rule.verdict);
}

INSTANTIATE_TEST_SUITE_P(
    Table, GateMetricRule,
    testing::Values(
        MetricRule{"equal", plain(0, 0), 0.5, 0.5, GateVerdict::pass},
        MetricRule{"exact_is_exact", plain(0, 0), 0.5, std::nextafter(0.5, 1.0), GateVerdict::fail},
        MetricRule{"within_absolute", plain(0.25, 0), 0.5, 0.75, GateVerdict::pass},
        MetricRule{"beyond_absolute", plain(0.25, 0), 0.5, 0.76, GateVerdict::fail},
        MetricRule{"better_beyond_absolute", plain(0.25, 0), 0.5, 0.24, GateVerdict::fail},
        MetricRule{"within_relative", plain(0, 0.5), 0.5, 0.75, GateVerdict::pass},
        MetricRule{"beyond_relative", plain(0, 0.5), 0.5, 0.76, GateVerdict::fail},
        MetricRule{"better_beyond_relative", plain(0, 0.5), 0.5, 0.24, GateVerdict::fail},
        MetricRule{"larger_of_both_counts", plain(0.3, 0.5), 0.5, 0.79, GateVerdict::pass},
        MetricRule{"any_needs_one", any({plain(0.01, 0), plain(0, 0.5)}), 0.5, 0.7, GateVerdict::pass},
        MetricRule{"any_fails_beyond_all", any({plain(0.01, 0), plain(0, 0.5)}), 0.5, 0.8, GateVerdict::fail},
        MetricRule{"all_needs_every_one", all({plain(0.01, 0), plain(0, 0.5)}), 0.5, 0.7, GateVerdict::fail},
        MetricRule{"all_passes_within_all", all({plain(0.01, 0), plain(0, 0.5)}), 0.5, 0.505, GateVerdict::pass},
        MetricRule{"nan_for_a_number", plain(9, 9), 0.5, kNan, GateVerdict::fail},
        MetricRule{"number_for_a_nan", plain(9, 9), kNan, 0.5, GateVerdict::fail},
        MetricRule{"nan_stays", plain(0, 0), kNan, kNan, GateVerdict::pass},
        MetricRule{"infinity_for_a_number", plain(9, 9), 0.5, kInfinity, GateVerdict::fail},
        MetricRule{"number_for_an_infinity", plain(9, 9), kInfinity, 0.5, GateVerdict::fail},
        MetricRule{"infinity_stays", plain(0, 0), kInfinity, kInfinity, GateVerdict::pass},
        MetricRule{"infinity_changes_sign", plain(9, 9), kInfinity, -kInfinity, GateVerdict::fail}),
    [](const auto& test) { return test.param.name; });

TEST(Gate, SameRun_PassesAndComparesEverything) {
  const Results run = samples::makeResults();
  const GateReport report = check(run, baselineOf(run));
  EXPECT_EQ(report.verdict, GateVerdict::pass);
  EXPECT_TRUE(report.findings.empty());
  EXPECT_EQ(report.cells.size(), 9u);
  EXPECT_EQ(report.metricsCompared, 34u);   // 8 cells x 2 metrics x {whole, mask}, 1 cell without mask
  EXPECT_EQ(report.countersCompared, 36u);  // 9 cells x 4
  EXPECT_EQ(report.costsCompared, 4u);      // one a sequence, not one a frame
}

TEST(Gate, UndefinedMetric_MustStayUndefined) {
  Results before = runWith(0.5);
  before.tolerance = {{"ssim", plain(9, 9)}};
  Results without = before;
  without.cells[0].metrics.ssim.reset();
  EXPECT_EQ(verdictOf(without, without), GateVerdict::pass);
  EXPECT_EQ(verdictOf(before, without), GateVerdict::fail);
  EXPECT_EQ(verdictOf(without, before), GateVerdict::fail);
}

TEST(Gate, MaskIsGatedAsTheWholeImageIs) {
  const Results before = samples::makeResults();
  Results changed = before, without = before;
  changed.cells[3].maskMetrics->flipHdr->mean *= 1.5;
  without.cells[3].maskMetrics.reset();

  const GateReport report = check(changed, baselineOf(before));
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].quantity, "mask flip_hdr");
  EXPECT_EQ(report.findings[0].cell, before.cells[3].key());
  // 50 % of the value where 2 % of it are allowed.
  EXPECT_NEAR(report.findings[0].excess, 25.0, 1e-9);

  EXPECT_EQ(check(without, baselineOf(before)).findings.at(0).kind, FindingKind::missing);
  EXPECT_EQ(check(before, baselineOf(without)).findings.at(0).kind, FindingKind::surplus);
}

TEST(Gate, LargestExcess_StandsFirst) {
  const Results before = samples::makeResults();
  Results after = before;
  after.cells[0].metrics.flipHdr->mean *= 1.1;
  after.cells[4].metrics.flipHdr->mean *= 1.4;
  after.cells[6].metrics.flipHdr->mean *= 1.2;
  const GateReport report = check(after, baselineOf(before));
  ASSERT_EQ(report.findings.size(), 3u);
  EXPECT_EQ(report.findings[0].cell, before.cells[4].key());
  EXPECT_EQ(report.findings[1].cell, before.cells[6].key());
  EXPECT_EQ(report.findings[2].cell, before.cells[0].key());
}

TEST(Gate, ExitCodes_AreThoseOfTheCommandLine) {
  EXPECT_EQ(exitCode(GateVerdict::pass), 0);
  EXPECT_EQ(exitCode(GateVerdict::fail), 1);
  EXPECT_EQ(exitCode(GateVerdict::inconclusive), 4);
  EXPECT_EQ(exitCode(GateVerdict::drift), 4);
}

TEST(GateIntegrity, IsComparedWhereItHasATolerance) {
  Results before = runWith(0.5);
  before.cells[0].integrity = {{"misplaced_faces", 0}, {"edge_step_mip0", 1.2}};
  Results after = before;
  after.cells[0].integrity = {{"misplaced_faces", 2}, {"edge_step_mip0", 1.21}, {"younger", 3}};
  EXPECT_EQ(verdictOf(before, after), GateVerdict::pass);
  before.tolerance.emplace_back(kIntegrityTolerance, plain(0, 0.1));
  const GateReport report = check(after, baselineOf(before));
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].quantity, "integrity misplaced_faces");
  after.cells[0].integrity.clear();
  EXPECT_EQ(check(after, baselineOf(before)).findings.size(), 2u);
}

// relMSE 0.5 may change by 0.1, a change above 0.02 is reported.
Results runWithLevels(double relmse) {
  Results run = runWith(relmse);
  run.tolerance = {{"relmse", plain(0.1, 0)}};
  run.warnTolerance = {{"relmse", plain(0.02, 0)}};
  return run;
}

TEST(GateLevels, ChangeBeyondTheWarningLevel_PassesAndIsReported) {
  const GateReport report = check(runWithLevels(0.55), baselineOf(runWithLevels(0.5)));
  EXPECT_EQ(report.verdict, GateVerdict::pass);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].level, Level::warn);
  EXPECT_NEAR(report.findings[0].limit, 0.02, 1e-15);
  EXPECT_NEAR(report.findings[0].excess, 2.5, 1e-9);
}

TEST(GateLevels, ChangeBeyondBothLevels_IsOneFailure) {
  const GateReport report = check(runWithLevels(0.65), baselineOf(runWithLevels(0.5)));
  EXPECT_EQ(report.verdict, GateVerdict::fail);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_NEAR(report.findings[0].limit, 0.1, 1e-15);
}

TEST(GateLevels, ChangeWithinTheWarningLevel_IsNoFinding) {
  EXPECT_TRUE(check(runWithLevels(0.51), baselineOf(runWithLevels(0.5))).findings.empty());
}

TEST(GateLevels, FailuresStandBeforeLargerWarnings) {
  Results before = samples::makeResults();
  before.warnTolerance = {{"relmse", plain(1e-12, 0)}};
  Results after = before;
  after.cells[0].metrics.flipHdr->mean *= 1.1;
  after.cells[1].metrics.sums.relmse *= 1.01;
  const GateReport report = check(after, baselineOf(before));
  ASSERT_EQ(report.findings.size(), 2u);
  EXPECT_EQ(report.findings[0].level, Level::fail);
  EXPECT_GT(report.findings[1].excess, report.findings[0].excess);
}

TEST(GateLevels, OfAScene_StandInPlaceOfTheSuites) {
  Results before = runWithLevels(0.5);
  before.sceneTolerances["scene=builtin:a camera=main"] = {{{"relmse", plain(0.2, 0)}}, {}};
  EXPECT_TRUE(check(runWithLevels(0.65), baselineOf(before)).findings.empty());  // nor is there a level `warn`
  EXPECT_EQ(check(runWithLevels(0.75), baselineOf(before)).verdict, GateVerdict::fail);
  before.sceneTolerances = {{"scene=builtin:a camera=other", {{{"relmse", plain(0.2, 0)}}, {}}}};
  EXPECT_EQ(check(runWithLevels(0.65), baselineOf(before)).verdict, GateVerdict::fail);
}

}  // namespace
}  // namespace pb
