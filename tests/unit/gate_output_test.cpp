#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/unit/gate_fixture.h"

namespace pb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

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
  EXPECT_EQ(printGateReport(exampleReport(), {"probebench bless RUN", "unused"}),
            R"(fail: 9 cells, 3 differences; 30 metrics, 32 counters and 4 costs compared

| level | kind    | what      |   before |    after | may change by | cell                                                                            |
| ----- | ------- | --------- | -------: | -------: | ------------: | ------------------------------------------------------------------------------- |
| fail  | counter | triangles |   123456 |   123457 |             0 | scene=builtin:a camera=main frame=1 resolution=64 refresh=every-frame bounces=1 |
| fail  | missing | cell      |          |          |               | scene=builtin:a camera=main frame=0 resolution=64 refresh=static bounces=1      |
| fail  | changed | flip_hdr  | 0.200000 | 0.300000 |       0.00400 | scene=builtin:a camera=main frame=0 resolution=64 refresh=every-frame bounces=1 |

If this is as it should be: probebench bless RUN
)");
}

TEST(GateOutput, OfAPass_IsOneLine) {
  const Results run = samples::makeResults();
  EXPECT_EQ(printGateReport(check(run, baselineOf(run)), {"unused", "unused"}),
            "pass: 9 cells, 0 differences; 34 metrics, 36 counters and 4 costs compared\n");
}

TEST(GateOutput, Json_HoldsVerdictAndFindings) {
  const nlohmann::json json = nlohmann::json::parse(toJson(exampleReport()));
  EXPECT_EQ(json.at("verdict"), "fail");
  EXPECT_EQ(json.at("exit_code"), 1);
  ASSERT_EQ(json.at("findings").size(), 3u);
  const nlohmann::json& changed = json.at("findings").at(2);
  EXPECT_EQ(changed.at("kind"), "changed");
  EXPECT_EQ(changed.at("level"), "fail");
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

TEST(GateOutput, JUnit_SkipsThePlatformsTestOnDrift) {
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
  EXPECT_THAT(printGateReport(report, {"probebench bless RUN", "unused"}),
              AllOf(HasSubstr("inconclusive: 9 cells, 0 differences"), HasSubstr("* Noise: max_noise is 1e-05"),
                    Not(HasSubstr("bless"))));
  const nlohmann::json json = nlohmann::json::parse(toJson(report));
  EXPECT_EQ(json.at("verdict"), "inconclusive");
  EXPECT_EQ(json.at("noisy_cells").size(), 2u);
}

// A counter fails, a metric warns, a cost is not confirmed.
GateReport reportOfAllLevels() {
  Results before = runWith(0.5, 3.0);
  before.warnTolerance = {{"relmse", plain(1e-6, 0)}};
  Results after = runWith(0.501, 6.0);
  after.cells[0].counters[1].second += 1;
  return check(after, baselineOf(before));
}

TEST(GateOutput, Markdown_SaysHowToConfirmACost) {
  const std::string text = printGateReport(reportOfAllLevels(), {"BLESS", "probebench check RUN --rerun SUITE"});
  EXPECT_THAT(text, AllOf(HasSubstr("fail: 1 cell, 2 differences, 1 warning; "),
                          HasSubstr("a second measurement confirms it: probebench check RUN --rerun SUITE\n"),
                          HasSubstr("If this is as it should be: BLESS\n")));
}

TEST(GateOutput, JUnit_SkipsUnconfirmedCostsAndPrintsWarnings) {
  const std::string xml = toJUnit(reportOfAllLevels(), "quick");
  EXPECT_THAT(xml, AllOf(HasSubstr("failures=\"1\" errors=\"0\" skipped=\"1\""),
                         HasSubstr("<failure message=\"draws was 40, is 41, may change by 0\">"),
                         HasSubstr("<skipped message=\"unconfirmed: cost ratio was 3, is 6,"),
                         HasSubstr("<system-out>relmse was 0.500000, is 0.501000, may change by 1.00e-06 without a "
                                   "warning</system-out>")));
}

TEST(GateOutput, Annotations_AreErrorsForWhatFailsAndWarningsForTheRest) {
  const std::string text = toGitHubAnnotations(reportOfAllLevels());
  EXPECT_THAT(text, HasSubstr("::error title=probebench fail::draws was 40, is 41, may change by 0 (scene=builtin:a "));
  EXPECT_THAT(text, HasSubstr("::warning title=probebench warn::relmse was"));
  EXPECT_THAT(text, HasSubstr("::warning title=probebench unconfirmed::cost ratio was"));
}

TEST(GateOutput, Annotations_EscapeAndShowTenOfAKind) {
  GateReport report;
  for (int i = 0; i < 12; ++i) report.findings.push_back({FindingKind::control, "", "100 %\nof it", {}, {}, 0, 0});
  const std::string text = toGitHubAnnotations(report);
  EXPECT_THAT(text, HasSubstr("100 %25%0Aof it\n"));
  EXPECT_EQ(std::ranges::count(text, '\n'), 10);
}

}  // namespace
}  // namespace pb
