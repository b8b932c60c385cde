#include "bench/results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/metrics/metrics_json.h"
#include "scenes/error.h"
#include "tests/unit/sample_results.h"

namespace pb {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

// The message of the input Error that reading `text` throws; empty if it throws none.
std::string refusal(const std::string& text) {
  try {
    resultsFromJson(text, "run/results.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::input);
    return error.what();
  }
  return "";
}

TEST(Results, JsonRoundTrip_IsExact) {
  const std::string text = toJson(samples::makeResults());
  EXPECT_EQ(toJson(resultsFromJson(text, "memory")), text);
}

// Against the members, since a member that neither direction knows would not break the test above.
TEST(Results, JsonRoundTrip_KeepsEveryMember) {
  const Results before = samples::makeResults();
  const Results after = resultsFromJson(toJson(before), "memory");
  EXPECT_EQ(after.provenance.seed, before.provenance.seed);
  EXPECT_EQ(after.provenance.settings, before.provenance.settings);
  EXPECT_EQ(after.provenance.libraries, before.provenance.libraries);
  EXPECT_EQ(after.provenance.cpu, before.provenance.cpu);
  EXPECT_EQ(after.tolerance, before.tolerance);
  ASSERT_EQ(after.cells.size(), before.cells.size());
  const CellResult &a = after.cells[0], &b = before.cells[0];
  EXPECT_EQ(a.key(), b.key());
  EXPECT_EQ(a.metrics.sums.bias, b.metrics.sums.bias);
  EXPECT_EQ(a.metrics.ssim->channels, b.metrics.ssim->channels);
  EXPECT_EQ(a.metrics.flipHdr->weightedQ3, b.metrics.flipHdr->weightedQ3);
  EXPECT_EQ(a.metrics.stopExposure, b.metrics.stopExposure);
  EXPECT_EQ(a.maskMetrics->flipLdr.mean, b.maskMetrics->flipLdr.mean);
  EXPECT_EQ(a.floor, b.floor);
  EXPECT_EQ(a.maskFloor, b.maskFloor);
  EXPECT_EQ(a.unbiased, b.unbiased);
  EXPECT_EQ(a.intervals, b.intervals);
  EXPECT_EQ(a.replicates, b.replicates);
  EXPECT_EQ(a.maskReplicates, b.maskReplicates);
  EXPECT_EQ(a.referenceHash, b.referenceHash);
  EXPECT_EQ(a.counters, b.counters);
  EXPECT_EQ(a.faceAgeFrames, b.faceAgeFrames);
  EXPECT_EQ(a.coatsOfProbes, b.coatsOfProbes);
  EXPECT_EQ(a.cost->ratioHigh, b.cost->ratioHigh);
  EXPECT_EQ(a.cost->captureMs, b.cost->captureMs);
  EXPECT_EQ(a.cost->shadowMs, b.cost->shadowMs);
  EXPECT_EQ(a.cost->prefilterMs, b.cost->prefilterMs);
  EXPECT_EQ(a.cost->rendersFormula, b.cost->rendersFormula);
  EXPECT_EQ(a.cost->peaks, b.cost->peaks);
  EXPECT_EQ(a.intervals, b.intervals);
  EXPECT_EQ(a.maskIntervals, b.maskIntervals);
  EXPECT_EQ(a.matched->depth, b.matched->depth);
  EXPECT_EQ(a.matched->converged, b.matched->converged);
  EXPECT_EQ(a.matched->metrics.sums.mse, b.matched->metrics.sums.mse);
  EXPECT_EQ(a.matched->maskMetrics->flipHdr->mean, b.matched->maskMetrics->flipHdr->mean);
  EXPECT_EQ(a.matched->floor, b.matched->floor);
  EXPECT_EQ(a.matched->maskFloor, b.matched->maskFloor);
  EXPECT_EQ(a.materials, b.materials);
  EXPECT_EQ(a.objects, b.objects);
  EXPECT_EQ(a.clusters, b.clusters);
  EXPECT_EQ(a.flicker, std::nullopt);
  EXPECT_EQ(after.cells[1].flicker, before.cells[1].flicker);
  const CellResult& bare = after.cells.back();
  EXPECT_FALSE(bare.maskMetrics || bare.cost || bare.metrics.ssim || bare.metrics.msSsim || bare.metrics.flipHdr);
  EXPECT_EQ(bare.metrics.sums.psnr, std::numeric_limits<double>::infinity());
}

TEST(Results, OneCellAlone_RoundTrips) {
  const CellResult cell = samples::makeResults().cells[3];
  const std::string line = toJson(cell);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_EQ(toJson(cellFromJson(line, "journal:1")), line);
  EXPECT_THROW(cellFromJson(line.substr(0, line.size() / 2), "journal:1"), Error);
  EXPECT_THROW(cellFromJson("{}", "journal:1"), Error);
}

TEST(Results, FromBeforeTimesOfShadowsAndFilters_AreRead) {
  Json document = Json::parse(toJson(samples::makeResults()));
  document["cells"][0]["cost"].erase("shadow_ms");
  document["cells"][0]["cost"].erase("prefilter_ms");
  const CostResult cost = *resultsFromJson(document.dump(), "memory").cells[0].cost;
  EXPECT_EQ(cost.shadowMs, 0.0);
  EXPECT_EQ(cost.prefilterMs, 0.0);
}

TEST(Results, FromBeforeCoatsWereCounted_AreRead) {
  Json document = Json::parse(toJson(samples::makeResults()));
  for (Json& cell : document["cells"]) cell.erase("coats_of_probes");
  EXPECT_TRUE(resultsFromJson(document.dump(), "memory").cells[0].coatsOfProbes.empty());
}

// The parts that came after version 1 was published; its files stay readable.
TEST(Results, WithoutTheirOptionalParts_AreRead) {
  Json document = Json::parse(toJson(samples::makeResults()));
  for (Json& cell : document["cells"]) {
    for (const char* part :
         {"materials", "intervals", "mask_intervals", "matched", "objects", "clusters", "flicker", "coats_of_probes"})
      cell.erase(part);
    if (!cell["cost"].is_null()) cell["cost"].erase("peaks");
  }
  const CellResult cell = resultsFromJson(document.dump(), "memory").cells[1];
  EXPECT_TRUE(cell.materials.empty() && cell.intervals.empty() && cell.maskIntervals.empty() && cell.objects.empty() &&
              cell.clusters.empty());
  EXPECT_FALSE(cell.matched || cell.flicker || cell.cost->peaks);
}

TEST(Results, ExtremeDoubles_RoundTripExactly) {
  for (const double value : {5e-324, 1.7976931348623157e308, 0.1, 1.0 / 3.0, -0.0, 123456789012345678.0}) {
    Results results = samples::makeResults();
    results.cells[0].metrics.sums.bias = value;
    const double read = resultsFromJson(toJson(results), "memory").cells[0].metrics.sums.bias;
    EXPECT_EQ(read, value);
    EXPECT_EQ(std::signbit(read), std::signbit(value));
  }
}

TEST(Results, NotANumber_IsNull) {
  Results results = samples::makeResults();
  results.cells[0].metrics.sums.mse = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(toJson(results), HasSubstr("\"mse\":null"));
  EXPECT_TRUE(std::isnan(resultsFromJson(toJson(results), "memory").cells[0].metrics.sums.mse));
}

TEST(Results, NameThatIsNoUtf8_IsWrittenReadably) {
  Results results = samples::makeResults();
  results.cells[0].camera = "caf\xe9";
  EXPECT_EQ(resultsFromJson(toJson(results), "memory").cells[0].camera, "caf\xef\xbf\xbd");
}

TEST(MetricsJson, HasTheKeysOfCompare) {
  std::vector<std::string> keys, flipKeys;
  const Json json = metricsToJson(samples::makeMetrics(0.1));
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  for (const auto& [key, value] : json.at("flip_hdr").items()) flipKeys.push_back(key);
  EXPECT_THAT(keys, testing::ElementsAre("bias", "mse", "rmse", "mae", "max_abs", "psnr", "relmse", "smape", "ssim",
                                         "ssim_channels", "ssim_luma", "ms_ssim", "flip_ldr", "flip_hdr"));
  EXPECT_THAT(flipKeys, testing::ElementsAre("mean", "weighted_q1", "weighted_median", "weighted_q3", "min", "max",
                                             "ppd", "start_exposure", "stop_exposure", "num_exposures"));
  EXPECT_EQ(json.at("flip_ldr").size(), 7u);
}

TEST(MetricsJson, UndefinedIsNull_AndInfinitePsnrIsText) {
  const Json json = metricsToJson(samples::makeResults().cells.back().metrics);
  EXPECT_EQ(json.at("psnr"), "inf");
  for (const char* key : {"ssim", "ssim_channels", "ssim_luma", "ms_ssim", "flip_hdr"})
    EXPECT_TRUE(json.at(key).is_null());
}

TEST(MetricValue, OfAnUnknownKey_NamesTheNearest) {
  EXPECT_EQ(metricValue(samples::makeMetrics(0.25), "flip_hdr"), 0.5);
  EXPECT_EQ(metricValue(samples::makeResults().cells.back().metrics, "ssim"), std::nullopt);
  try {
    metricValue({}, "relmsee");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("relmsee"), HasSubstr("nearest is 'relmse'")));
  }
}

