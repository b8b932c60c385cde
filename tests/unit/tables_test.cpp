#include "bench/tables.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bench/report.h"
#include "bench/sections.h"
#include "tests/unit/sample_results.h"

namespace pb {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(Table, IsAlignedMarkdown) {
  const Table table{{{"axis", Align::left}, {"x"}}, {{"64", "0.5"}, {"every-frame", "12345"}}};
  EXPECT_EQ(toMarkdown(table),
            "| axis        |     x |\n"
            "| ----------- | ----: |\n"
            "| 64          |   0.5 |\n"
            "| every-frame | 12345 |\n");
}

TEST(Table, CountsCodePointsAndEscapesBars) {
  const Table table{{{"name", Align::left}}, {{"caf\xc3\xa9"}, {"a|b"}, {"two\nlines"}}};
  EXPECT_EQ(toMarkdown(table),
            "| name      |\n"
            "| --------- |\n"
            "| caf\xc3\xa9      |\n"
            "| a\\|b      |\n"
            "| two lines |\n");
}

TEST(EscapeMarkdown, LeavesNoElementCodeOrLink) {
  const std::pair<const char*, const char*> cases[] = {{"</script><img src=x>", "\\</script>\\<img src=x>"},
                                                       {"`code`", "\\`code\\`"},
                                                       {"[text](target)", "[text]\\(target)"},
                                                       {"two\nlines", "two lines"},
                                                       {"builtin:mirrors?count=2 < 0.1 [0.1, 0.2] (a) face_age",
                                                        "builtin:mirrors?count=2 < 0.1 [0.1, 0.2] (a) face_age"}};
  for (const auto& [text, escaped] : cases) EXPECT_EQ(escapeMarkdown(text), escaped);
}

TEST(FormatSignificant, KeepsThreeDigits) {
  const std::pair<double, const char*> cases[] = {{0.0, "0"},
                                                  {0.01234, "0.0123"},
                                                  {0.5, "0.500"},
                                                  {1.0, "1.00"},
                                                  {-12.34, "-12.3"},
                                                  {123.4, "123"},
                                                  {12345.6, "12346"},
                                                  {1234567.0, "1.23e+06"},
                                                  {1.234e-5, "1.23e-05"},
                                                  {0.0001234, "0.000123"},
                                                  {std::numeric_limits<double>::quiet_NaN(), "-"},
                                                  {std::numeric_limits<double>::infinity(), "inf"}};
  for (const auto& [value, text] : cases) EXPECT_EQ(formatSignificant(value), text);
}

TEST(FormatUncertainty, NeverContradictsTheInterval) {
  struct Case {
    Estimate estimate;
    const char* text;
  };
  const Case cases[] = {{Estimate::exact(0.2), ""},
                        {{0.2, 0.19, 0.21}, " +- 0.01"},
                        {{0.002, 0.0001, 0.005}, " [0.000100, 0.00500]"},         // one-sided: +- 0.003 would hold 0
                        {{0.00251, 0.00001, 0.00501}, " [1.00e-05, 0.00501]"},    // +- 0.003 by rounding
                        {{0.00241, -0.00001, 0.00483}, " [-1.00e-05, 0.00483]"},  // +- 0.002 by rounding
                        {{-0.01, -0.03, 0.01}, " +- 0.02"},
                        {Estimate::unknown(0.2), " (interval not known)"}};
  for (const auto& [estimate, text] : cases) EXPECT_EQ(formatUncertainty(estimate), text);
}

TEST(Sections, GroupScenesAndFramesInTheOrderOfTheRun) {
  const Results results = samples::makeResults();
  const std::vector<Section> sections = sectionsOf(results.cells);
  ASSERT_EQ(sections.size(), 2u);
  const Section& a = sections[0];
  EXPECT_EQ(a.sequences.size(), 4u);
  EXPECT_EQ(a.sequences[0].size(), 2u);
  ASSERT_EQ(a.axes.size(), 2u);
  EXPECT_THAT(a.axes[0].values, ElementsAre("64", "128"));
  EXPECT_THAT(a.axes[1].values, ElementsAre("every-frame", "static"));
  EXPECT_THAT(a.fixed, ElementsAre("bounces=1"));
  EXPECT_EQ(a.region, Region::mask);
  EXPECT_TRUE(a.severalFrames);
  EXPECT_TRUE(sections[1].axes.empty());
  EXPECT_EQ(sections[1].region, Region::whole);
  EXPECT_FALSE(sections[1].severalFrames);
}

TEST(Sections, MeanAndWorstAreOverTheFrames) {
  const Results results = samples::makeResults();
  const Sequence sequence = sectionsOf(results.cells)[0].sequences[0];
  // HDR-FLIP of the samples is 2 * 4 * error on the mask, errors 0.1 and 0.09.
  EXPECT_DOUBLE_EQ(meanError(sequence, Region::mask, "flip_hdr"), 8 * 0.095);
  EXPECT_DOUBLE_EQ(largestError(sequence, Region::mask, "flip_hdr"), 8 * 0.1);
  EXPECT_EQ(meanCounter(sequence, "draws"), 40.0);
  EXPECT_TRUE(std::isnan(meanCounter(sequence, "unknown")));
  EXPECT_EQ(meanFaceAge(sequence), 15.0 / 11.0) << "over the faces that are captured";
  EXPECT_EQ(largestFaceAge(sequence), 5);
}

TEST(Sections, UndefinedErrors_AreLeftOutOfMeans) {
  Results results = samples::makeResults();
  results.cells[0].maskMetrics->flipHdr.reset();
  const Sequence sequence = sectionsOf(results.cells)[0].sequences[0];
  EXPECT_DOUBLE_EQ(meanError(sequence, Region::mask, "flip_hdr"), 8 * 0.09);
  EXPECT_DOUBLE_EQ(largestError(sequence, Region::mask, "flip_hdr"), 8 * 0.09);
}

TEST(Sections, ErrorIsClearOfTheFloorFromTenTimesOn) {
  CellResult cell = samples::makeCell("a", 0, "64", "static", 0.1);
  cell.maskMetrics->sums.relmse = 1e-5;
  for (const auto& [floor, clear] : {std::pair{0.9e-6, true}, std::pair{1.1e-6, false}}) {
    cell.maskFloor = {{"relmse", floor}};
    EXPECT_EQ(isClearOfFloor({&cell}, Region::mask), clear);
  }
  EXPECT_TRUE(isClearOfFloor({&cell}, Region::whole));
  cell.maskFloor.clear();
  EXPECT_TRUE(isClearOfFloor({&cell}, Region::mask));
}

TEST(Report, LeavesOutAxesThatStandAtTheirDefaults) {
  const Results results = samples::makeResults();  // bounces = 1 throughout
  EXPECT_THAT(makeReport(results, {{"bounces", "1"}}),
              HasSubstr("\n\nAxes that don't vary stand at their defaults.\n\n"));
  EXPECT_THAT(makeReport(results, {{"bounces", "2"}}), HasSubstr("\n\nFixed in the whole run: bounces=1.\n\n"));
}

TEST(Report, ShowsOneTableAQuestion) {
  const std::string report = makeReport(samples::makeResults());
  EXPECT_THAT(report, HasSubstr("\n\nFixed in the whole run: bounces=1.\n\n## builtin:a, camera main\n\nframes 0 1\n"));
  // Frames have errors 8 e and 8 * 0.9 e with e = 0.1 * 0.81^row: mean 7.6 e, worst 8 e.
  EXPECT_THAT(report, HasSubstr("### Error versus resolution\n\n"
                                "FLIP-HDR on the mask, mean over the frames (worst frame)\n\n"
                                "| resolution | refresh=every-frame | refresh=static |\n"
                                "| ---------- | ------------------: | -------------: |\n"
                                "| 64         |       0.760 (0.800) |  0.616 (0.648) |\n"
                                "| 128        |       0.499 (0.525) |  0.404 (0.425) |\n"));
  EXPECT_THAT(report, HasSubstr("### Cost versus refresh\n\n"
                                "frame time as a multiple of a plain frame\n\n"
                                "| refresh     | resolution=64 | resolution=128 |\n"
                                "| ----------- | ------------: | -------------: |\n"
                                "| every-frame |          3.00 |           3.00 |\n"
                                "| static      |          1.11 |           1.11 |\n"));
}

TEST(Report, FixesOtherAxesAtTheLargestNumberOrTheFirstValue) {
  Results results;
  for (const char* resolution : {"256", "1024", "64"})
    for (const char* refresh : {"static", "every-frame"})
      for (const char* bounces : {"1", "2"}) {
        CellResult cell = samples::makeCell("a", 0, resolution, refresh, 0.1);
        cell.technique[2].second = bounces;
        results.cells.push_back(cell);
      }
  const std::string report = makeReport(results);
  EXPECT_THAT(report, HasSubstr("### Error versus resolution\n\nFLIP-HDR on the mask, bounces=2\n"));
  EXPECT_THAT(report, HasSubstr("### Error versus refresh\n\nFLIP-HDR on the mask, resolution=1024\n"));
  EXPECT_THAT(report, HasSubstr("### Error versus bounces\n\nFLIP-HDR on the mask, refresh=static\n"));
}

TEST(Report, ShowsModelAndMeasuredRendersSideBySide) {
  EXPECT_THAT(makeReport(samples::makeResults()), HasSubstr("6*N*B+1 = 13 |       13 |"));
}

TEST(Report, ShowsTheTimesOfPasses) {
  EXPECT_THAT(makeReport(samples::makeResults()),
              HasSubstr("| shadow ms | capture ms by bounce | prefilter ms | final ms |\n"));
  EXPECT_THAT(makeReport(samples::makeResults()),
              HasSubstr("|    0.0625 |        0.500 + 0.250 |        0.125 |     3.50 |\n"));
}

TEST(Report, SaysOnceWhatIsFixedInTheWholeRun) {
  const std::string report = makeReport(samples::makeResults());
  EXPECT_EQ(report.find("bounces=1"), report.rfind("bounces=1"));
  EXPECT_THAT(report, HasSubstr("## builtin:b, camera main\n\nframe 0; resolution=64, refresh=every-frame\n"));
}

TEST(Report, SaysWhatServesCoatsWhereThereAreAny) {
  Results results = samples::makeResults();
  EXPECT_THAT(makeReport(results), Not(HasSubstr("coats from a probe")));
  for (CellResult& cell : results.cells) {
    cell.counters.emplace_back("coats_from_probe", 3);
    cell.counters.emplace_back("coats_from_environment", 0);
  }
  EXPECT_THAT(makeReport(results), HasSubstr("| coats from a probe | from the environment |\n"));
  EXPECT_THAT(makeReport(results), HasSubstr("|                  3 |                    0 |\n"));
}

TEST(Report, MarksErrorsThatAreNotClearOfTheFloor) {
  Results results = samples::makeResults();
  EXPECT_THAT(makeReport(results), Not(HasSubstr(" ~ ")));
  results.cells[0].maskFloor = {{"relmse", 0.01}};
  const std::string report = makeReport(results);
  EXPECT_THAT(report, HasSubstr("| 64         |     0.760 ~ (0.800) |"));
  EXPECT_THAT(report, HasSubstr("|       0.760 ~ |"));
}

TEST(Report, OfASceneWithoutMaskOrCost_LeavesThemOut) {
  Results results = samples::makeResults();
  results.cells.erase(results.cells.begin(), results.cells.begin() + 8);
  const std::string report = makeReport(results);
  EXPECT_THAT(report, HasSubstr("FLIP-HDR whole"));
  EXPECT_THAT(report, Not(HasSubstr("FLIP-HDR mask")));
  EXPECT_THAT(report, Not(HasSubstr("versus")));
  EXPECT_THAT(report, Not(HasSubstr("All costs")));
}

// Of the samples' two frames: 8 e and 7.2 e with e = 0.1, so p95 is the worst of them.
TEST(Report, ShowsPercentilesOfErrorsOverTheFrames) {
  EXPECT_THAT(makeReport(samples::makeResults()),
              testing::ContainsRegex("FLIP-HDR mask \\|   p95 \\| worst \\| relMSE mask \\| +p95 \\| +worst \\|"));
  EXPECT_THAT(makeReport(samples::makeResults()),
              HasSubstr("| 64         | every-frame |         0.760 | 0.800 | 0.800 |"));
}

TEST(Report, ShowsFlickerAndErrorsByAge) {
  Results results = samples::makeResults();
  results.cells[1].flicker = Flicker{0.25, 0.5};
  const std::string report = makeReport(results);
  EXPECT_THAT(report, HasSubstr("### Over time\n\nof the mask;"));
  EXPECT_THAT(report, testing::ContainsRegex("every-frame \\| +0.500 \\| +0.500 \\| +0.500 \\| +0 \\| 1: 0.760 "));
}

TEST(Report, ShowsPeaksOfTheFrameTime) {
  // 12 ms in the median: 1.5, 1.75 and 2 times as much.
  EXPECT_THAT(makeReport(samples::makeResults()),
              HasSubstr("| 64         | every-frame |   12.0 |   18.0 |   21.0 |     24.0 |        2.00 |\n"));
}

TEST(Report, ShowsErrorsAgainstTheTruthOfAsManyBounces) {
  Results results = samples::makeResults();
  for (CellResult& cell : results.cells) cell.matched.reset();
  EXPECT_THAT(makeReport(results), Not(HasSubstr("own number of bounces")));
  for (int frame : {0, 1}) results.cells[static_cast<std::size_t>(frame)].matched = samples::makeMatched(0.1);
  EXPECT_THAT(makeReport(results), testing::ContainsRegex("every-frame \\| +2 \\| +0.400 \\| +0.760 \\|"));
}

TEST(Report, ShowsObjectsAndClustersOfTheBestTechnique) {
  Results results = samples::makeResults();
  for (CellResult& cell : results.cells) {
    cell.objects = samples::makeObjects();
    cell.clusters = {{4, 8, 15, 16, 23, 0.42, "ball"}};
  }
  const std::string report = makeReport(results);
  EXPECT_THAT(report, HasSubstr("### Errors by object\n\nframe 1, technique of the smallest error, resolution=128"));
  EXPECT_THAT(report, HasSubstr("| ball        | chrome   |    120 | 75.0 % |"));
  EXPECT_THAT(report, HasSubstr("| ball   | 42.0 % |     23 |      4, 8 | 15 x 16 |\n"));
}

TEST(Report, GivesVerdictsOnlyWhereTheNoiseIsKnown) {
  Results results;
  for (const auto& [resolution, error] : {std::pair{"64", 0.2}, {"128", 0.1}, {"256", 0.11}, {"512", 0.3}}) {
    results.cells.push_back(samples::makeCell("a", 0, resolution, "static", error));
    results.cells.back().maskIntervals = {{"flip_hdr", {8 * error - 0.06, 8 * error + 0.06}}};
  }
  results.cells[3].maskIntervals.clear();
  const std::string report = makeReport(results);
  const auto verdict = [&](const char* resolution) {
    const std::size_t row = report.find(fmt::format("| {} ", resolution), report.find("### All errors"));
    return report.substr(row, report.find('\n', row) - row);
  };
  EXPECT_THAT(verdict("64"), HasSubstr("| worse "));
  EXPECT_THAT(verdict("128"), HasSubstr("| the best "));
  EXPECT_THAT(verdict("256"), HasSubstr("| equal within the interval "));
  EXPECT_THAT(verdict("512"), HasSubstr("| -  "));
  results.cells[3].maskFloor = {{"mse", 0.0}, {"relmse", 0.0}};  // a reference without noise: errors are exact
  results.cells[1].maskFloor = {{"mse", 0.0}, {"relmse", 0.0}};
  EXPECT_THAT(makeReport(results).find("| worse "), testing::Ne(makeReport(results).rfind("| worse ")));
}

TEST(Report, NamesInHeadingsAndBulletsStayText) {
  Results results = samples::makeResults();
  for (CellResult& cell : results.cells) cell.scene = "<img src=x onerror=alert(1)>";
  results.provenance.suiteName = "</script>";
  const std::string report = makeReport(results);
  EXPECT_THAT(report, HasSubstr("## \\<img src=x"));
  EXPECT_THAT(report, testing::StartsWith("# \\</script>: error"));
  EXPECT_THAT(report, Not(testing::ContainsRegex("[^\\\\]<img")));
}

TEST(Report, EndsWithTheCircumstances) {
  const std::string report = makeReport(samples::makeResults());
  const std::string end = report.substr(report.find("## Circumstances"));
  for (const char* text :
       {"0123abc", "feed", "2026-01-31T12:00:00Z", "18446744073709551615", "2 threads",
        "llvmpipe (LLVM 15.0.6, 256 bits)", "4.5 Mesa 22.3.6", "640x360", "aaaa", "3.13.5", "passed"})
    EXPECT_THAT(end, HasSubstr(text));
}

}  // namespace
}  // namespace pb
