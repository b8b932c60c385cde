#include "bench/gate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "scenes/error.h"
#include "scenes/files.h"
#include "tests/temporary_folder.h"
#include "tests/unit/sample_results.h"

namespace pb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Tolerance plain(double absolute, double relative) { return {Tolerance::Kind::plain, absolute, relative, {}}; }
Tolerance any(std::vector<Tolerance> children) { return {Tolerance::Kind::any, 0, 0, std::move(children)}; }
Tolerance all(std::vector<Tolerance> children) { return {Tolerance::Kind::all, 0, 0, std::move(children)}; }

// One cell whose relMSE is `relmse` (the only gated metric) and that takes `ratio` plain frames of 4 ms.
Results runWith(double relmse, double ratio = 3.0) {
  Results run;
  run.provenance = samples::makeProvenance();
  run.tolerance = {{"relmse", plain(1e-3, 0.1)}};
  CellResult cell = samples::makeCell("builtin:a", 0, "64", "static", 0.1);
  cell.maskMetrics.reset();
  cell.metrics.sums.relmse = relmse;
  cell.cost = samples::makeCost(ratio);
  run.cells = {cell};
  return run;
}

Baseline baselineOf(const Results& run) { return makeBaseline(run, "because", "2026-01-31T12:00:00Z"); }

Verdict verdictOf(const Results& before, const Results& after) { return check(after, baselineOf(before)).verdict; }

std::string messageOf(auto function) {
  try {
    function();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::input);
    return error.what();
  }
  return "";
}

TEST(Tolerance, OfATree_IsItsLargestOrSmallestChild) {
  EXPECT_EQ(largestAllowedDelta(plain(0.5, 0.1), 2.0), 0.5);
  EXPECT_EQ(largestAllowedDelta(plain(0.5, 0.1), -20.0), 2.0);
  EXPECT_EQ(largestAllowedDelta(any({plain(1, 0), plain(3, 0), plain(2, 0)}), 0.0), 3.0);
  EXPECT_EQ(largestAllowedDelta(all({plain(2, 0), plain(1, 0), plain(3, 0)}), 0.0), 1.0);
  EXPECT_EQ(largestAllowedDelta(all({plain(4, 0), any({plain(1, 0), plain(2, 0)})}), 0.0), 2.0);
}

struct MetricRule {
  const char* name;
  Tolerance tolerance;
  double before, after;
  Verdict verdict;
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
    testing::Values(MetricRule{"equal", plain(0, 0), 0.5, 0.5, Verdict::pass},
                    MetricRule{"exact_is_exact", plain(0, 0), 0.5, std::nextafter(0.5, 1.0), Verdict::fail},
                    MetricRule{"within_absolute", plain(0.25, 0), 0.5, 0.75, Verdict::pass},
                    MetricRule{"beyond_absolute", plain(0.25, 0), 0.5, 0.76, Verdict::fail},
                    MetricRule{"better_beyond_absolute", plain(0.25, 0), 0.5, 0.24, Verdict::fail},
                    MetricRule{"within_relative", plain(0, 0.5), 0.5, 0.75, Verdict::pass},
                    MetricRule{"beyond_relative", plain(0, 0.5), 0.5, 0.76, Verdict::fail},
                    MetricRule{"better_beyond_relative", plain(0, 0.5), 0.5, 0.24, Verdict::fail},
                    MetricRule{"larger_of_both_counts", plain(0.3, 0.5), 0.5, 0.79, Verdict::pass},
                    MetricRule{"any_needs_one", any({plain(0.01, 0), plain(0, 0.5)}), 0.5, 0.7, Verdict::pass},
                    MetricRule{"any_fails_beyond_all", any({plain(0.01, 0), plain(0, 0.5)}), 0.5, 0.8, Verdict::fail},
                    MetricRule{"all_needs_every_one", all({plain(0.01, 0), plain(0, 0.5)}), 0.5, 0.7, Verdict::fail},
                    MetricRule{"all_passes_within_all", all({plain(0.01, 0), plain(0, 0.5)}), 0.5, 0.505,
                               Verdict::pass},
                    MetricRule{"nan_for_a_number", plain(9, 9), 0.5, kNan, Verdict::fail},
                    MetricRule{"number_for_a_nan", plain(9, 9), kNan, 0.5, Verdict::fail},
                    MetricRule{"nan_stays", plain(0, 0), kNan, kNan, Verdict::pass},
                    MetricRule{"infinity_for_a_number", plain(9, 9), 0.5, kInfinity, Verdict::fail},
                    MetricRule{"number_for_an_infinity", plain(9, 9), kInfinity, 0.5, Verdict::fail},
                    MetricRule{"infinity_stays", plain(0, 0), kInfinity, kInfinity, Verdict::pass},
                    MetricRule{"infinity_changes_sign", plain(9, 9), kInfinity, -kInfinity, Verdict::fail}),
    [](const auto& test) { return test.param.name; });