TEST(ResultsSchema, TextThatIsNoJson_IsRefusedByNameAndPlace) {
  EXPECT_EQ(refusal("{\"schema_version\": 1,, }"), "'run/results.json' is not JSON: syntax error at byte 22");
  EXPECT_EQ(refusal(""), "'run/results.json' is truncated: its JSON ends too early, at byte 0");
}

TEST(ResultsSchema, EveryTruncation_IsRefused) {
  const std::string text = toJson(samples::makeResults());
  for (std::size_t length = 0; length + 2 < text.size(); length += 97)
    EXPECT_THAT(refusal(text.substr(0, length)), HasSubstr("truncated")) << length;
}

TEST(ResultsSchema, ForeignJson_IsRefused) {
  for (const char* text : {"{}", "[]", "3", "\"text\"", "null", R"({"context": {}, "benchmarks": []})"})
    EXPECT_EQ(refusal(text), "'run/results.json' is not a probebench results file: it has no 'schema_version'");
}

TEST(ResultsSchema, OtherVersions_AreRefused) {
  for (const char* version : {"0", "2", "\"1\"", "null"}) {
    const std::string message = refusal(fmt::format(R"({{"schema_version": {}, "cells": []}})", version));
    EXPECT_THAT(message, AllOf(HasSubstr(fmt::format("schema_version {}", version)), HasSubstr("reads 1")));
  }
}

