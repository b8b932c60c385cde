#include "bench/platform.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/gate_fixture.h"

namespace pb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(GatePlatform, OtherDriver_IsDriftWithoutCountersAndCosts) {
  const Results before = runWith(0.5);
  for (std::string Provenance::*member : {&Provenance::glRenderer, &Provenance::glVersion}) {
    Results other = before;
    other.provenance.*member = "other";
    other.cells[0].counters[1].second += 1;
    const GateReport report = check(other, baselineOf(before));
    EXPECT_EQ(report.verdict, GateVerdict::drift);
    EXPECT_EQ(report.countersCompared, 0u);
    EXPECT_EQ(report.costsCompared, 0u);
    EXPECT_THAT(report.notes, testing::Contains(AllOf(HasSubstr("Drift"), HasSubstr("is 'other', was"),
                                                      HasSubstr("Counters were not compared"))));
  }
}

TEST(GatePlatform, OtherLibrary_IsDriftWithExactCounters) {
  const Results before = runWith(0.5);
  Results other = before;
  other.provenance.libraries["Embree"] = "4.3.0";
  GateReport report = check(other, baselineOf(before));
  EXPECT_EQ(report.verdict, GateVerdict::drift);
  EXPECT_EQ(report.countersCompared, 4u);
  EXPECT_THAT(report.notes, testing::ElementsAre("Drift: Embree is '4.3.0', was '3.13.5'."));
  other.cells[0].counters[1].second += 1;
  report = check(other, baselineOf(before));
  EXPECT_EQ(report.verdict, GateVerdict::drift);
  EXPECT_EQ(report.findings.at(0).level, Level::drift);
}

TEST(GatePlatform, ChangedMetricThere_IsDriftAndNoRegression) {
  Results other = runWith(1.0);
  other.provenance.glVersion = "other";
  const GateReport report = check(other, baselineOf(runWith(0.5)));
  EXPECT_EQ(report.verdict, GateVerdict::drift);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].level, Level::drift);
}

// No driver makes a cell go away or the renderers disagree.
TEST(GatePlatform, MissingCellsAndAFailedControlThere_Fail) {
  Results missing = runWith(0.5), failed = missing;
  missing.provenance.glVersion = failed.provenance.glVersion = "other";
  missing.cells.clear();
  failed.provenance.controlOutcome = "relMSE 1e-3 > 1e-5";
  EXPECT_EQ(verdictOf(runWith(0.5), missing), GateVerdict::fail);
  EXPECT_EQ(verdictOf(runWith(0.5), failed), GateVerdict::fail);
}

TEST(GatePlatform, LibraryThatOneSideDoesNotName_IsNotCompared) {
  const Results before = runWith(0.5);
  Results more = before;
  more.provenance.libraries["meshoptimizer"] = "0.18";
  EXPECT_EQ(verdictOf(before, more), GateVerdict::pass);
  EXPECT_EQ(verdictOf(more, before), GateVerdict::pass);
}

}  // namespace
}  // namespace pb