TEST(Gate, SameRun_PassesAndComparesEverything) {
  const Results run = samples::makeResults();
  const GateReport report = check(run, baselineOf(run));
  EXPECT_EQ(report.verdict, Verdict::pass);
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
  EXPECT_EQ(verdictOf(without, without), Verdict::pass);
  EXPECT_EQ(verdictOf(before, without), Verdict::fail);
  EXPECT_EQ(verdictOf(without, before), Verdict::fail);
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

TEST(Gate, MissingAndSurplusCells_BothFail) {
  const Results all = samples::makeResults();
  Results fewer = all;
  fewer.cells.erase(fewer.cells.begin() + 2);

  const GateReport missing = check(fewer, baselineOf(all));
  EXPECT_EQ(missing.verdict, Verdict::fail);
  ASSERT_EQ(missing.findings.size(), 1u);
  EXPECT_EQ(missing.findings[0].kind, FindingKind::missing);
  EXPECT_EQ(missing.findings[0].cell, all.cells[2].key());

  const GateReport surplus = check(all, baselineOf(fewer));
  EXPECT_EQ(surplus.verdict, Verdict::fail);
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
  EXPECT_EQ(verdictOf(samples::makeResults(), empty), Verdict::fail);
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
  EXPECT_EQ(verdictOf(before, fewer), Verdict::fail);
}

TEST(Gate, CounterThatTheBaselineLacks_IsNoted) {
  const Results after = runWith(0.5);
  Results before = after;
  before.cells[0].counters.pop_back();
  const GateReport report = check(after, baselineOf(before));
  EXPECT_EQ(report.verdict, Verdict::pass);
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
    EXPECT_EQ(report.verdict, Verdict::pass);
    EXPECT_EQ(report.cells.size(), 9u);
    EXPECT_EQ(report.metricsCompared, 34u);
    EXPECT_EQ(report.costsCompared, 4u);
  }
}

TEST(Gate, BaselineFromBeforeAnAxis_DoesNotMatchItsOtherValues) {
  Results after = withAxis(runWith(0.5), "coats", "environment");
  const GateReport report = check(after, baselineOf(runWith(0.5)), kDefaults);
  EXPECT_EQ(report.verdict, Verdict::fail);
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
  EXPECT_EQ(check(run, baseline, kDefaults).verdict, Verdict::pass);
}

TEST(Gate, AxisThatTheProgramDoesNotKnow_DoesNotMatch) {
  const Results run = runWith(0.5);
  EXPECT_EQ(check(run, baselineOf(withAxis(run, "removed", "none")), kDefaults).verdict, Verdict::fail);
}

// The keys mean what they meant when they were written.
TEST(Gate, ChangedDefault_MatchesTheValueItHad) {
  const Results run = samples::makeResults();
  const Baseline baseline = makeBaseline(run, "because", "", {{"resolution", "64"}});
  EXPECT_EQ(check(run, baseline, {{"resolution", "128"}}).verdict, Verdict::pass);
}

TEST(Gate, CellsThatDifferByADefaultOnly_AreRefused) {
  Results run = runWith(0.5);
  run.cells.push_back(withAxis(run, "coats", "none").cells[0]);
  EXPECT_THAT(messageOf([&] { check(run, baselineOf(runWith(0.5)), kDefaults); }), HasSubstr("may stand once"));
}

TEST(Gate, OtherDriver_IsDriftUnlessAMetricChanged) {
  const Results before = runWith(0.5);
  for (std::string Provenance::*member : {&Provenance::glRenderer, &Provenance::glVersion}) {
    Results other = before;
    other.provenance.*member = "other";
    other.cells[0].counters[1].second += 1;
    const GateReport report = check(other, baselineOf(before));
    EXPECT_EQ(report.verdict, Verdict::drift);
    EXPECT_EQ(report.countersCompared, 0u);
    EXPECT_EQ(report.costsCompared, 0u);
    EXPECT_THAT(report.notes, testing::Contains(AllOf(HasSubstr("Drift"), HasSubstr("other"))));

    other.cells[0].metrics.sums.relmse = 1.0;
    EXPECT_EQ(verdictOf(before, other), Verdict::fail);
  }
}

