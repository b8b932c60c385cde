#include "bench/recommend.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <regex>

#include "scenes/error.h"
#include "tests/unit/sample_results.h"

namespace pb {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

struct Choice {
  const char* resolution;
  const char* refresh;
  double error;  // FLIP-HDR on the mask
  double plusMinus;
  double ratio;
};

CellResult cellOf(const std::string& scene, const Choice& choice) {
  CellResult cell = samples::makeCell(scene, 0, choice.resolution, choice.refresh, choice.error / 8);
  cell.maskMetrics->flipHdr->mean = choice.error;
  cell.maskIntervals = {{"flip_hdr", {choice.error - choice.plusMinus, choice.error + choice.plusMinus}}};
  cell.cost = samples::makeCost(choice.ratio);
  return cell;
}

Results resultsOf(const std::vector<std::pair<std::string, std::vector<Choice>>>& scenes) {
  Results results;
  results.provenance = samples::makeProvenance();
  for (const auto& [scene, choices] : scenes)
    for (const Choice& choice : choices) results.cells.push_back(cellOf(scene, choice));
  return results;
}

// As if the references had no noise.
Results withoutNoise(Results results) {
  for (CellResult& cell : results.cells) cell.floor = cell.maskFloor = {{"mse", 0.0}, {"relmse", 0.0}};
  return results;
}

// Error falls and cost rises with resolution; `static` is cheap and bad.
Results oneScene() {
  return resultsOf({{"a",
                     {{"64", "every-frame", 0.40, 0.01, 2.0},
                      {"128", "every-frame", 0.20, 0.01, 3.0},
                      {"256", "every-frame", 0.19, 0.002, 6.0},
                      {"64", "static", 0.60, 0.01, 1.0},
                      {"128", "static", 0.55, 0.01, 1.1},
                      {"256", "static", 0.54, 0.01, 1.2}}}});
}

std::string chosen(const Recommendation& answer) {
  if (!answer.chosen) return "none";
  return techniqueText(answer.set.candidates[*answer.chosen].technique, answer.set);
}

RecommendRequest maxError(double limit) {
  RecommendRequest request;
  request.maxError = limit;
  return request;
}

TEST(Recommend, MaxError_IsTheCheapestBelowIt) {
  EXPECT_EQ(chosen(recommend(oneScene(), maxError(0.25))), "resolution=128 refresh=every-frame");
  EXPECT_EQ(chosen(recommend(oneScene(), maxError(1.0))), "resolution=64 refresh=static");
  EXPECT_EQ(chosen(recommend(oneScene(), maxError(0.1))), "none");
}

TEST(Recommend, MaxErrorWithinAnInterval_IsUndecided) {
  const Recommendation answer = recommend(oneScene(), maxError(0.205));  // 0.20 +- 0.01 and 0.19 +- 0.002
  EXPECT_EQ(chosen(answer), "resolution=256 refresh=every-frame");
  ASSERT_THAT(answer.undecided, SizeIs(1));
  EXPECT_EQ(answer.set.candidates[answer.undecided.front()].loss.value, 0.20);
}

TEST(Recommend, Budgets_GiveTheSmallestErrorWithin) {
  RecommendRequest request;
  request.budgetRatio = 3.5;
  EXPECT_EQ(chosen(recommend(oneScene(), request)), "resolution=128 refresh=every-frame");
  request.budgetRatio.reset();
  request.budgetMs = 4.8 * 1.02;  // 1.2 plain frames of 4 ms, 2 % wide
  EXPECT_EQ(chosen(recommend(oneScene(), request)), "resolution=256 refresh=static");
  request.budgetMb = 2.0;  // all have 2 MiB
  EXPECT_EQ(chosen(recommend(oneScene(), request)), "none");
  request.budgetMb = 2.1;
  EXPECT_EQ(chosen(recommend(oneScene(), request)), "resolution=256 refresh=static");
}

TEST(Recommend, LimitsTogether_AllHold) {
  RecommendRequest request = maxError(0.45);
  request.budgetRatio = 1.5;
  EXPECT_EQ(chosen(recommend(oneScene(), request)), "none");
  request.budgetRatio = 2.5;
  EXPECT_EQ(chosen(recommend(oneScene(), request)), "resolution=64 refresh=every-frame");
}

TEST(Recommend, SeveralScenes_TheWorstCounts) {
  const Results results = resultsOf({{"a", {{"64", "static", 0.1, 0, 1.0}, {"128", "static", 0.09, 0, 2.0}}},
                                     {"b", {{"64", "static", 0.5, 0, 1.5}, {"128", "static", 0.2, 0, 1.8}}}});
  const Recommendation both = recommend(results, maxError(0.3));
  EXPECT_EQ(chosen(both), "resolution=128");
  const Candidate& candidate = both.set.candidates[*both.chosen];
  EXPECT_EQ(candidate.worstScene, "b");
  EXPECT_EQ(candidate.loss.value, 0.2);
  EXPECT_EQ(candidate.ratio->value, 2.0);  // of scene a
  RecommendRequest request = maxError(0.3);
  request.selection.scenes = "^a$";
  EXPECT_EQ(chosen(recommend(results, request)), "resolution=64");
}

TEST(Recommend, WhatIsMissingOnAScene_IsNoChoice) {
  const Results results = resultsOf({{"a", {{"64", "static", 0.1, 0, 1.0}, {"128", "static", 0.09, 0, 2.0}}},
                                     {"b", {{"128", "static", 0.2, 0, 1.8}}}});
  const Recommendation answer = recommend(results, maxError(0.3));
  EXPECT_THAT(answer.set.candidates, SizeIs(1));
  EXPECT_EQ(answer.set.elsewhere, 1u);
}

TEST(Recommend, WhereMoreIsBetter_TheLimitIsALowerOne) {
  Results results = withoutNoise(oneScene());
  for (CellResult& cell : results.cells) cell.maskMetrics->ssim->mean = 1 - cell.maskMetrics->flipHdr->mean;
  RecommendRequest request = maxError(0.75);
  request.selection.metric = "ssim";
  EXPECT_EQ(chosen(recommend(results, request)), "resolution=128 refresh=every-frame");
}

// Of metrics that have none, and of single objects.
TEST(Recommend, WithoutAnInterval_IsSureOnlyWhereThereIsNoNoise) {
  Results results = oneScene();
  for (CellResult& cell : results.cells) cell.maskMetrics->sums.mae = cell.maskMetrics->flipHdr->mean;
  RecommendRequest request = maxError(0.25);
  request.selection.metric = "mae";
  const Recommendation unsure = recommend(results, request);
  EXPECT_EQ(chosen(unsure), "none");
  EXPECT_THAT(unsure.undecided, ElementsAre(1, 2));
  const std::string text = print(unsure, request, results, {});
  EXPECT_THAT(text, HasSubstr("No technique of this run holds that for sure."));
  EXPECT_THAT(text, HasSubstr("not sure: resolution=128 refresh=every-frame, mae 0.200 (interval not known), 3.00x\n"));
  EXPECT_EQ(chosen(recommend(withoutNoise(results), request)), "resolution=128 refresh=every-frame");
}

TEST(Steps, WithoutAnInterval_AreNotSure) {
  Results results = resultsOf({{"a", {{"64", "static", 0.2, 0, 1.0}, {"128", "static", 0.1, 0, 1.0}}}});
  for (CellResult& cell : results.cells) cell.maskMetrics->sums.mae = cell.maskMetrics->flipHdr->mean;
  RecommendRequest request;
  request.selection.metric = "mae";
  const Recommendation unsure = recommend(results, request);
  EXPECT_EQ(unsure.steps[0].verdict, std::nullopt);
  EXPECT_THAT(print(unsure, request, results, {}),
              HasSubstr("resolution 128 -> 64 loses 0.100 (interval not known) for"));
  EXPECT_THAT(unsure.front, SizeIs(2));
  const Recommendation sure = recommend(withoutNoise(results), request);
  EXPECT_EQ(sure.steps[0].verdict, Verdict::worse);
  EXPECT_THAT(sure.front, ElementsAre(1));
}

// Scene a is noise, but what counts is scene b, where errors are larger and exact.
TEST(Steps, AreBelowTheFloorOnlyWhereTheyAreWorst) {
  Results results = resultsOf({{"a", {{"64", "static", 0.10, 0, 1.0}, {"128", "static", 0.09, 0, 2.0}}},
                               {"b", {{"64", "static", 0.5, 0, 1.0}, {"128", "static", 0.3, 0, 2.0}}}});
  for (const std::size_t i : {0u, 1u}) results.cells[i].maskFloor = {{"relmse", 1e9}};
  for (const std::size_t i : {2u, 3u}) results.cells[i].maskFloor = {{"relmse", 0}};
  EXPECT_EQ(recommend(results, maxError(0.6)).steps[0].verdict, Verdict::better);
  std::swap(results.cells[0].maskFloor, results.cells[2].maskFloor);
  std::swap(results.cells[1].maskFloor, results.cells[3].maskFloor);
  EXPECT_EQ(recommend(results, maxError(0.6)).steps[0].verdict, Verdict::belowFloor);
}

// Of two frames only the worst one counts, with --worst-frame.
TEST(Steps, AreBelowTheFloorByTheFramesThatCount) {
  Results results = resultsOf({{"a", {{"64", "static", 0.5, 0, 1.0}, {"128", "static", 0.4, 0, 2.0}}}});
  for (const std::size_t i : {0u, 1u}) {
    results.cells.push_back(results.cells[i]);
    results.cells.back().frame = 1;
    results.cells.back().maskMetrics->flipHdr->mean = 0.01;
    results.cells.back().maskFloor = {{"relmse", 1e9}};
  }
  Selection selection;
  EXPECT_FALSE(candidatesOf(results, selection).candidates[0].clearOfFloor);
  selection.worstFrame = true;
  EXPECT_TRUE(candidatesOf(results, selection).candidates[0].clearOfFloor);
}

TEST(Recommend, OfAnObject_TakesItsErrorAlone) {
  Results results = withoutNoise(oneScene());
  for (CellResult& cell : results.cells) {
    ObjectError error;
    error.object = "ball";
    error.pixels = 10;
    error.flipHdr = cell.technique[0].second == "256" ? 0.1 : 0.3;
    cell.objects = {error};
  }
  RecommendRequest request = maxError(0.2);
  request.selection.object = "ball";
  EXPECT_EQ(chosen(recommend(results, request)), "resolution=256 refresh=static");
  results.cells[5].floor = {{"relmse", 1e-6}};  // its own
  EXPECT_EQ(chosen(recommend(results, request)), "resolution=256 refresh=every-frame");
  request.selection.object = "bal";
  EXPECT_THROW(recommend(results, request), Error);
  request.selection.object = "ball";
  request.selection.metric = "ssim";
  EXPECT_THROW(recommend(results, request), Error);
}

TEST(Recommend, WrongQuestions_AreRefused) {
  RecommendRequest request = maxError(0.2);
  request.selection.scenes = "nothing";
  EXPECT_THROW(recommend(oneScene(), request), Error);
  request.selection.scenes = "(";
  EXPECT_THROW(recommend(oneScene(), request), Error);
  request = maxError(0.2);
  request.selection.metric = "flip";
  EXPECT_THROW(recommend(oneScene(), request), Error);
  Results noCosts = oneScene();
  for (CellResult& cell : noCosts.cells) cell.cost.reset();
  EXPECT_THROW(recommend(noCosts, maxError(0.2)), Error);
  EXPECT_THROW(recommend(Results{}, maxError(0.2)), Error);
}

TEST(Recommend, Frames_CountByTheirMeanOrTheirWorst) {
  Results results = resultsOf({{"a", {{"64", "static", 0.1, 0.01, 1.0}, {"64", "static", 0.3, 0.03, 1.0}}}});
  results.cells[1].frame = 1;
  Selection selection;
  Estimate loss = candidatesOf(results, selection).candidates.front().loss;
  EXPECT_DOUBLE_EQ(loss.value, 0.2);
  EXPECT_DOUBLE_EQ(loss.high, 0.22);
  selection.worstFrame = true;
  loss = candidatesOf(results, selection).candidates.front().loss;
  EXPECT_DOUBLE_EQ(loss.high, 0.33);
}

TEST(Recommend, FramesWithoutAnInterval_TakeThatOfTheOthers) {
  Results results = resultsOf({{"a", {{"64", "static", 0.1, 0.01, 1.0}, {"64", "static", 0.3, 0.03, 1.0}}}});
  results.cells[1].frame = 1;
  results.cells[0].maskIntervals.clear();
  const Estimate loss = candidatesOf(results, {}).candidates.front().loss;
  EXPECT_DOUBLE_EQ(loss.value, 0.2);
  EXPECT_DOUBLE_EQ(loss.high, 0.23);
}

TEST(Steps, GoToTheNearestNumbersOfOneAxis) {
  const Recommendation answer = recommend(oneScene(), maxError(0.25));  // 128, every-frame
  ASSERT_THAT(answer.steps, SizeIs(3));
  EXPECT_EQ(answer.steps[0].to, "64");
  EXPECT_EQ(answer.steps[1].to, "256");
  EXPECT_NEAR(answer.steps[1].gain.value, 0.01, 1e-12);
  EXPECT_NEAR(answer.steps[1].gain.plusMinus(), 0.01 + 0.002, 1e-12);  // nothing is known of what they have in common
  EXPECT_NEAR(answer.steps[1].costFactor->value, 2.0, 1e-12);
  EXPECT_NEAR(answer.steps[1].costFactor->high, 2.0 * 1.02 / 0.98, 1e-12);
  EXPECT_EQ(answer.steps[2].axis, "refresh");
  EXPECT_EQ(answer.steps[2].to, "static");
}

// Replicates of both go up and down together by 0.01, their difference by 0.0004.
void addReplicates(CellResult& cell, double own) {
  std::vector<double> replicates;
  for (int b = 0; b < 16; ++b)
    replicates.push_back(cell.maskMetrics->flipHdr->mean + (b % 2 == 0 ? 1 : -1) * (0.01 + own) / 15);
  cell.maskReplicates = {{"flip_hdr", replicates}};
  cell.referenceHash = "same";
}

// sqrt(15/16 * 16 (d/15)^2) = d / sqrt(15) for replicates at +-d/15 about the value; t = 2.131.
TEST(Steps, AgainstTheSameReference_ArePaired) {
  Results results = oneScene();
  addReplicates(results.cells[1], 0);       // 128: 0.20
  addReplicates(results.cells[2], 0.0004);  // 256: 0.19
  const Step step = recommend(results, maxError(0.25)).steps[1];
  EXPECT_EQ(step.verdict, Verdict::better);
  EXPECT_NEAR(step.gain.plusMinus(), 2.131 * 0.0004 / std::sqrt(15.0), 1e-9);
  results.cells[2].referenceHash = "other";
  EXPECT_EQ(recommend(results, maxError(0.25)).steps[1].verdict, Verdict::equal);
}

// By their own intervals, 0.02 wide, neither dominates the other.
TEST(Front, AgainstTheSameReference_LeavesOutWhatIsWorseForSure) {
  const std::vector<Choice> choices = {{"64", "static", 0.200, 0.01, 1.0}, {"128", "static", 0.195, 0.01, 1.0}};
  Results results = resultsOf({{"a", choices}});
  EXPECT_THAT(recommend(results, {}).front, SizeIs(2));
  for (CellResult& cell : results.cells) addReplicates(cell, 0);
  EXPECT_THAT(recommend(results, {}).front, ElementsAre(1));
}

// The second frame, of another reference, has no replicates: it takes its interval from the first, as errors do.
TEST(Steps, OfSeveralFrames_ArePairedFrameByFrame) {
  Results results = resultsOf({{"a", {{"64", "static", 0.20, 0.01, 1.0}, {"128", "static", 0.19, 0.01, 2.0}}}});
  for (CellResult& cell : results.cells) addReplicates(cell, cell.technique[0].second == "64" ? 0 : 0.0004);
  for (const std::size_t i : {0u, 1u}) {
    results.cells.push_back(results.cells[i]);
    results.cells.back().frame = 1;
    results.cells.back().maskIntervals.clear();
    results.cells.back().maskReplicates.clear();
  }
  const Step step = recommend(results, maxError(0.25)).steps[0];
  EXPECT_NEAR(step.gain.value, 0.01, 1e-12);
  EXPECT_NEAR(step.gain.plusMinus(), 2.131 * 0.0004 / std::sqrt(15.0), 1e-9);
  // Known of one alone, it is not what the two have in common.
  results.cells[3].maskIntervals = {{"flip_hdr", {0.18, 0.20}}};
  EXPECT_NEAR(recommend(results, maxError(0.25)).steps[0].gain.plusMinus(), 0.02, 1e-12);
}

TEST(PrintedRecommendation, NamesTheAnswerItsCostTheStepsAndTheFront) {
  const RecommendRequest request = maxError(0.25);
  const Results results = oneScene();
  const std::string text = print(recommend(results, request), request, results, {});
  EXPECT_THAT(text, HasSubstr("Cheapest: resolution=128 refresh=every-frame\n  flip_hdr 0.200 +- 0.01\n"));
  EXPECT_THAT(text, HasSubstr("3.00x [2.94, 3.06] of a plain frame, 12.0 ms, 2.10 MB of probes\n"));
  EXPECT_THAT(text, HasSubstr("resolution 128 -> 256 changes nothing within 0.01 for 2.00x the time\n"));
  EXPECT_THAT(text, HasSubstr("refresh every-frame -> static loses 0.350 +- 0.02 for 0.367x the time\n"));
  EXPECT_THAT(text, HasSubstr("| *"));
  EXPECT_THAT(text, HasSubstr("probebench run quick --only ' resolution=128 (.* )?refresh=every-frame( |$)'"));
}

TEST(PrintedRecommendation, WithoutAnAnswer_SaysWhatComesNearest) {
  const RecommendRequest request = maxError(0.01);
  const Results results = oneScene();
  const std::string text = print(recommend(results, request), request, results, {});
  EXPECT_THAT(text, HasSubstr("No technique of this run holds that. The smallest error: resolution=256"));
}

TEST(PrintedRecommendation, OfABudgetThatIsTooSmall_NamesTheCheapest) {
  RecommendRequest request;
  request.budgetRatio = 0.5;
  const Results results = oneScene();
  const std::string text = print(recommend(results, request), request, results, {});
  EXPECT_THAT(text, HasSubstr("No technique of this run holds that. The cheapest: resolution=64 refresh=static"));
}

// The cells that --only keeps, by the rule of makePlan().
std::vector<std::string> keptBy(const std::string& command, const Results& results) {
  const std::size_t begin = command.find("--only '") + 8;
  const std::regex regex(command.substr(begin, command.find('\'', begin) - begin));
  std::vector<std::string> kept;
  for (const CellResult& cell : results.cells)
    if (std::regex_search(cell.key(), regex)) kept.push_back(cell.key());
  return kept;
}

TEST(TechniqueText, LeavesOutWhatMostHave) {
  const Results results = resultsOf({{"a",
                                      {{"128", "static", 0.1, 0, 1.0},
                                       {"128", "on-change", 0.2, 0, 2.0},
                                       {"128", "every-frame", 0.3, 0, 2.0},
                                       {"64", "static", 0.4, 0, 1.0}}}});
  const CandidateSet set = candidatesOf(results, {});
  EXPECT_THAT(set.common, ElementsAre(testing::Pair("resolution", "128")));
  EXPECT_EQ(techniqueText(set.candidates[0].technique, set), "refresh=static");
  EXPECT_EQ(techniqueText(set.candidates[3].technique, set), "resolution=64 refresh=static");
}

TEST(RerunCommand, KeepsTheCellsOfTheTechniqueAndNoOther) {
  Results results = resultsOf({{"builtin:a?n=1", {{"64", "static", 1, 0, 1}, {"64", "every-n?n=2", 1, 0, 1}}},
                               {"builtin:b", {{"64", "static", 1, 0, 1}, {"128", "every-n?n=2", 1, 0, 1}}}});
  for (const CellResult& cell : results.cells) {
    const std::string command = rerunCommand(results, cell.technique, {cell.scene});
    EXPECT_THAT(keptBy(command, results), ElementsAre(cell.key())) << command;
  }
}

TEST(RerunCommand, StartsWithTheRunsOwn) {
  Results results = oneScene();
  results.provenance.settings.emplace_back(kCommandSetting, "probebench run my.toml --set resolution=64,128,256");
  EXPECT_THAT(rerunCommand(results, results.cells[0].technique, {"a"}),
              testing::StartsWith("probebench run my.toml --set resolution=64,128,256 --only '"));
}

// The error of the cheaper of the two best techniques, of which one lies within 10 % of the other.
void setSecondBest(Results& results, double low, double high) {
  results.cells[1].maskIntervals = {{"flip_hdr", {low, high}}};
}

TEST(Summary, HasTheAnswerInAtMostTenLines) {
  Results results = oneScene();
  setSecondBest(results, 0.196, 0.204);
  MaterialError material;
  material.material = "chrome";
  material.share = 0.75;
  for (CellResult& cell : results.cells) cell.materials = {material};
  const std::vector<std::string> lines = summaryLines(results, {"out/quick", {}});
  EXPECT_LE(lines.size(), 10u);
  EXPECT_THAT(lines, Each(Not(HasSubstr("\n"))));
  EXPECT_THAT(lines, testing::Contains(HasSubstr("chrome 75 %")));
  EXPECT_THAT(lines, testing::Contains("Smallest error: resolution=256 refresh=every-frame at 0.190 +- 0.002, 6.00x"));
  EXPECT_THAT(lines, testing::Contains(HasSubstr("Cheapest within 10 % of it (at most 0.209): resolution=128 ")));
}

// `recommend` looks at the upper end of intervals, and the limit is printed with three digits.
TEST(Summary, IsWhatRecommendAnswersToTheLimitThatItPrints) {
  for (const double high : {0.2089, 0.2091}) {
    Results results = oneScene();
    setSecondBest(results, 0.19, high);
    const std::string answer = chosen(recommend(results, maxError(0.209)));
    EXPECT_EQ(answer, high < 0.209 ? "resolution=128 refresh=every-frame" : "resolution=256 refresh=every-frame");
    EXPECT_THAT(summaryLines(results), testing::Contains(HasSubstr("(at most 0.209): " + answer)));
    EXPECT_THAT(summaryLines(results), testing::Contains(HasSubstr("--max-error flip_hdr=0.209 ")));
  }
}

TEST(Summary, WhereNoiseIsNotKnown_SaysSoAndNamesTheSmallestError) {
  Results results = oneScene();
  for (CellResult& cell : results.cells) cell.maskIntervals.clear();
  const std::vector<std::string> lines = summaryLines(results);
  EXPECT_THAT(lines, testing::Contains("Smallest error: resolution=256 refresh=every-frame at 0.190 (interval not "
                                       "known), 6.00x"));
  EXPECT_THAT(lines, testing::Contains(HasSubstr("--max-error flip_hdr=X ")));
}

TEST(Summary, OfEqualErrors_NamesTheCheapest) {
  const Results results = resultsOf(
      {{"a", {{"256", "static", 0.19, 0, 6.0}, {"64", "static", 0.19, 0, 2.0}, {"128", "static", 0.19, 0, 3.0}}}});
  EXPECT_THAT(summaryLines(results),
              testing::Contains("Smallest error, and the cheapest within 10 % of it (at most 0.209): resolution=64 at "
                                "0.190, 2.00x"));
}

TEST(Summary, OfOneTechnique_CountsOne) {
  EXPECT_THAT(summaryLines(resultsOf({{"a", {{"64", "static", 0.1, 0, 1.0}}}})).front(),
              testing::StartsWith("1 technique on 1 scene;"));
}

TEST(Summary, NamesTheStepsThatTheErrorComesFrom) {
  Results results = oneScene();
  Attribution attribution;
  attribution.scene = "a";
  attribution.technique = results.cells[1].technique;
  attribution.steps = {{"oracle", {}, {{"flip_hdr", 0.05}}},
                       {"capture", {}, {{"flip_hdr", 0.0501}}},  // 0 %
                       {"resolution", {}, {{"flip_hdr", 0.20}}}};
  results.attribution = {attribution};
  EXPECT_THAT(summaryLines(results),
              testing::Contains("Where the error of resolution=128 refresh=every-frame comes from (a frame 0): "
                                "resolution 75 %, oracle 25 %"));
}

TEST(Summary, OfSeveralAttributions_TakesTheLastFrameOfTheTechniqueThatIsMostLikeTheAnswer) {
  Results results = oneScene();  // of which the answer is cell 2
  for (const std::size_t cell : {std::size_t{1}, std::size_t{3}})
    for (const int frame : {0, 7}) {
      Attribution attribution;
      attribution.scene = "a";
      attribution.frame = frame;
      attribution.technique = results.cells[cell].technique;
      attribution.steps = {{"oracle", {}, {{"flip_hdr", 0.05}}}};
      results.attribution.push_back(attribution);
    }
  EXPECT_THAT(summaryLines(results),
              testing::Contains("Where the error of resolution=128 refresh=every-frame comes from (a frame 7): oracle "
                                "100 %"));
}

TEST(Summary, WhereScenesHaveTheirOwnTechniques_IsByScene) {
  const Results results = resultsOf({{"a", {{"64", "static", 0.1, 0, 1.0}, {"128", "static", 0.09, 0, 2.0}}},
                                     {"b", {{"64", "every-frame", 0.2, 0, 1.8}, {"64", "static", 0.4, 0, 1.8}}}});
  const std::vector<std::string> lines = summaryLines(results);
  EXPECT_THAT(lines, testing::Contains("a: smallest error resolution=128 at 0.0900, 2.00x"));
  EXPECT_THAT(lines, testing::Contains("b: smallest error refresh=every-frame at 0.200, 1.80x"));
  EXPECT_THAT(lines, testing::Contains("  From there, resolution 128 -> 64 loses 0.0100 for 0.500x the time"));
}

TEST(Summary, OfManyScenes_NamesThoseOfTheLargestErrors) {
  std::vector<std::pair<std::string, std::vector<Choice>>> scenes;
  for (int i = 0; i < 12; ++i)
    scenes.push_back({fmt::format("scene {}", i), {{i % 2 == 0 ? "64" : "128", "static", 0.1 * (i + 1), 0, 1.0}}});
  const std::vector<std::string> lines = summaryLines(resultsOf(scenes));
  EXPECT_THAT(lines, SizeIs(10));
  EXPECT_THAT(lines.front(), testing::StartsWith("scene 11: smallest error"));
  EXPECT_EQ(lines[8], "and 4 scenes with smaller errors");
}

TEST(Summary, OfNothing_IsNothing) { EXPECT_THAT(summaryLines(Results{}), IsEmpty()); }

TEST(Summary, OfTheSampleRun_Works) {
  Results results = samples::makeResults();
  EXPECT_LE(summaryLines(results).size(), 10u);
}

}  // namespace
}  // namespace pb
