// Two runs compared: verdicts, cells that only one of them has, and what the reports say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/report/brief.h"
#include "bench/report/comparison.h"
#include "bench/report/orders.h"

namespace pb {
namespace {

using testing::HasSubstr;

CellResult makeCell(const std::string& resolution, double error, std::optional<Interval> interval = std::nullopt) {
  CellResult cell;
  cell.scene = "builtin:mirrors";
  cell.camera = "Camera";
  cell.technique = {{"resolution", resolution}};
  cell.metrics.sums.relmse = error;
  if (interval) cell.intervals = {{"relmse", *interval}};
  return cell;
}

Results makeRun(std::vector<CellResult> cells) {
  Results results;
  results.provenance.suiteName = "small";
  results.cells = std::move(cells);
  return results;
}

const ComparedValue& valueOf(const ComparedCell& cell, const std::string& name) {
  return *std::ranges::find(cell.values, name, &ComparedValue::name);
}

Change changeOf(const CellResult& before, const CellResult& after, const std::string& name = "relmse") {
  return valueOf(compareRuns(makeRun({before}), makeRun({after})).cells.at(0), name).change;
}

TEST(Comparison, IntervalsThatOverlap_AreNoChange) {
  const CellResult before = makeCell("64", 1.0, Interval{0.9, 1.1});
  EXPECT_EQ(changeOf(before, makeCell("64", 1.15, Interval{1.05, 1.25})), Change::equal);
  EXPECT_EQ(changeOf(before, makeCell("64", 1.3, Interval{1.2, 1.4})), Change::worse);
  EXPECT_EQ(changeOf(before, makeCell("64", 0.7, Interval{0.6, 0.8})), Change::better);
}

// Values against the same reference without each of its two batches: they go up and down together.
CellResult againstReference(const std::string& hash, const std::string& resolution, double error) {
  CellResult cell = makeCell(resolution, error, Interval{error - 0.5, error + 0.5});
  cell.replicates = {{"relmse", {error - 0.04, error + 0.04}}};
  cell.referenceHash = hash;
  return cell;
}

TEST(Comparison, AgainstTheSameReference_IsPaired) {
  const CellResult before = againstReference("same", "64", 1.0), after = againstReference("same", "64", 1.125);
  const Comparison comparison = compareRuns(makeRun({before}), makeRun({after}));
  const ComparedValue& value = valueOf(comparison.cells.at(0), "relmse");
  EXPECT_EQ(value.change, Change::worse);
  ASSERT_TRUE(value.differenceInterval.has_value());
  EXPECT_NEAR(value.differenceInterval->low, 0.125, 1e-12);  // the noise is all in common
  EXPECT_EQ(changeOf(before, againstReference("another", "64", 1.125)), Change::equal);
}

// The page's Pareto front asks for it.
TEST(Orders, SayWhichTechniquesAreBetterForSure) {
  const std::vector<CellResult> cells = {againstReference("same", "64", 1.0), againstReference("same", "128", 1.125),
                                         againstReference("another", "256", 1.25)};
  const Json orders = ordersToJson(cells);
  ASSERT_EQ(orders.size(), 1u);
  EXPECT_EQ(orders[0]["metric"], "relmse");
  EXPECT_EQ(orders[0]["region"], "whole");
  EXPECT_EQ(orders[0]["cells"], Json::array({0, 1, 2}));
  EXPECT_EQ(orders[0]["better"], Json::array({"010", "000", "000"}));
}

TEST(Orders, WithoutNoise_AreThoseOfTheValues) {
  EXPECT_TRUE(ordersToJson({makeCell("64", 1.0, Interval{1, 1}), makeCell("128", 2.0, Interval{2, 2})}).empty());
}

TEST(Comparison, WithoutIntervals_ADifferenceHasNoVerdict) {
  EXPECT_EQ(changeOf(makeCell("64", 1.0), makeCell("64", 1.0)), Change::equal);
  EXPECT_EQ(changeOf(makeCell("64", 1.0), makeCell("64", 1.0001)), Change::changed);
  EXPECT_EQ(changeOf(makeCell("64", 1.0, Interval{0.9, 1.1}), makeCell("64", 2.0)), Change::changed);
}

TEST(Comparison, AgainstReferencesWithoutNoise_EveryDifferenceIsExact) {
  CellResult before = makeCell("64", 0.19), after = makeCell("64", 0.0);
  for (CellResult* cell : {&before, &after}) cell->floor = {{"mse", 0.0}, {"relmse", 0.0}};
  EXPECT_EQ(changeOf(before, after), Change::better);
  EXPECT_EQ(changeOf(after, before), Change::worse);
}

TEST(Comparison, ErrorsThatAreNotClearOfTheNoise_AreBelowTheFloor) {
  CellResult before = makeCell("64", 1e-5, Interval{0.9e-5, 1.1e-5}),
             after = makeCell("64", 2e-5, Interval{1.9e-5, 2.1e-5});
  for (CellResult* cell : {&before, &after}) cell->floor = {{"relmse", 1e-5}};
  EXPECT_EQ(changeOf(before, after), Change::belowFloor);
}

TEST(Comparison, CostsCountOnceASequence) {
  std::vector<CellResult> cells(3, makeCell("64", 1.0));
  for (int frame = 0; frame < 3; ++frame) {
    cells[static_cast<std::size_t>(frame)].frame = frame;
    cells[static_cast<std::size_t>(frame)].cost = CostResult();
  }
  const Comparison comparison = compareRuns(makeRun(cells), makeRun(cells));
  std::size_t costs = 0;
  for (const ComparedCell& cell : comparison.cells)
    costs += static_cast<std::size_t>(std::ranges::count(cell.values, "ratio", &ComparedValue::name));
  EXPECT_EQ(comparison.cells.size(), 3u);
  EXPECT_EQ(costs, 1u);
}

TEST(Comparison, OfCosts_UsesTheirIntervals) {
  const auto withCost = [](double ms, double low, double high) {
    CellResult cell = makeCell("64", 1.0);
    cell.cost = CostResult();
    cell.cost->frameMs = ms;
    cell.cost->frameMsLow = low;
    cell.cost->frameMsHigh = high;
    return cell;
  };
  EXPECT_EQ(changeOf(withCost(10, 9, 11), withCost(10.5, 9.5, 12), "frame_ms"), Change::equal);
  EXPECT_EQ(changeOf(withCost(10, 9, 11), withCost(14, 13, 15), "frame_ms"), Change::worse);
  EXPECT_EQ(changeOf(withCost(10, 9, 11), withCost(7, 6, 8), "frame_ms"), Change::better);
}

TEST(Comparison, CellsOfOneRunOnly_AreCounted) {
  const Comparison comparison = compareRuns(makeRun({makeCell("64", 1), makeCell("128", 1), makeCell("256", 1)}),
                                            makeRun({makeCell("128", 2), makeCell("512", 1)}));
  ASSERT_EQ(comparison.cells.size(), 1u);
  EXPECT_EQ(comparison.cells[0].before, 1u);
  EXPECT_EQ(comparison.cells[0].after, 0u);
  EXPECT_EQ(comparison.onlyBefore, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(comparison.onlyAfter, (std::vector<std::size_t>{1}));
}

TEST(Comparison, AxesThatStandElsewhereOrAreNew_AreCircumstances) {
  Results before = makeRun({makeCell("64", 1), makeCell("128", 1)}),
          after = makeRun({makeCell("64", 2), makeCell("128", 3)});
  for (CellResult& cell : before.cells) cell.technique.emplace_back("filter", "none");
  for (CellResult& cell : after.cells) {
    cell.technique.emplace_back("filter", "ggx-prefiltered");
    cell.technique.emplace_back("storage", "cube");
  }
  EXPECT_EQ(compareRuns(before, after).cells.size(), 2u);
  EXPECT_EQ(valueOf(compareRuns(before, after).cells.at(1), "relmse").after, 3);
  const std::string text = makeComparisonReport(before, after, {});
  EXPECT_THAT(text, testing::ContainsRegex("axis filter +\\| none +\\| ggx-prefiltered"));
  EXPECT_THAT(text, testing::ContainsRegex("axis storage +\\| - +\\| cube"));
}

TEST(Comparison, Report_NamesWhatChangedMostAndWhatDiffersAround) {
  Results before = makeRun({makeCell("64", 1.0), makeCell("128", 2.0)});
  Results after = makeRun({makeCell("64", 1.1), makeCell("128", 4.0)});
  before.provenance.cpu = "old";
  after.provenance.cpu = "new";
  const std::string text = makeComparisonReport(before, after, {});
  EXPECT_THAT(text, HasSubstr("2 cells compared"));
  EXPECT_THAT(text, HasSubstr("+100.0 %"));
  EXPECT_LT(text.find("resolution=128"), text.find("resolution=64"));
  EXPECT_THAT(text, HasSubstr("old, 0 threads"));
  EXPECT_THAT(makeComparisonReport(before, before, {}), HasSubstr("Circumstances are the same."));
  EXPECT_THAT(comparisonToCsv(before, after, {}),
              HasSubstr("\"scene=builtin:mirrors camera=Camera frame=0 resolution=128\",relmse,2,4,2,changed\n"));
}

TEST(Comparison, NamesWithQuotes_StayOneFieldOfCsv) {
  CellResult cell = makeCell("64", 1.0);
  cell.scene = "a \"b\", c";
  const std::string csv = comparisonToCsv(makeRun({cell}), makeRun({cell}), {});
  EXPECT_THAT(csv, HasSubstr("\"scene=a \"\"b\"\", c camera=Camera frame=0 resolution=64\",relmse,1,1,0,equal\n"));
}

TEST(Brief, HasTheAnswerAndALineAScene) {
  const std::string text = makeBrief(makeRun({makeCell("64", 1.0), makeCell("128", 2.0)}), {"It is the bounces."});
  EXPECT_THAT(text, HasSubstr("- It is the bounces.\n"));
  EXPECT_THAT(text, HasSubstr("| builtin:mirrors"));
}

TEST(Brief, NamesATechniqueThatIsAlone_AndEscapes) {
  EXPECT_THAT(makeBrief(makeRun({makeCell("64", 1.0)}), {"<b>"}), HasSubstr("- \\<b>\n"));
  EXPECT_THAT(makeBrief(makeRun({makeCell("64", 1.0)}), {}), HasSubstr("| the only technique |"));
  CellResult external = makeCell("64", 1.0);
  external.technique = {{kExternalAxis, "engine"}};
  EXPECT_THAT(makeBrief(makeRun({external}), {}), testing::ContainsRegex("builtin:mirrors \\| engine "));
}

}  // namespace
}  // namespace pb