// `noise` is the relMSE of the reference's floor; the samples' max_noise is 1e-5.
Results withNoise(Results run, double noise) {
  for (CellResult& cell : run.cells) cell.floor = {{"mse", noise}, {"relmse", noise}};
  return run;
}

TEST(Gate, NoisyReference_IsInconclusiveUnlessSomethingChanged) {
  const Results before = runWith(0.5);
  Results noisy = withNoise(before, 3.21e-5);
  const GateReport report = check(noisy, baselineOf(before));
  EXPECT_EQ(report.verdict, Verdict::inconclusive);
  EXPECT_TRUE(report.findings.empty());
  EXPECT_THAT(report.noisyCells, testing::ElementsAre(noisy.cells[0].key()));
  noisy.cells[0].metrics.sums.relmse = 1.0;
  EXPECT_EQ(verdictOf(before, noisy), Verdict::fail);
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
  EXPECT_EQ(verdictOf(before, withNoise(before, 1e-5)), Verdict::pass);
  Results unlimited = withNoise(before, 1.0);
  unlimited.provenance.maxNoise.reset();
  EXPECT_EQ(verdictOf(unlimited, unlimited), Verdict::pass);
}

TEST(Gate, LoosenedMaxNoise_DoesNotPassUnnoticed) {
  const Results before = runWith(0.5);
  Results loosened = withNoise(before, 3.21e-5);
  for (const std::optional<double> limit : {std::optional(1.0), std::optional<double>()}) {
    loosened.provenance.maxNoise = limit;
    const GateReport report = check(loosened, baselineOf(before));
    EXPECT_EQ(report.verdict, Verdict::inconclusive);
    EXPECT_THAT(report.notes, testing::Contains(HasSubstr("in the baseline")));
  }
}

TEST(Gate, FailedControl_FailsTheRun) {
  Results after = runWith(0.5);
  after.provenance.controlOutcome = "relMSE 1e-3 > 1e-5";
  const GateReport report = check(after, baselineOf(runWith(0.5)));
  EXPECT_EQ(report.verdict, Verdict::fail);
  EXPECT_EQ(report.findings.at(0).kind, FindingKind::control);
}

// Costs of the samples: interval +-2 %, plain frame 4 ms, so that 0.2 ms are 0.05 of a ratio.
struct CostRule {
  const char* name;
  double before, after, plainMs;
  Verdict verdict;
};

class GateCostRule : public testing::TestWithParam<CostRule> {};

TEST_P(GateCostRule, GivesItsVerdict) {
  const CostRule& rule = GetParam();
  Results after = runWith(0.5, rule.after);
  after.cells[0].cost->plainMs = rule.plainMs;
  EXPECT_EQ(verdictOf(runWith(0.5, rule.before), after), rule.verdict);
}

INSTANTIATE_TEST_SUITE_P(Table, GateCostRule,
                         testing::Values(CostRule{"equal", 3.0, 3.0, 4, Verdict::pass},
                                         CostRule{"slower_by_24_percent", 3.0, 3.72, 4, Verdict::pass},
                                         CostRule{"slower_by_26_percent", 3.0, 3.78, 4, Verdict::fail},
                                         CostRule{"faster_by_a_factor_of_1_24", 3.72, 3.0, 4, Verdict::pass},
                                         CostRule{"faster_by_a_factor_of_1_26", 3.78, 3.0, 4, Verdict::fail},
                                         CostRule{"small_in_milliseconds", 1.0, 1.9, 0.2, Verdict::pass},
                                         CostRule{"no_longer_small", 1.0, 2.1, 0.2, Verdict::fail}),
                         [](const auto& test) { return test.param.name; });