TEST(ResultsSchema, DeepNesting_IsRefused) { EXPECT_THAT(refusal(std::string(100000, '[')), HasSubstr("levels deep")); }

TEST(ResultsSchema, NumberBeyondDouble_IsRefused) {
  EXPECT_THAT(refusal(R"({"schema_version": 1e999})"), HasSubstr("too large for a double"));
}

struct Mutation {
  const char* pointer;
  const char* value;  // JSON; null pointer: the key is removed
  const char* place;  // what the message must name
};

class ResultsSchemaMutation : public testing::TestWithParam<Mutation> {};

TEST_P(ResultsSchemaMutation, IsRefusedAtItsPlace) {
  const Mutation& mutation = GetParam();
  Json document = Json::parse(toJson(samples::makeResults()));
  const Json::json_pointer pointer(mutation.pointer);
  if (mutation.value)
    document[pointer] = Json::parse(mutation.value);
  else
    document[pointer.parent_pointer()].erase(pointer.back());
  EXPECT_THAT(refusal(document.dump()), AllOf(HasSubstr("'run/results.json' breaks its schema at "),
                                              HasSubstr(mutation.place), Not(HasSubstr("\n"))));
}

INSTANTIATE_TEST_SUITE_P(
    Table, ResultsSchemaMutation,
    testing::Values(Mutation{"/cells", nullptr, "at /: "},                               //
                    Mutation{"/cells", "{}", "at /cells: "},                             //
                    Mutation{"/surprise", "1", "at /: "},                                //
                    Mutation{"/provenance/gl_renderer", nullptr, "at /provenance: "},    //
                    Mutation{"/provenance/threads", "2.5", "at /provenance/threads: "},  //
                    Mutation{"/provenance/threads", "-1", "at /provenance/threads: "},   //
                    Mutation{"/provenance/started_at", "\"yesterday\"", "at /provenance/started_at: "},
                    Mutation{"/provenance/libraries/Embree", "3", "at /provenance/libraries/Embree: "},
                    Mutation{"/tolerance/relmse", "{}", "at /tolerance/relmse: "},
                    Mutation{"/tolerance/relmse", R"({"any": []})", "at /tolerance/relmse/any: "},
                    Mutation{"/tolerance/relmse", R"({"any": [{"absolute": 1, "relative": 0}], "absolute": 1})",
                             "at /tolerance/relmse"},
                    Mutation{"/tolerance/flip_hdr/absolute", "-1e-4", "at /tolerance/flip_hdr/absolute: "},
                    Mutation{"/cells/0", "null", "at /cells/0: "},                    //
                    Mutation{"/cells/1/frame", "\"0\"", "at /cells/1/frame: "},       //
                    Mutation{"/cells/1/frame", "4294967296", "at /cells/1/frame: "},  //
                    Mutation{"/cells/1/camera", nullptr, "at /cells/1: "},            //
                    Mutation{"/cells/1/technique/resolution", "64", "at /cells/1/technique/resolution: "},
                    Mutation{"/cells/2/metrics/mse", "\"large\"", "at /cells/2/metrics/mse: "},  //
                    Mutation{"/cells/2/metrics/mse", "true", "at /cells/2/metrics/mse: "},       //
                    Mutation{"/cells/2/metrics/psnr", nullptr, "at /cells/2/metrics: "},         //
                    Mutation{"/cells/2/metrics/flip_hdr/num_exposures", "1.5",
                             "at /cells/2/metrics/flip_hdr/num_exposures: "},
                    Mutation{"/cells/2/metrics/ssim_channels", "[1, 2]", "at /cells/2/metrics/ssim_channels: "},
                    Mutation{"/cells/2/mask_metrics", "{}", "at /cells/2/mask_metrics: "},  //
                    Mutation{"/cells/3/cost/ratio", "-1", "at /cells/3/cost/ratio: "},      //
                    Mutation{"/cells/3/cost/capture_ms/0", "\"fast\"", "at /cells/3/cost/capture_ms/0: "},
                    Mutation{"/cells/3/cost/peaks/p99", nullptr, "at /cells/3/cost/peaks: "},
                    Mutation{"/cells/3/matched/depth", "0", "at /cells/3/matched/depth: "},
                    Mutation{"/cells/3/matched/metrics/mse", nullptr, "at /cells/3/matched/metrics: "},
                    Mutation{"/cells/3/intervals/ssim", "[1, 2, 3]", "at /cells/3/intervals/ssim: "},
                    Mutation{"/cells/3/objects/0/share", "1.5", "at /cells/3/objects/0/share: "},
                    Mutation{"/cells/3/objects/0/probe", "-1", "at /cells/3/objects/0/probe: "},
                    Mutation{"/cells/3/clusters/1/x", "null", "at /cells/3/clusters/1/x: "},
                    Mutation{"/cells/3/flicker/whole", "-1", "at /cells/3/flicker/whole: "},
                    Mutation{"/cells/3/counters/draws", "1.5", "at /cells/3/counters/draws: "},  //
                    Mutation{"/cells/3/face_age_frames", "0", "at /cells/3/face_age_frames: "},
                    Mutation{"/cells/3/face_age_frames/0", "[0, 0, 0]", "at /cells/3/face_age_frames/0: "}));

