#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/error_message.h"
#include "tests/unit/gate_fixture.h"

namespace pb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// The samples' axes and one that is younger than them.
const AxisValues kDefaults = {{"resolution", "64"}, {"refresh", "every-frame"}, {"bounces", "1"}, {"coats", "none"}};

TEST(Baseline, FromBeforeMaxNoiseWasStored_IsRead) {
  nlohmann::ordered_json document = nlohmann::ordered_json::parse(toJson(baselineOf(samples::makeResults())));
  document["provenance"].erase("max_noise");
  EXPECT_FALSE(baselineFromJson(document.dump(), "b.json").provenance.maxNoise.has_value());
}

TEST(Baseline, KeepsLevelsScenesAndRepetitions) {
  Results run = runWith(0.5);
  run.warnTolerance = {{"relmse", plain(1e-4, 0)}};
  run.sceneTolerances["scene=builtin:a camera=main"] = {{{"relmse", plain(1, 0)}}, {{"relmse", plain(0.5, 0)}}};
  run.cells[0].cost->ratios = {2.9, 3.0, 3.1};
  run.cells[0].integrity = {{"probes", 2}};
  run.tolerance.emplace_back(kIntegrityTolerance, plain(1, 0));
  const Baseline read = baselineFromJson(toJson(baselineOf(run)), "memory");
  EXPECT_EQ(read.warnTolerance, run.warnTolerance);
  EXPECT_EQ(read.cells[0].integrity, run.cells[0].integrity);
  EXPECT_EQ(read.sceneTolerances, run.sceneTolerances);
  EXPECT_EQ(read.costs.begin()->second.ratios, run.cells[0].cost->ratios);
}

TEST(Baseline, JsonRoundTrip_IsExactAndGatesAlike) {
  const Results run = samples::makeResults();
  const std::string text = toJson(baselineOf(run));
  const Baseline read = baselineFromJson(text, "memory");
  EXPECT_EQ(toJson(read), text);
  EXPECT_EQ(read.reason, "because");
  EXPECT_EQ(read.tolerance, run.tolerance);
  EXPECT_EQ(read.provenance.maxNoise, run.provenance.maxNoise);
  EXPECT_EQ(check(run, read).verdict, GateVerdict::pass);
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
  EXPECT_THAT(refusalOf("/warn_tolerance", R"({"mae": {"absolute": 1, "relative": 0}})"), HasSubstr("'mae'"));
  EXPECT_THAT(messageOf([] { baselineFromJson(toJson(samples::makeResults()), "b.json"); }),
              HasSubstr("is the results of a run, not a baseline"));
}

}  // namespace
}  // namespace pb