TEST(Gate, CostWithOverlappingIntervals_IsNotSignificant) {
  const Results before = runWith(0.5, 3.0);
  Results after = runWith(0.5, 6.0);
  EXPECT_EQ(verdictOf(before, after), Verdict::fail);
  after.cells[0].cost->ratioLow = 3.0;
  EXPECT_EQ(verdictOf(before, after), Verdict::pass);
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
    EXPECT_EQ(report.verdict, Verdict::pass);
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

TEST(Gate, ChangedSuiteAndScene_AreNoted) {
  Results after = runWith(0.5);
  after.provenance.suiteHash = "beef";
  after.provenance.sceneHashes["builtin:a"] = "bbbb";
  const GateReport report = check(after, baselineOf(runWith(0.5)));
  EXPECT_EQ(report.verdict, Verdict::pass);
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("suite has changed")));
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("'builtin:a'")));
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
  EXPECT_EQ(exitCode(Verdict::pass), 0);
  EXPECT_EQ(exitCode(Verdict::fail), 1);
  EXPECT_EQ(exitCode(Verdict::inconclusive), 4);
  EXPECT_EQ(exitCode(Verdict::drift), 4);
}

// One of each: a metric, a counter, a missing cell.
GateReport exampleReport() {
  const Results before = samples::makeResults();
  Results after = before;
  after.cells[0].metrics.flipHdr->mean = 0.3;
  after.cells[1].counters[2].second = 123457;
  after.cells.erase(after.cells.begin() + 2);
  return check(after, baselineOf(before));
}

TEST(GateOutput, Markdown_ShowsBeforeAfterLimitAndHowToBless) {
  EXPECT_EQ(printGateReport(exampleReport(), "probebench bless RUN"),
            R"(fail: 9 cells, 3 differences; 30 metrics, 32 counters and 4 costs compared

| kind    | what      |   before |    after | may change by | cell                                                                            |
| ------- | --------- | -------: | -------: | ------------: | ------------------------------------------------------------------------------- |
| counter | triangles |   123456 |   123457 |             0 | scene=builtin:a camera=main frame=1 resolution=64 refresh=every-frame bounces=1 |
| missing | cell      |          |          |               | scene=builtin:a camera=main frame=0 resolution=64 refresh=static bounces=1      |
| changed | flip_hdr  | 0.200000 | 0.300000 |       0.00400 | scene=builtin:a camera=main frame=0 resolution=64 refresh=every-frame bounces=1 |

If this is as it should be: probebench bless RUN
)");
}

TEST(GateOutput, OfAPass_IsOneLine) {
  const Results run = samples::makeResults();
  EXPECT_EQ(printGateReport(check(run, baselineOf(run)), "unused"),
            "pass: 9 cells, 0 differences; 34 metrics, 36 counters and 4 costs compared\n");
}

TEST(GateOutput, Json_HoldsVerdictAndFindings) {
  const nlohmann::json json = nlohmann::json::parse(toJson(exampleReport()));
  EXPECT_EQ(json.at("verdict"), "fail");
  EXPECT_EQ(json.at("exit_code"), 1);
  ASSERT_EQ(json.at("findings").size(), 3u);
  const nlohmann::json& changed = json.at("findings").at(2);
  EXPECT_EQ(changed.at("kind"), "changed");
  EXPECT_EQ(changed.at("before"), 0.2);
  EXPECT_EQ(changed.at("after"), 0.3);
  EXPECT_NEAR(changed.at("limit").get<double>(), 0.004, 1e-12);
  EXPECT_EQ(json.at("findings").at(1).at("before"), nullptr);
  EXPECT_EQ(json.at("findings").at(1).at("excess"), "inf");
}

TEST(GateOutput, JUnit_HasOneTestCaseACell) {
  const std::string xml = toJUnit(exampleReport(), "quick & \"dirty\"");
  EXPECT_THAT(xml,
              HasSubstr("<testsuite name=\"quick &amp; &quot;dirty&quot;\" tests=\"12\" failures=\"3\" errors=\"0\" "
                        "skipped=\"0\">"));
  EXPECT_THAT(xml, HasSubstr("<failure message=\"flip_hdr was 0.200000, is 0.300000, may change by 0.00400\">"));
  EXPECT_THAT(xml, HasSubstr("<testcase classname=\"probebench\" name=\"control\"/>"));
  EXPECT_THAT(xml, Not(HasSubstr("<skipped")));
}

TEST(GateOutput, JUnit_SkipsTheDriverTestOnDrift) {
  Results other = runWith(0.5);
  other.provenance.glVersion = "other";
  const std::string xml = toJUnit(check(other, baselineOf(runWith(0.5))), "quick");
  EXPECT_THAT(xml, AllOf(HasSubstr("failures=\"0\""), HasSubstr("skipped=\"1\""), HasSubstr("<skipped message=\"")));
}

