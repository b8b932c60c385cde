// Commands that decide: init, the plan, recommend, --until-decided.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "bench/results.h"
#include "bench/verdict.h"
#include "scenes/files.h"
#include "tests/cli/workplace.h"

namespace pb {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kSmall = R"(
schema = 1
name = "small"
image = { size = [32, 18], samples = 1 }
cost = { repetitions = 1 }
[[scene]]
use = "builtin:mirrors?count=2"
[grid]
resolution = [8, 16]
)";

TEST(Init, WritesASuiteThatRuns) {
  const TemporaryFolder folder;
  const std::string suite = folder.file("mine.toml");
  const ProgramResult written = runProgram({"init", "builtin:planar-floor", "-o", suite});
  ASSERT_EQ(written.exitCode, 0) << written.err;
  EXPECT_THAT(written.out, HasSubstr("1 mirror (1 flat)"));
  EXPECT_THAT(written.out, HasSubstr("[attribution]\n"));
  EXPECT_EQ(readFile(suite), written.out);
  const ProgramResult run = runProgram({"run", suite, "--dry-run", "--store", folder.file("store")});
  EXPECT_EQ(run.exitCode, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("no rates measured yet"));
}

TEST(Init, LeavesAnExistingFileAsItIs) {
  const TemporaryFolder folder;
  const std::string suite = folder.file("mine.toml");
  writeFileAtomically(suite, "mine");
  const ProgramResult result = runProgram({"init", "builtin:glass", "-o", suite});
  EXPECT_EQ(result.exitCode, 2);
  EXPECT_THAT(result.err, HasSubstr("exists"));
  EXPECT_EQ(readFile(suite), "mine");
}

TEST(Recommend, AnswersFromARunAndNamesTheCommandThatRepeatsIt) {
  const Workplace workplace(kSmall);
  const std::string out = workplace.path("out");
  const ProgramResult run = workplace.run("out");
  ASSERT_EQ(run.exitCode, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("\n2 techniques on 1 scene; error: flip_hdr"));
  EXPECT_THAT(run.out, testing::EndsWith("\n\nreport: " + out + "/report.html\n"));  // the answer comes last
  const ProgramResult answer = runProgram({"recommend", out, "--max-error", "flip_hdr=1"});
  EXPECT_EQ(answer.exitCode, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("Cheapest: resolution="));
  EXPECT_THAT(answer.out, HasSubstr("probebench run " + workplace.suitePath() + " --only ' resolution="));
  EXPECT_EQ(runProgram({"recommend", out, "--max-error", "flip_hdr=0"}).exitCode, 1);
  EXPECT_EQ(runProgram({"recommend", out}).exitCode, 2);
  EXPECT_EQ(runProgram({"recommend", out, "--max-error", "flip=1"}).exitCode, 2);
  for (const char* budget : {"nan", "inf", "-5", "0", "5x"})
    EXPECT_THAT(runProgram({"recommend", out, "--budget-ms", budget}).err,
                HasSubstr(fmt::format("wants a number above 0, got '{}'", budget)));
  EXPECT_EQ(runProgram({"recommend", workplace.path("nothing"), "--budget-ms", "1"}).exitCode, 2);
  // The rates of that run tell how long the next one takes.
  const ProgramResult plan = workplace.run("out", {"--dry-run"});
  EXPECT_THAT(plan.out, HasSubstr("should take about"));
  EXPECT_THAT(plan.out, Not(HasSubstr("no rates")));
}

TEST(UntilDecided, WithoutNoise_IsDecidedAtOnce) {
  const Workplace workplace(kSmall);
  const ProgramResult run = workplace.run("out", {"--no-cost", "--until-decided", "--budget-s", "1"});
  EXPECT_EQ(run.exitCode, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("the only pair of cells is decided"));
}

// Two batches leave one degree of freedom: three lookups are not told apart by them.
constexpr const char* kNoisy = R"(
schema = 1
name = "noisy"
image = { size = [32, 18], samples = 1 }
cost = { repetitions = 0 }
reference = { spp = 2 }
[[scene]]
use = "builtin:metals?grid=2"
[grid]
resolution = [8]
lookup = ["infinite", "sphere-proxy", "box-proxy"]
)";

