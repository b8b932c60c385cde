#include "bench/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "bench/axes.h"
#include "scenes/error.h"

namespace pb {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Two scenes of 3 and 1 frames, a grid of 2 x 3 techniques: 12 sequences, 24 cells.
Suite suiteOfTwo() {
  Suite suite;
  suite.name = "two";
  suite.scenes.resize(2);
  suite.scenes[0].name = "a";
  suite.scenes[0].frames = {0, 2, 5};
  suite.scenes[1].name = "b";
  suite.grid = {{"resolution", {"64", "128"}}, {"bounces", {"1", "2", "3"}}};
  return suite;
}

TEST(Plan, IsTheProductOfScenesAndAxes) {
  const Plan plan = makePlan(suiteOfTwo());
  ASSERT_EQ(plan.sequences.size(), 12u);
  EXPECT_EQ(plan.cellCount(), 24u);
  EXPECT_THAT(plan.framesOf(0), ElementsAre(0, 2, 5));
  EXPECT_THAT(plan.framesOf(1), ElementsAre(0));
  // The last axis is the fastest, the scene the slowest.
  EXPECT_EQ(plan.sequences[1].technique.resolution, 64);
  EXPECT_EQ(plan.sequences[1].technique.bounces, 2);
  EXPECT_EQ(plan.sequences[3].technique.resolution, 128);
  EXPECT_EQ(plan.sequences[6].scene, 1u);
}

TEST(Plan, Varied_TriesEachValueAloneOnEachOfTheGridsTechniques) {
  Suite suite = suiteOfTwo();
  suite.grid = {{"bounces", {"1", "2"}}};
  suite.scenes[1].vary = {{{}, {{"resolution", {"256", "64"}}, {"feedback", {"sky"}}}}};  // 256 is what it is anyway
  const Plan plan = makePlan(suite);
  ASSERT_EQ(plan.sequences.size(), 2u + 2u + 2u + 2u);
  for (std::size_t i = 4; i < 8; ++i) {
    const Technique& technique = plan.sequences[i].technique;
    EXPECT_EQ(plan.sequences[i].scene, 1u);
    EXPECT_EQ(technique.bounces, i % 2 == 0 ? 1 : 2);
    EXPECT_EQ(technique.resolution, i < 6 ? 64 : 256);
    EXPECT_EQ(technique.feedback, i < 6 ? Feedback::previousFrame : Feedback::sky);
  }
}

TEST(Plan, VariedOnOtherSettings_HasThoseAndEachValueOnTopOfThem) {
  Suite suite = suiteOfTwo();
  suite.grid.clear();
  suite.scenes[1].vary = {{{{"bounces", "3"}}, {{"resolution", {"64"}}, {"bounces", {"1"}}}}};  // 1 is the grid's
  const Plan plan = makePlan(suite);
  ASSERT_EQ(plan.sequences.size(), 1u + 3u);
  EXPECT_EQ(plan.sequences[2].technique.bounces, 3);
  EXPECT_EQ(plan.sequences[2].technique.resolution, 256);
  EXPECT_EQ(plan.sequences[3].technique.bounces, 3);
  EXPECT_EQ(plan.sequences[3].technique.resolution, 64);
}

TEST(Survey, TriesEveryValueOfEveryAxis) {
  const Suite suite = loadSuite("survey");
  for (const Axis& axis : axisTable()) {
    std::set<std::string> tried = {parseSpec(axis.print(suite.technique)).name};
    for (const SuiteScene& scene : suite.scenes)
      for (const Variation& variation : scene.vary)
        for (const auto& [name, values] : variation.values)
          if (name == axis.name)
            for (const std::string& value : values) tried.insert(parseSpec(value).name);
    EXPECT_GE(tried.size(), 2u) << axis.name;
    for (const std::string& value : axis.names) EXPECT_TRUE(tried.contains(value)) << axis.name << " " << value;
  }
}

TEST(Plan, WithoutGrid_IsTheBaseTechniqueAlone) {
  Suite suite = suiteOfTwo();
  suite.grid.clear();
  suite.technique.bounces = 7;
  const Plan plan = makePlan(suite);
  ASSERT_EQ(plan.sequences.size(), 2u);
  EXPECT_EQ(plan.sequences[0].technique.bounces, 7);
}

TEST(Plan, WithASceneOrAValueTwice_IsRefused) {
  Suite sceneTwice = suiteOfTwo();
  sceneTwice.scenes[1].name = "a";
  EXPECT_THROW(makePlan(sceneTwice), Error);
  Suite valueTwice = suiteOfTwo();
  valueTwice.grid[0].second = {"64", "64"};
  EXPECT_THROW(makePlan(valueTwice), Error);
}

TEST(Plan, Only_KeepsMatchingCells) {
  const Plan plan = makePlan(suiteOfTwo(), {.only = "frame=2 .*bounces=3", .shard = {}});
  ASSERT_EQ(plan.sequences.size(), 2u);
  EXPECT_EQ(plan.cellCount(), 2u);
  EXPECT_THAT(plan.sequences[0].frames, ElementsAre(2));
}

TEST(Plan, Only_ThatMatchesNothingOrIsNoExpression_IsRefused) {
  EXPECT_THROW(makePlan(suiteOfTwo(), {.only = "resolution=32", .shard = {}}), Error);
  EXPECT_THROW(makePlan(suiteOfTwo(), {.only = "(", .shard = {}}), Error);
}

TEST(Plan, Shards_InOrderAreTheWhole) {
  const Plan whole = makePlan(suiteOfTwo());
  for (const int count : {1, 2, 5, 12}) {
    std::vector<std::string> keys;
    for (int index = 1; index <= count; ++index)
      for (const PlannedSequence& sequence : makePlan(suiteOfTwo(), {.only = {}, .shard = {index, count}}).sequences)
        keys.push_back(makeCell(suiteOfTwo(), sequence, 0).sequenceKey());
    ASSERT_EQ(keys.size(), whole.sequences.size()) << count;
    for (std::size_t i = 0; i < keys.size(); ++i)
      EXPECT_EQ(keys[i], makeCell(suiteOfTwo(), whole.sequences[i], 0).sequenceKey());
  }
}

TEST(Shard, OutOfRangeOrMalformed_IsRefused) {
  EXPECT_EQ(parseShard("2/3").index, 2);
  EXPECT_EQ(parseShard("2/3").count, 3);
  for (const char* bad : {"0/3", "4/3", "1", "/", "1/", "/2", "a/b", "1/2/3", "1/99999999999"})
    EXPECT_THROW(parseShard(bad), Error) << bad;
}

TEST(Plan, AbsurdlyLargeGrid_IsRefusedBeforeItIsExpanded) {
  Suite suite = suiteOfTwo();
  std::vector<std::string> bounces, refresh;
  for (int i = 1; i <= 16; ++i) bounces.push_back(std::to_string(i));
  for (int n = 1; n <= 1000; ++n) refresh.push_back("every-n?n=" + std::to_string(n));
  suite.grid = {
      {"resolution", {"8", "16", "32", "64", "128", "256", "512"}}, {"refresh", refresh}, {"bounces", bounces}};
  EXPECT_THROW(makePlan(suite), Error);
}

TEST(PrintedPlan, CountsSequencesReferencesCellsAndCosts) {
  const std::string text = printPlan(suiteOfTwo(), makePlan(suiteOfTwo()));
  EXPECT_THAT(text,
              HasSubstr("24 cells in 12 raster sequences, 4 references, 12 cost measurements of 10 repetitions\n"));
  EXPECT_THAT(text, HasSubstr("  resolution: 64, 128\n"));
  EXPECT_THAT(text, HasSubstr("  a: 6 sequences, 3 measured frames\n"));
}

}  // namespace
}  // namespace pb