TEST(ResultsSchema, CellThatStandsTwice_IsRefused) {
  Results results = samples::makeResults();
  results.cells.push_back(results.cells[2]);
  EXPECT_THAT(refusal(toJson(results)), AllOf(HasSubstr("once"), HasSubstr(results.cells[2].key())));
}

TEST(Results, OfADirectoryWithoutThem_NameTheFile) {
  try {
    readResults("/nonexistent/run");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::input);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("/nonexistent/run/results.json"), HasSubstr("No such file")));
  }
}

TEST(CellKey, NamesEverythingThatTellsCellsApart) {
  const CellResult cell = samples::makeCell("builtin:a", 3, "64", "faces?k=1", 0.1);
  EXPECT_EQ(cell.key(), "scene=builtin:a camera=main frame=3 resolution=64 refresh=faces?k=1 bounces=1");
  EXPECT_EQ(cell.sequenceKey(), "scene=builtin:a camera=main resolution=64 refresh=faces?k=1 bounces=1");
}

TEST(ShortKey, LeavesOutAxesAtTheirDefault) {
  const std::string key = "scene=my bounces=1 file.glb camera=main frame=3 resolution=64 refresh=faces?k=1 bounces=16";
  const AxisValues defaults = {{"bounces", "1"}, {"resolution", "64"}, {"refresh", "faces"}, {"coats", "none"}};
  EXPECT_EQ(shortKey(key, defaults), "scene=my bounces=1 file.glb camera=main frame=3 refresh=faces?k=1 bounces=16");
  EXPECT_EQ(shortKey(key, {{"bounces", "16"}}),
            "scene=my bounces=1 file.glb camera=main frame=3 resolution=64 refresh=faces?k=1");
  EXPECT_EQ(shortKey(key, {}), key);
}