TEST(GateOutput, OfNoise_NamesItAndDoesNotOfferToBless) {
  const Results before = samples::makeResults();
  Results noisy = before;
  noisy.cells[0].floor = {{"relmse", 1.0}};
  noisy.cells[1].floor = {{"relmse", 1.0}};
  noisy.cells[1].counters[0].second += 1;
  const GateReport failing = check(noisy, baselineOf(before));
  EXPECT_THAT(toJUnit(failing, "quick"), AllOf(HasSubstr("failures=\"1\""), HasSubstr("skipped=\"1\""),
                                               HasSubstr("<skipped message=\"within tolerance")));
  noisy.cells[1].counters = before.cells[1].counters;
  const GateReport report = check(noisy, baselineOf(before));
  EXPECT_THAT(printGateReport(report, "probebench bless RUN"),
              AllOf(HasSubstr("inconclusive: 9 cells, 0 differences"), HasSubstr("* Noise: max_noise is 1e-05"),
                    Not(HasSubstr("bless"))));
  const nlohmann::json json = nlohmann::json::parse(toJson(report));
  EXPECT_EQ(json.at("verdict"), "inconclusive");
  EXPECT_EQ(json.at("noisy_cells").size(), 2u);
}

TEST(Baseline, FromBeforeMaxNoiseWasStored_IsRead) {
  nlohmann::ordered_json document = nlohmann::ordered_json::parse(toJson(baselineOf(samples::makeResults())));
  document["provenance"].erase("max_noise");
  EXPECT_FALSE(baselineFromJson(document.dump(), "b.json").provenance.maxNoise.has_value());
}

TEST(Baseline, JsonRoundTrip_IsExactAndGatesAlike) {
  const Results run = samples::makeResults();
  const std::string text = toJson(baselineOf(run));
  const Baseline read = baselineFromJson(text, "memory");
  EXPECT_EQ(toJson(read), text);
  EXPECT_EQ(read.reason, "because");
  EXPECT_EQ(read.tolerance, run.tolerance);
  EXPECT_EQ(read.provenance.maxNoise, run.provenance.maxNoise);
  EXPECT_EQ(check(run, read).verdict, Verdict::pass);
}

TEST(Baseline, NamesOnlyAxesThatAreNotAtTheirDefault) {
  const Baseline written = makeBaseline(samples::makeResults(), "because", "2026-01-31T12:00:00Z", kDefaults);
  EXPECT_EQ(written.cells[0].key, "scene=builtin:a camera=main frame=0");
  EXPECT_EQ(written.cells[6].key, "scene=builtin:a camera=main frame=0 resolution=128 refresh=static");
  EXPECT_TRUE(written.costs.contains("scene=builtin:a camera=main resolution=128"));
  EXPECT_EQ(baselineFromJson(toJson(written), "memory").defaults, kDefaults);
}

TEST(Baseline, FromBeforeDefaultsWereStored_IsRead) {
  nlohmann::ordered_json document = nlohmann::ordered_json::parse(toJson(baselineOf(samples::makeResults())));
  document.erase("defaults");
  EXPECT_TRUE(baselineFromJson(document.dump(), "b.json").defaults.empty());
}

TEST(Baseline, HoldsGatedMetricsOnly) {
  const std::string text = toJson(baselineOf(samples::makeResults()));
  EXPECT_THAT(text, AllOf(HasSubstr("flip_hdr"), HasSubstr("relmse"), Not(HasSubstr("smape"))));
}

// A few hundred cells must stay well under 1 MB in version control.
TEST(Baseline, TakesLessThanAKilobyteACell) {
  Results run = samples::makeResults();
  const std::size_t few = toJson(baselineOf(run)).size(), fewCells = run.cells.size();
  for (int frame = 2; frame < 102; ++frame)
    run.cells.push_back(samples::makeCell("builtin:a", frame, "64", "every-frame", 0.1 / frame));
  EXPECT_LT((toJson(baselineOf(run)).size() - few) / (run.cells.size() - fewCells), 1024u);
}

