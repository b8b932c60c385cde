#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/work.h"
#include "scenes/files.h"

namespace pb {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Phases, NameTheirKindAndScene) {
  EXPECT_EQ(kindOfPhase("errors of pool of glass", "quick"), WorkKind("errors", "pool of glass"));
  EXPECT_EQ(kindOfPhase("cost", "quick"), WorkKind("cost", "quick"));
}

TEST(Rates, AreThoseOfTheScene_OrTheMeanOfAll) {
  const TemporaryFolder folder;
  Rates rates(folder.path(), "here");
  EXPECT_EQ(rates.secondsPerUnit({"errors", "a"}), std::nullopt);
  rates.record({"errors", "a"}, 2, 4);
  rates.record({"errors", "b"}, 2, 8);
  EXPECT_EQ(rates.secondsPerUnit({"errors", "a"}), 2.0);
  EXPECT_EQ(rates.secondsPerUnit({"errors", "c"}), 3.0);
  EXPECT_EQ(rates.secondsPerUnit({"cost", ""}), std::nullopt);
}

TEST(Rates, AreKeptByMachine) {
  const TemporaryFolder folder;
  Rates rates(folder.path(), "here");
  rates.record({"cost", ""}, 1, 2);
  rates.save();
  EXPECT_EQ(Rates(folder.path(), "here").secondsPerUnit({"cost", ""}), 2.0);
  EXPECT_EQ(Rates(folder.path(), "there").secondsPerUnit({"cost", ""}), std::nullopt);
}

TEST(Rates, FromADamagedFile_AreNone) {
  const TemporaryFolder folder;
  writeFileAtomically((folder.path() / "rates.json").string(), R"({"here": [{"kind": 3}]})");
  EXPECT_EQ(Rates(folder.path(), "here").secondsPerUnit({"cost", ""}), std::nullopt);
}

TEST(Rates, OfPhases_CountWhatTheyWereToDo) {
  const TemporaryFolder folder;
  Rates rates(folder.path(), "here");
  PlanWork work;
  work.units[{"errors", "a"}] = 4;
  rates.record({{"errors of a", 3, 8.0}, {"references of a", 3, 5.0}}, work);
  EXPECT_EQ(rates.secondsPerUnit({"errors", "a"}), 2.0);
  EXPECT_EQ(rates.secondsPerUnit({"references", "a"}), std::nullopt);  // there were none to trace
}

TEST(Rates, OfSmallRuns_DontReplaceThoseOfLargeOnes) {
  const TemporaryFolder folder;
  Rates rates(folder.path(), "here");
  rates.record({"cost", "quick"}, 10, 20);
  rates.record({"cost", "quick"}, 1, 9);
  EXPECT_EQ(rates.secondsPerUnit({"cost", "quick"}), 2.0);
  rates.record({"cost", "quick"}, 8, 24);
  EXPECT_EQ(rates.secondsPerUnit({"cost", "quick"}), 3.0);
}

// Of attributions of a still scene, of cells of these lookups.
PlanWork workOf(const std::string& lookups) {
  const TemporaryFolder folder;
  writeFileAtomically(folder.file("suite.toml"), R"(
schema = 1
name = "attributed"
image = { size = [32, 18], samples = 1 }
[[scene]]
use = "builtin:planar-floor"
[grid]
lookup = [)" + lookups + R"(]
[attribution]
cells = "lookup"
)");
  Suite suite = loadSuite(folder.file("suite.toml"));
  const Scenes scenes = loadScenes(suite);
  return computeWork(suite, scenes, makePlan(suite), ReferenceStore(folder.path() / "store"));
}

// Faces and distances are traced for all that read them.
TEST(PlanWork, CountsMapsThatAttributionsShareOnce) {
  const PlanWork one = workOf(R"("infinite")"), three = workOf(R"("infinite", "box-proxy", "distance-impostor")");
  const WorkKind kind("attribution", "attributed");
  EXPECT_GT(one.units.at(kind), 0);
  EXPECT_EQ(three.units.at(kind), one.units.at(kind));
  EXPECT_EQ(one.attribution.traced, 2u);
  EXPECT_EQ(three.attribution.traced, 2u);
  EXPECT_EQ(one.attribution.captured, 1u);
  EXPECT_EQ(three.attribution.captured, 1u) << "captures show no map";
  EXPECT_EQ(one.attribution.images, 3u) << "filtered/format is capture";
  EXPECT_EQ(three.attribution.images, 9u);
}

TEST(PrintedWork, OfAttributions_CountsImagesAndTheirMaps) {
  const TemporaryFolder folder;
  PlanWork work;
  EXPECT_THAT(printWork(work, Rates(folder.path(), "here")), Not(HasSubstr("attribution")));
  work.attribution.images = 9;
  work.attribution.traced = 2;
  work.attribution.captured = 1;
  EXPECT_THAT(printWork(work, Rates(folder.path(), "here")),
              HasSubstr("\nattribution renders 9 images from 2 traced and 1 captured sets of maps\n"));
}

// Its pictures and references are the run's: what it adds is scores.
TEST(PrintedWork, WithUntilDecided_CountsNothingTwiceButScores) {
  const TemporaryFolder folder;
  Rates rates(folder.path(), "here");
  rates.record({"errors", "a"}, 1, 2);
  rates.record({"references", "a"}, 1, 1);
  rates.record({"intervals", "s"}, 1, 1);
  PlanWork work;
  work.units = {{{"errors", "a"}, 30}, {{"references", "a"}, 7}, {{"intervals", "s"}, 3}};
  EXPECT_THAT(printWork(work, rates),
              HasSubstr("should take about 1:10 (references 0:07, errors 1:00, intervals 0:03)"));
  work.untilDecided = true;
  const std::string text = printWork(work, rates);
  EXPECT_THAT(text, HasSubstr("--until-decided renders them first, and scores the last ones at least once more\n"));
  EXPECT_THAT(text, HasSubstr("should take about 1:13 (deciding 0:03, references 0:07, errors 1:00, intervals 0:03)"));
  EXPECT_THAT(text, HasSubstr("--until-decided may ask for more samples"));
}

TEST(PrintedWork, SaysHowLongItTakesAndWhatIsNotKnown) {
  const TemporaryFolder folder;
  Rates rates(folder.path(), "here");
  PlanWork work;
  work.references = 8;
  work.stored = 6;
  work.units[{"errors", "a"}] = 30;
  work.units[{"cost", ""}] = 1;
  EXPECT_THAT(printWork(work, rates), HasSubstr("at most 8 references, 6 stored"));
  EXPECT_THAT(printWork(work, rates), HasSubstr("no rates measured yet"));
  rates.record({"errors", "a"}, 1, 2);
  EXPECT_THAT(printWork(work, rates),
              HasSubstr("should take about 1:00 (errors 1:00), by the rates of earlier runs; no rates measured yet for "
                        "cost"));
}

}  // namespace
}  // namespace pb