TEST(Csv, HasOneRowPerCellAndValue) {
  const std::string csv = toCsv(samples::makeResults());
  EXPECT_THAT(csv, testing::StartsWith("scene,camera,frame,resolution,refresh,bounces,region,metric,value\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,whole,mse,0.010000000000000002\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,mask,flip_hdr.mean,0.8\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,floor,mse,1e-09\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,cost,capture_ms.1,0.25\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,cost,shadow_ms,0.0625\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,counter,triangles,123456\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,probe,face_age_frames.1.max,5\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,probe,face_age_frames.1.mean,3.0\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,probe,coats.0,3\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,cost,peaks.p95,18.0\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,matched,depth,2\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,matched,flip_hdr.mean,0.1\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,matched_mask,flip_hdr.mean,0.4\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,matched_floor,relmse,1e-07\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,interval,ssim.low,0.5\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,material chrome,share,0.75\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,object ball,probe_distance,0.5\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,0,64,every-frame,1,cluster 2,share,0.125\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:a,main,1,64,every-frame,1,flicker,whole,"));
  EXPECT_THAT(csv, HasSubstr("builtin:b,main,0,64,every-frame,1,whole,psnr,inf\n"));
  EXPECT_THAT(csv, HasSubstr("builtin:b,main,0,64,every-frame,1,whole,ssim,\n"));
  EXPECT_THAT(csv, Not(HasSubstr("builtin:b,main,0,64,every-frame,1,mask")));
}

TEST(Csv, LeavesOutAxesThatStandAtTheirDefaultInTheWholeRun) {
  const Results results = samples::makeResults();
  EXPECT_THAT(toCsv(results, {{"resolution", "64"}, {"bounces", "1"}}), testing::StartsWith("scene,camera,frame,"));
  EXPECT_THAT(toCsv(results, {{"bounces", "1"}}), Not(HasSubstr(",bounces,")));
  EXPECT_THAT(toCsv(results, {{"bounces", "7"}}), HasSubstr(",bounces,"));
}

TEST(Csv, QuotesWhatHoldsSeparators) {
  Results results;
  results.cells.push_back(samples::makeCell("a,\"b\"", 0, "64", "static", 0.1));
  EXPECT_THAT(toCsv(results), HasSubstr("\n\"a,\"\"b\"\"\",main,0,64,static,1,whole,bias,"));
}

}  // namespace
}  // namespace pb