TEST(Baseline, EditedByHand_IsRefused) {
  const std::string text = toJson(baselineOf(samples::makeResults()));
  const auto refusalOf = [&](const char* pointer, const char* value) {
    nlohmann::ordered_json document = nlohmann::ordered_json::parse(text);
    document[nlohmann::ordered_json::json_pointer(pointer)] = nlohmann::ordered_json::parse(value);
    return messageOf([&] { baselineFromJson(document.dump(), "b.json"); });
  };
  EXPECT_THAT(refusalOf("/baseline_version", "2"), HasSubstr("'b.json' has baseline_version 2"));
  EXPECT_THAT(refusalOf("/reason", "\"\""), HasSubstr("at /reason"));
  EXPECT_THAT(refusalOf("/provenance/threads", "\"two\""), HasSubstr("at /provenance/threads"));
  EXPECT_THAT(refusalOf("/cells/0/counters/draws", "-1"), HasSubstr("at /cells/0/counters/draws"));
  EXPECT_THAT(refusalOf("/cells/0/metrics", "{}"), HasSubstr("exactly the metrics that have a tolerance"));
  EXPECT_THAT(refusalOf("/cells/0/mask_metrics", "{}"), HasSubstr("exactly the metrics that have a tolerance"));
  EXPECT_THAT(refusalOf("/tolerance/flipp", R"({"absolute": 1, "relative": 0})"), HasSubstr("'flipp'"));
  EXPECT_THAT(messageOf([] { baselineFromJson(toJson(samples::makeResults()), "b.json"); }),
              HasSubstr("not a probebench baseline"));
}

class Bless : public testing::Test {
 protected:
  TemporaryFolder folder_;
  const std::string path_ = folder_.file("baseline.json");
};

TEST_F(Bless, WritesWhatCheckPasses) {
  const Results run = samples::makeResults();
  bless(run, path_, "first", false);
  EXPECT_EQ(readBaseline(path_).reason, "first");
  EXPECT_EQ(check(run, readBaseline(path_)).verdict, Verdict::pass);
  bless(run, path_, "second", false);
  EXPECT_EQ(readBaseline(path_).reason, "second");
}

TEST_F(Bless, RefusesWithoutAReason) {
  for (const char* reason : {"", " \t\n"})
    EXPECT_THAT(messageOf([&] { bless(samples::makeResults(), path_, reason, true); }), HasSubstr("needs a reason"));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(Bless, RefusesAFailedControlAndAnEmptyRun) {
  Results failed = samples::makeResults(), empty = failed;
  failed.provenance.controlOutcome = "failed";
  empty.cells.clear();
  EXPECT_THAT(messageOf([&] { bless(failed, path_, "why", true); }), HasSubstr("control"));
  EXPECT_THAT(messageOf([&] { bless(empty, path_, "why", true); }), HasSubstr("without cells"));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(Bless, RefusesASuiteWithoutTolerances) {
  Results run = samples::makeResults();
  run.tolerance.clear();
  EXPECT_THAT(messageOf([&] { bless(run, path_, "why", true); }), HasSubstr("no [tolerance]"));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(Bless, RefusesAnotherDriverUnlessForced) {
  Results run = samples::makeResults();
  bless(run, path_, "first", false);
  run.provenance.glRenderer = "other GPU";
  EXPECT_THAT(messageOf([&] { bless(run, path_, "second", false); }),
              AllOf(HasSubstr("other GPU"), HasSubstr("llvmpipe"), HasSubstr("--force")));
  EXPECT_EQ(readBaseline(path_).reason, "first");
  bless(run, path_, "second", true);
  EXPECT_EQ(readBaseline(path_).reason, "second");
}

TEST_F(Bless, RefusesNoisyReferencesUnlessForced) {
  const Results noisy = withNoise(samples::makeResults(), 3.21e-5);
  try {
    bless(noisy, path_, "why", false);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::inconclusive);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("max_noise is 1e-05"), HasSubstr("3 references"),
                                    HasSubstr("'builtin:a' frame 0 with 3.21e-05"), HasSubstr("--force")));
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
  bless(noisy, path_, "why", true);
  EXPECT_EQ(check(noisy, readBaseline(path_)).verdict, Verdict::inconclusive);
}

TEST_F(Bless, ReplacesADamagedBaselineOnlyByForce) {
  writeFileAtomically(path_, "{");
  EXPECT_THAT(messageOf([&] { bless(samples::makeResults(), path_, "why", false); }), HasSubstr("truncated"));
  bless(samples::makeResults(), path_, "why", true);
  EXPECT_EQ(readBaseline(path_).reason, "why");
}

}  // namespace
}  // namespace pb
