#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/error_message.h"
#include "tests/unit/gate_fixture.h"

namespace pb {
namespace {

using testing::HasSubstr;

TEST(Gate, MissingAndSurplusCells_BothFail) {
  const Results all = samples::makeResults();
  Results fewer = all;
  fewer.cells.erase(fewer.cells.begin() + 2);

  const GateReport missing = check(fewer, baselineOf(all));
  EXPECT_EQ(missing.verdict, GateVerdict::fail);
  ASSERT_EQ(missing.findings.size(), 1u);
  EXPECT_EQ(missing.findings[0].kind, FindingKind::missing);
  EXPECT_EQ(missing.findings[0].cell, all.cells[2].key());

  const GateReport surplus = check(all, baselineOf(fewer));
  EXPECT_EQ(surplus.verdict, GateVerdict::fail);
  ASSERT_EQ(surplus.findings.size(), 1u);
  EXPECT_EQ(surplus.findings[0].kind, FindingKind::surplus);
  EXPECT_EQ(surplus.findings[0].cell, all.cells[2].key());
}

TEST(Gate, SequenceWithoutAnyCell_IsNotMissedAsACostAgain) {
  const Results all = samples::makeResults();
  Results fewer = all;
  fewer.cells.erase(fewer.cells.begin(), fewer.cells.begin() + 2);
  EXPECT_EQ(check(fewer, baselineOf(all)).findings.size(), 2u);
}

TEST(Gate, EmptyRun_Fails) {
  Results empty = samples::makeResults();
  empty.cells.clear();
  EXPECT_EQ(verdictOf(samples::makeResults(), empty), GateVerdict::fail);
}

TEST(Gate, Counters_AreExactInBothDirections) {
  const Results before = runWith(0.5);
  for (const std::int64_t delta : {-1, 1}) {
    Results after = before;
    after.cells[0].counters[1].second += delta;
    const GateReport report = check(after, baselineOf(before));
    ASSERT_EQ(report.findings.size(), 1u);
    EXPECT_EQ(report.findings[0].kind, FindingKind::counter);
    EXPECT_EQ(report.findings[0].quantity, "draws");
    EXPECT_EQ(report.findings[0].after, 40.0 + static_cast<double>(delta));
  }
  Results fewer = before;
  fewer.cells[0].counters.pop_back();
  EXPECT_EQ(verdictOf(before, fewer), GateVerdict::fail);
}

TEST(Gate, CounterThatTheBaselineLacks_IsNoted) {
  const Results after = runWith(0.5);
  Results before = after;
  before.cells[0].counters.pop_back();
  const GateReport report = check(after, baselineOf(before));
  EXPECT_EQ(report.verdict, GateVerdict::pass);
  EXPECT_EQ(report.countersCompared, 3u);
  EXPECT_THAT(report.notes, testing::ElementsAre("Counters that the baseline lacks were not compared: probe_bytes."));
}

// The samples' axes and one that is younger than them.
const AxisValues kDefaults = {{"resolution", "64"}, {"refresh", "every-frame"}, {"bounces", "1"}, {"coats", "none"}};

Results withAxis(Results run, const std::string& axis, const std::string& value) {
  for (CellResult& cell : run.cells) cell.technique.insert(cell.technique.begin() + 1, {axis, value});
  return run;
}

// Once as files were written before keys were short, and once as they are now.
TEST(Gate, BaselineFromBeforeAnAxis_MatchesItsDefault) {
  const Results before = samples::makeResults(), after = withAxis(before, "coats", "none");
  for (const AxisValues& stored : {AxisValues{}, AxisValues(kDefaults.begin(), kDefaults.end() - 1)}) {
    const GateReport report = check(after, makeBaseline(before, "because", "", stored), kDefaults);
    EXPECT_EQ(report.verdict, GateVerdict::pass);
    EXPECT_EQ(report.cells.size(), 9u);
    EXPECT_EQ(report.metricsCompared, 34u);
    EXPECT_EQ(report.costsCompared, 4u);
  }
}

TEST(Gate, BaselineFromBeforeAnAxis_DoesNotMatchItsOtherValues) {
  Results after = withAxis(runWith(0.5), "coats", "environment");
  const GateReport report = check(after, baselineOf(runWith(0.5)), kDefaults);
  EXPECT_EQ(report.verdict, GateVerdict::fail);
  ASSERT_EQ(report.findings.size(), 2u);
  EXPECT_EQ(report.findings[0].kind, FindingKind::missing);
  EXPECT_EQ(report.findings[0].cell, "scene=builtin:a camera=main frame=0 refresh=static");
  EXPECT_EQ(report.findings[1].kind, FindingKind::surplus);
  EXPECT_EQ(report.findings[1].cell, "scene=builtin:a camera=main frame=0 coats=environment refresh=static");
  EXPECT_EQ(report.metricsCompared, 0u);
}

TEST(Gate, RunFromBeforeAnAxis_MatchesItsDefault) {
  const Results run = samples::makeResults();
  const Baseline baseline = makeBaseline(withAxis(run, "coats", "none"), "because", "", kDefaults);
  EXPECT_EQ(check(run, baseline, kDefaults).verdict, GateVerdict::pass);
}

TEST(Gate, AxisThatTheProgramDoesNotKnow_DoesNotMatch) {
  const Results run = runWith(0.5);
  EXPECT_EQ(check(run, baselineOf(withAxis(run, "removed", "none")), kDefaults).verdict, GateVerdict::fail);
}

// The keys mean what they meant when they were written.
TEST(Gate, ChangedDefault_MatchesTheValueItHad) {
  const Results run = samples::makeResults();
  const Baseline baseline = makeBaseline(run, "because", "", {{"resolution", "64"}});
  EXPECT_EQ(check(run, baseline, {{"resolution", "128"}}).verdict, GateVerdict::pass);
}

TEST(Gate, CellsThatDifferByADefaultOnly_AreRefused) {
  Results run = runWith(0.5);
  run.cells.push_back(withAxis(run, "coats", "none").cells[0]);
  EXPECT_THAT(messageOf([&] { check(run, baselineOf(runWith(0.5)), kDefaults); }), HasSubstr("may stand once"));
}

TEST(Gate, FailedControl_FailsTheRun) {
  Results after = runWith(0.5);
  after.provenance.controlOutcome = "relMSE 1e-3 > 1e-5";
  const GateReport report = check(after, baselineOf(runWith(0.5)));
  EXPECT_EQ(report.verdict, GateVerdict::fail);
  EXPECT_EQ(report.findings.at(0).kind, FindingKind::control);
}

TEST(Gate, ChangedSuiteAndScene_AreNoted) {
  Results after = runWith(0.5);
  after.provenance.suiteHash = "beef";
  after.provenance.sceneHashes["builtin:a"] = "bbbb";
  const GateReport report = check(after, baselineOf(runWith(0.5)));
  EXPECT_EQ(report.verdict, GateVerdict::pass);
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("suite has changed")));
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("'builtin:a'")));
}

}  // namespace
}  // namespace pb
