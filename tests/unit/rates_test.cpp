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

// What is traced for attributions of a still scene, of cells of these lookups.
double tracedFor(const std::string& lookups) {
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
  const PlanWork work = computeWork(suite, scenes, makePlan(suite), ReferenceStore(folder.path() / "store"));
  return work.units.at({"attribution", "attributed"});
}

// Maps with distances are others.
TEST(PlanWork, CountsMapsThatAttributionsShareOnce) {
  const double once = tracedFor(R"("infinite")");
  EXPECT_GT(once, 0);
  EXPECT_EQ(tracedFor(R"("infinite", "box-proxy", "sphere-proxy")"), once);
  EXPECT_EQ(tracedFor(R"("infinite", "box-proxy", "distance-impostor")"), 2 * once);
}

TEST(PrintedWork, WithUntilDecided_CountsWhatIsRenderedTwice) {
  const TemporaryFolder folder;
  Rates rates(folder.path(), "here");
  rates.record({"errors", "a"}, 1, 2);
  PlanWork deciding;
  deciding.frames = 4;
  deciding.captures = 24;
  deciding.units = {{{"errors", "a"}, 10}, {{"references", "a"}, 7}, {{"control", "s"}, 1}};
  PlanWork work;
  work.units[{"errors", "a"}] = 30;
  work.addDeciding(deciding);
  const std::string text = printWork(work, rates);
  EXPECT_THAT(text, HasSubstr("--until-decided renders 4 raster frames beforehand, with 24 captured faces\n"));
  EXPECT_THAT(text, HasSubstr("should take about 1:20 (deciding 0:20, errors 1:00)"));  // its references are the run's
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
