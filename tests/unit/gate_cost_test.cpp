#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/error_message.h"
#include "tests/unit/gate_fixture.h"

namespace pb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Costs of the samples: repetitions within 2 %. Of a plain frame of 200 ms 0.2 ms are nothing, of one of 4 ms 5 %, so
// that the limit is a factor of 1.3125, of one of 0.2 ms as much again: 2.5.
struct CostRule {
  const char* name;
  double before, after, plainMs;
  GateVerdict verdict;
};

class GateCostRule : public testing::TestWithParam<CostRule> {};

TEST_P(GateCostRule, GivesItsVerdict) {
  const CostRule& rule = GetParam();
  Results after = runWith(0.5, rule.after);
  after.cells[0].cost->plainMs = rule.plainMs;
  Results rerun = after;
  rerun.cells[0].cost->ratios[0] *= 1.001;  // another measurement, with the same medians
  EXPECT_EQ(check(after, baselineOf(runWith(0.5, rule.before)), {}, &rerun).verdict, rule.verdict);
}

INSTANTIATE_TEST_SUITE_P(Table, GateCostRule,
                         testing::Values(CostRule{"equal", 3.0, 3.0, 4, GateVerdict::pass},
                                         CostRule{"slower_by_24_percent", 3.0, 3.72, 200, GateVerdict::pass},
                                         CostRule{"slower_by_26_percent", 3.0, 3.78, 200, GateVerdict::fail},
                                         CostRule{"faster_by_a_factor_of_1_24", 3.72, 3.0, 200, GateVerdict::pass},
                                         CostRule{"faster_by_a_factor_of_1_26", 3.78, 3.0, 200, GateVerdict::fail},
                                         CostRule{"slower_by_30_percent_of_short", 3.0, 3.9, 4, GateVerdict::pass},
                                         CostRule{"slower_by_33_percent_of_short", 3.0, 3.99, 4, GateVerdict::fail},
                                         CostRule{"faster_by_1_30_of_short", 3.9, 3.0, 4, GateVerdict::pass},
                                         CostRule{"faster_by_1_33_of_short", 3.99, 3.0, 4, GateVerdict::fail},
                                         CostRule{"doubled_of_very_short", 3.0, 6.0, 0.2, GateVerdict::pass},
                                         CostRule{"tripled_of_very_short", 3.0, 9.0, 0.2, GateVerdict::fail}),
                         [](const auto& test) { return test.param.name; });

Results runWithRatios(double ratio, double spread) {
  Results run = runWith(0.5, ratio);
  run.cells[0].cost->ratios = samples::repetitionsAbout(ratio, spread);
  return run;
}

TEST(GateCost, ChangeThatChanceCanMake_IsNoFinding) {
  EXPECT_EQ(verdictOf(runWithRatios(3.0, 1.02), runWithRatios(6.0, 1.02)), GateVerdict::inconclusive);
  EXPECT_EQ(verdictOf(runWithRatios(3.0, 5.0), runWithRatios(6.0, 5.0)), GateVerdict::pass);
}

// Frame times of a loaded machine; the repetitions' processor times are as they were.
TEST(GateCost, LoadThatChangesFrameTimesOnly_IsNoFinding) {
  const Results before = runWithRatios(3.0, 1.02);
  Results loaded = runWithRatios(3.0, 1.02);
  loaded.cells[0].cost->ratio = 7;
  loaded.cells[0].cost->ratioLow = 6.8;
  loaded.cells[0].cost->ratioHigh = 7.2;
  EXPECT_EQ(verdictOf(before, loaded), GateVerdict::pass);
}

// Baselines from before they were stored have none; of five, an interval of the median has less than 95 %.
TEST(GateCost, OfFewerThanSixRepetitions_IsNotComparedAndSaysSo) {
  for (const std::size_t count : {0u, 5u}) {
    Results before = runWith(0.5, 3.0);
    before.cells[0].cost->ratios.resize(count);
    const GateReport report = check(runWith(0.5, 6.0), baselineOf(before));
    EXPECT_EQ(report.verdict, GateVerdict::pass);
    EXPECT_EQ(report.costsCompared, 0u);
    EXPECT_THAT(report.notes, testing::Contains(HasSubstr("a comparison wants 6 repetitions")));
  }
}

TEST(GateCost, SecondMeasurementOfFewRepetitions_ConfirmsNothing) {
  Results rerun = runWith(0.5, 6.0);
  rerun.cells[0].cost->ratios.resize(5);
  EXPECT_EQ(check(runWith(0.5, 6.0), baselineOf(runWith(0.5, 3.0)), {}, &rerun).verdict, GateVerdict::inconclusive);
}

TEST(GateCost, UnconfirmedChange_IsInconclusiveAndNamesTheSequence) {
  const Results after = runWith(0.5, 6.0);
  const GateReport report = check(after, baselineOf(runWith(0.5, 3.0)));
  EXPECT_EQ(report.verdict, GateVerdict::inconclusive);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].level, Level::unconfirmed);
  EXPECT_THAT(report.unconfirmedCosts(), testing::ElementsAre(after.cells[0].sequenceKey()));
}