TEST(UntilDecided, WhenTheBudgetEnds_KeepsTheResultsAndExitsWith4) {
  const Workplace workplace(kNoisy);
  const ProgramResult run = workplace.run("out", {"--until-decided", "--budget-s", "0.001"});
  EXPECT_EQ(run.exitCode, 4) << run.err;
  EXPECT_THAT(run.err, HasSubstr("more samples would take longer than the budget"));
  const Results results = readResults(workplace.path("out"));
  EXPECT_GT(rankingState(results.cells, "flip_hdr").undecided, 0u);
  // What verdicts come from is kept, also by merge.
  ASSERT_EQ(runProgram({"merge", workplace.path("out"), "-o", workplace.path("merged")}).exitCode, 0);
  const Results merged = readResults(workplace.path("merged"));
  ASSERT_EQ(merged.cells.size(), 3u);
  for (std::size_t i = 0; i < merged.cells.size(); ++i) {
    EXPECT_EQ(merged.cells[i].maskReplicates.size(), 5u);
    EXPECT_EQ(merged.cells[i].maskReplicates, results.cells[i].maskReplicates);
    EXPECT_EQ(merged.cells[i].referenceHash, merged.cells[0].referenceHash);
  }
}

// With a later budget the ranking would end elsewhere, and the run would be another one.
TEST(UntilDecided, Resumed_GoesOnWithWhatWasFound) {
  const Workplace workplace(kNoisy);
  ASSERT_EQ(workplace.run("out", {"--until-decided", "--budget-s", "0.001"}).exitCode, 4);
  const std::string ranking = readFile(workplace.path("out/ranking.json"));
  const Results before = readResults(workplace.path("out"));
  std::filesystem::remove(workplace.path("out/results.json"));
  const ProgramResult resumed = workplace.run("out", {"--until-decided", "--budget-s", "100", "--resume"});
  EXPECT_EQ(resumed.exitCode, 4) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("more samples would take longer than the budget"));
  EXPECT_EQ(readFile(workplace.path("out/ranking.json")), ranking);
  const Results after = readResults(workplace.path("out"));
  ASSERT_EQ(after.cells.size(), before.cells.size());
  for (std::size_t i = 0; i < after.cells.size(); ++i) EXPECT_EQ(toJson(after.cells[i]), toJson(before.cells[i]));
  EXPECT_EQ(workplace.run("out").exitCode, 0);  // a run without it, of the same suite, leaves nothing of it
  EXPECT_FALSE(std::filesystem::exists(workplace.path("out/ranking.json")));
}

// What an interrupt leaves of the pictures is gone on with: the cells are those of a run that was left alone.
TEST(UntilDecided, Interrupted_GoesOnWhereItWas) {
  const Workplace workplace(kNoisy);
  ASSERT_EQ(workplace.run("whole", {"--until-decided", "--budget-s", "0.001"}).exitCode, 4);
  RunningProgram program(workplace.command("out", {"--until-decided"}));
  const std::string kept = workplace.path("out/kept/pictures.jsonl");
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!std::filesystem::exists(kept) && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  program.signal(SIGINT);
  EXPECT_EQ(program.wait().exitCode, 130);
  const ProgramResult resumed = workplace.run("out", {"--until-decided", "--budget-s", "0.001", "--resume"});
  EXPECT_EQ(resumed.exitCode, 4) << resumed.err;
  const Results whole = readResults(workplace.path("whole")), results = readResults(workplace.path("out"));
  ASSERT_EQ(results.cells.size(), whole.cells.size());
  for (std::size_t i = 0; i < results.cells.size(); ++i) EXPECT_EQ(toJson(results.cells[i]), toJson(whole.cells[i]));
  EXPECT_FALSE(std::filesystem::exists(workplace.path("out/kept")));
}

// The same search again in a run that knows nothing of the first would end elsewhere.
TEST(UntilDecided, IsNotResumedWithoutIt) {
  const Workplace workplace(kNoisy);
  ASSERT_EQ(workplace.run("out", {"--until-decided", "--budget-s", "0.001"}).exitCode, 4);
  EXPECT_EQ(workplace.run("out", {"--resume"}).exitCode, 2);
}

TEST(UntilDecided, PlansNothingTwice) {
  const Workplace workplace(kNoisy);
  const std::string line = "--until-decided renders them first, and scores the last ones at least once more\n";
  std::string with = workplace.run("out", {"--until-decided", "--dry-run"}).out;
  ASSERT_THAT(with, HasSubstr('\n' + line));
  with.erase(with.find(line), line.size());
  EXPECT_EQ(with, workplace.run("out", {"--dry-run"}).out);
}

}  // namespace
}  // namespace pb