struct Confirmation {
  const char* name;
  double second;  // ratio of the second measurement, where the baseline has 3 and the run 6
  GateVerdict verdict;
};

class GateConfirmation : public testing::TestWithParam<Confirmation> {};

TEST_P(GateConfirmation, GivesItsVerdict) {
  const Results rerun = runWith(0.5, GetParam().second);
  const GateReport report = check(runWith(0.5, 6.0), baselineOf(runWith(0.5, 3.0)), {}, &rerun);
  EXPECT_EQ(report.verdict, GetParam().verdict);
  EXPECT_EQ(report.notes.size(), report.verdict == GateVerdict::pass ? 1u : 0u);  // "... did not confirm ..."
}

INSTANTIATE_TEST_SUITE_P(Table, GateConfirmation,
                         testing::Values(Confirmation{"as_slow", 6.01, GateVerdict::fail},
                                         Confirmation{"also_slower", 4.0, GateVerdict::fail},
                                         Confirmation{"as_before", 3.0, GateVerdict::pass},
                                         Confirmation{"within_the_floor", 3.6, GateVerdict::pass},
                                         Confirmation{"the_other_way", 1.5, GateVerdict::pass}),
                         [](const auto& test) { return test.param.name; });

TEST(GateCost, SecondMeasurementWithoutTheSequence_ConfirmsNothing) {
  Results rerun = runWith(0.5, 6.0);
  rerun.cells.clear();
  EXPECT_EQ(check(runWith(0.5, 6.0), baselineOf(runWith(0.5, 3.0)), {}, &rerun).verdict, GateVerdict::inconclusive);
}

TEST(GateCost, SecondMeasurementOfAnotherProgramSuiteOrMachine_IsRefused) {
  const Results run = runWith(0.5, 6.0);
  const Baseline baseline = baselineOf(runWith(0.5, 3.0));
  for (std::string Provenance::*member :
       {&Provenance::gitHash, &Provenance::suiteHash, &Provenance::cpu, &Provenance::glRenderer}) {
    Results rerun = run;
    rerun.provenance.*member = "other";
    EXPECT_THAT(messageOf([&] { check(run, baseline, {}, &rerun); }), HasSubstr("the second measurement must be"));
  }
}

TEST(GateCost, RunInPlaceOfASecondMeasurement_IsRefused) {
  const Results run = runWith(0.5, 6.0);
  Results copy = run;
  copy.provenance.startedAt = "2027-01-01T00:00:00Z";  // a file that was edited is no measurement either
  const std::string message = messageOf([&] { check(run, baselineOf(runWith(0.5, 3.0)), {}, &copy); });
  EXPECT_THAT(message, HasSubstr("the second measurement must be another one, the repetitions of"));
}

// Logarithms of the repetitions have the standard deviation log(1.6) sqrt(4/5) = 0.42, means of six the error 0.172,
// their difference 0.243: log(6 / 3) is t = 2.86 at 10 degrees of freedom, p = 0.017, significant alone, not among 40.
TEST(GateCost, ManyComparisons_AreCorrected) {
  const auto withCosts = [](int count, double ratio) {
    Results run = runWithRatios(ratio, 1.6);
    for (int i = 1; i < count; ++i) {
      run.cells.push_back(run.cells[0]);
      run.cells.back().technique[0].second = std::to_string(1000 + i);
    }
    return run;
  };
  EXPECT_EQ(verdictOf(withCosts(1, 3.0), withCosts(1, 6.0)), GateVerdict::inconclusive);
  EXPECT_EQ(verdictOf(withCosts(40, 3.0), withCosts(40, 6.0)), GateVerdict::pass);
}

TEST(Gate, CostOfAnotherMachine_IsNotComparedAndSaysSo) {
  const Results before = runWith(0.5, 3.0);
  Results cpu = runWith(0.5, 9.0), threads = cpu, unmeasured = cpu;
  cpu.provenance.cpu = "other CPU";
  threads.provenance.threads = 64;
  unmeasured.cells[0].cost.reset();
  for (const auto& [run, why] :
       {std::pair{cpu, "other CPU"}, std::pair{threads, "64"}, std::pair{unmeasured, "this run did not measure it"}}) {
    const GateReport report = check(run, baselineOf(before));
    EXPECT_EQ(report.verdict, GateVerdict::pass);
    EXPECT_EQ(report.costsCompared, 0u);
    EXPECT_THAT(report.notes, testing::Contains(AllOf(HasSubstr("Cost was not compared"), HasSubstr(why))));
  }
}

TEST(Gate, CostMissingForOneSequence_Fails) {
  const Results before = samples::makeResults();
  Results after = before;
  for (CellResult& cell : after.cells)
    if (cell.sequenceKey() == before.cells[0].sequenceKey()) cell.cost.reset();
  const GateReport report = check(after, baselineOf(before));
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].kind, FindingKind::missing);
  EXPECT_EQ(report.findings[0].quantity, "cost");
}

}  // namespace
}  // namespace pb
