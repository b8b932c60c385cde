// External techniques: the protocol with an engine that is easily told what to do, and the three.js page where it can
// run.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "bench/metrics/metrics.h"
#include "bench/results.h"
#include "scenes/files.h"
#include "scenes/image_io.h"
#include "tests/cli/program.h"

namespace pb {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr char kSource[] = PROBEBENCH_SOURCE_DIR;

constexpr char kSuite[] = R"(
schema = 1
name = "small"
image = {{ size = [32, 18], samples = 1 }}
cost = {{ repetitions = {} }}
technique = {{ resolution = 8 }}
[[scene]]
use = "builtin:mirrors?count=2"
frames = [0, 2]
[tolerance]
mse = {{ relative = 0.01 }}
)";

// A folder with a reference store of its own, pictures of the suite's references and suites with external techniques.
class Workplace {
 public:
  // References of all frames, as the engine's pictures.
  Workplace() {
    const ProgramResult result = run("", "first");
    if (result.exitCode != 0) throw std::runtime_error(result.err);
  }

  std::string path(const std::string& name) const { return folder_.file(name); }
  std::string reference(const std::string& frame) const {
    return path("first/images/0-mirrors-frame" + frame + "-reference.exr");
  }

  // An engine that copies the references.
  std::string engine(const std::string& settings = "") const {
    return fmt::format(
        "[[external]]\nname = \"engine\"\ncommand = [\"python3\", \"{}/tests/data/external/engine.py\"]\n"
        "settings = {{ pictures = \"{}\", log = \"{}\"{} }}\n",
        kSource, reference("{frame}"), path("log"), settings);
  }

  std::vector<std::string> command(const std::string& external, const std::string& out,
                                   const std::vector<std::string>& more = {}, int repetitions = 0) const {
    writeFileAtomically(path("suite.toml"), fmt::format(kSuite, repetitions) + external);
    std::vector<std::string> arguments = {"run", path("suite.toml"), "--out", path(out), "--store", path("store")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  ProgramResult run(const std::string& external, const std::string& out, const std::vector<std::string>& more = {},
                    int repetitions = 0) const {
    return runProgram(command(external, out, more, repetitions));
  }

  std::vector<nlohmann::json> jobs() const {
    std::vector<nlohmann::json> jobs;
    if (!fs::exists(path("log"))) return jobs;
    std::istringstream lines(readFile(path("log")));
    for (std::string line; std::getline(lines, line);) jobs.push_back(nlohmann::json::parse(line));
    return jobs;
  }

  std::vector<CellResult> externalCells(const std::string& out) const {
    std::vector<CellResult> cells = readResults(path(out)).cells;
    std::erase_if(cells, [](const CellResult& cell) { return cell.technique.front().first != kExternalAxis; });
    return cells;
  }

 private:
  TemporaryFolder folder_;
};

TEST(External, PerfectPictures_HaveNoErrorAndTheirOwnTimes) {
  const Workplace workplace;
  const ProgramResult result = workplace.run(workplace.engine(), "run", {}, 1);
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("4 cells in 1 raster sequence and 1 external one"));
  const std::vector<CellResult> cells = workplace.externalCells("run");
  ASSERT_EQ(cells.size(), 2u);
  for (const CellResult& cell : cells) {
    EXPECT_THAT(cell.key(), testing::EndsWith("external=engine"));
    EXPECT_EQ(cell.metrics.sums.mse, 0);
    ASSERT_TRUE(cell.maskMetrics.has_value());
    EXPECT_EQ(cell.maskMetrics->sums.mse, 0);
    EXPECT_FALSE(cell.floor.empty());
    EXPECT_FALSE(cell.cost.has_value());
    EXPECT_TRUE(cell.counters.empty());
    ASSERT_TRUE(cell.reportedCost.has_value());
    EXPECT_EQ(cell.reportedCost->program, "engine 1.0");
    EXPECT_EQ(cell.reportedCost->frameMs, 2.0);
    EXPECT_EQ(cell.reportedCost->ratio(), 4.0);
  }
  EXPECT_THAT(result.out, HasSubstr("### External techniques"));
  EXPECT_THAT(readFile(workplace.path("run/results.csv")), HasSubstr("engine,reported_cost,frame_ms,2.0"));
  EXPECT_TRUE(fs::exists(workplace.path("run/images/0-mirrors-frame2-external=engine.exr")));
}

// Its pictures and times are kept for the run.
TEST(External, WithUntilDecided_RunsOnce) {
  const Workplace workplace;
  ASSERT_EQ(workplace.run(workplace.engine(), "plain", {}, 1).exitCode, 0);
  ASSERT_EQ(workplace.jobs().size(), 1u);
  const ProgramResult result = workplace.run(workplace.engine(), "run", {"--until-decided"}, 1);
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(workplace.jobs().size(), 2u);
  const std::vector<CellResult> cells = workplace.externalCells("run"), plain = workplace.externalCells("plain");
  ASSERT_EQ(cells.size(), plain.size());
  for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_EQ(toJson(cells[i]), toJson(plain[i]));
}

TEST(External, SkippedWithUntilDecided_IsNotAskedAgain) {
  const Workplace workplace;
  const ProgramResult result = workplace.run(workplace.engine(", mode = \"skip\""), "run", {"--until-decided"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(workplace.jobs().size(), 1u);
  EXPECT_THAT(result.out, HasSubstr("skipped: a part of the engine is not installed"));
  EXPECT_TRUE(workplace.externalCells("run").empty());
}

TEST(External, Job_HasAllFramesUpToTheLastAndAFolderThatIsGoneAfterwards) {
  const Workplace workplace;
  ASSERT_EQ(workplace.run(workplace.engine(), "run").exitCode, 0);
  const std::vector<nlohmann::json> jobs = workplace.jobs();
  ASSERT_EQ(jobs.size(), 1u);
  const nlohmann::json& frames = jobs[0]["job"]["frames"];
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_FALSE(frames[0]["image"].is_null());
  EXPECT_TRUE(frames[1]["image"].is_null());
  EXPECT_FALSE(frames[2]["image"].is_null());
  EXPECT_TRUE(jobs[0]["job"]["timing"].is_null());  // no cost is measured
  EXPECT_FALSE(fs::exists(jobs[0]["folder"].get<std::string>()));
}

TEST(External, PicturesMadeEarlier_AreScoredWithoutACommand) {
  const Workplace workplace;
  const std::string external =
      "[[external]]\nname = \"saved\"\nimages = \"first/images/{number}-{scene}-frame{frame}-reference.exr\"\n";
  const ProgramResult result = workplace.run(external, "run");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  for (const CellResult& cell : workplace.externalCells("run")) EXPECT_EQ(cell.metrics.sums.mse, 0);
  EXPECT_EQ(workplace.externalCells("run").size(), 2u);

  fs::remove(workplace.reference("2"));
  const ProgramResult incomplete = workplace.run(external, "incomplete");
  EXPECT_EQ(incomplete.exitCode, 2);
  EXPECT_THAT(incomplete.err, HasSubstr("external technique 'saved' has no picture"));
  EXPECT_FALSE(fs::exists(workplace.path("incomplete")));  // found before anything was rendered
}

TEST(External, Cells_AreBlessedCheckedAndChosenByName) {
  const Workplace workplace;
  ASSERT_EQ(workplace.run(workplace.engine(), "run").exitCode, 0);
  const std::string baseline = workplace.path("baseline.json");
  ASSERT_EQ(runProgram({"bless", workplace.path("run"), "--baseline", baseline, "--reason", "test"}).exitCode, 0);
  EXPECT_THAT(readFile(baseline), HasSubstr("external=engine"));
  EXPECT_EQ(runProgram({"check", workplace.path("run"), "--baseline", baseline}).exitCode, 0);
  ASSERT_EQ(workplace.run(workplace.engine(), "alone", {"--only", "frame=0 .*external=engine"}).exitCode, 0);
  EXPECT_EQ(readResults(workplace.path("alone")).cells.size(), 1u);
}

TEST(External, ProgramThatLacksSomething_IsSkippedWithItsReason) {
  const Workplace workplace;
  const ProgramResult result = workplace.run(workplace.engine(", mode = \"skip\""), "run");
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_THAT(result.err, HasSubstr("skipped: external engine on builtin:mirrors?count=2: a part of the engine is not "
                                    "installed"));
  EXPECT_THAT(result.out, HasSubstr("skipped: a part of the engine is not installed"));
  EXPECT_TRUE(workplace.externalCells("run").empty());
  EXPECT_EQ(readResults(workplace.path("run")).cells.size(), 2u);
}

TEST(External, ProgramThatFails_EndsTheRunWithOneSentence) {
  const Workplace workplace;
  struct Case {
    std::string external;
    int exitCode;
    std::string message;
  };
  const std::string picture = workplace.path("bad.exr");
  const auto engine = [&](const std::string& more) { return workplace.engine(", mode = \"" + more + "\""); };
  const Case cases[] = {
      {engine("fail"), 2, "external technique 'engine' failed with exit code 5: the engine has no cube maps\n"},
      {engine("forget"), 2, "external technique 'engine' has no picture"},
      {engine("bad-timing"), 2, "breaks its schema at /frame_ms/0"},
      {"[[external]]\nname = \"e\"\ncommand = [\"no-such-engine\"]\n", 3,
       "external technique 'e' wants to run 'no-such-engine', which is not on the PATH\n"},
      {"[[external]]\nname = \"e\"\ncommand = [\"./suite.toml\"]\n", 3, "which is no executable file\n"},
  };
  for (const Case& c : cases) {
    const ProgramResult result = workplace.run(c.external, "run", {}, 1);
    EXPECT_EQ(result.exitCode, c.exitCode) << c.external;
    const std::string last = result.err.substr(result.err.rfind("probebench: "));
    EXPECT_THAT(last, HasSubstr(c.message));
    EXPECT_EQ(std::ranges::count(last, '\n'), 1) << last;
    EXPECT_LT(last.size(), 500u);
  }
}

// Waits for the file, which the engine makes when it and its child run.
std::vector<int> pidsIn(const std::string& path) {
  for (int i = 0; i < 12000 && !fs::exists(path); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::istringstream text(readFile(path));
  std::vector<int> pids(2);
  text >> pids[0] >> pids[1];
  return pids;
}

bool endSoon(const std::vector<int>& pids) {
  const auto isRunning = [](int pid) {
    if (::kill(pid, 0) != 0) return false;
    const std::string status = readFile(fmt::format("/proc/{}/stat", pid));
    return status.substr(status.rfind(')') + 2, 1) != "Z";
  };
  for (int i = 0; i < 300 && std::ranges::any_of(pids, isRunning); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return std::ranges::none_of(pids, isRunning);
}

TEST(External, ProgramThatHangs_IsStoppedAfterItsTime) {
  const Workplace workplace;
  const std::string hang = workplace.engine(fmt::format(", mode = \"hang\", pids = \"{}\"", workplace.path("pids")));
  const ProgramResult result = workplace.run(hang + "timeout_s = 6\n", "run");
  EXPECT_EQ(result.exitCode, 2);
  EXPECT_THAT(result.err, HasSubstr("external technique 'engine' may take 6 s (timeout_s) and was stopped after them"));
  EXPECT_TRUE(endSoon(pidsIn(workplace.path("pids.done"))));
}

TEST(External, Interrupted_EndsTheProgramAndGoesOnWithResume) {
  const Workplace workplace;
  const std::string hang = fmt::format(", mode = \"hang\", pids = \"{}\"", workplace.path("pids"));
  RunningProgram program(
      workplace.command(workplace.engine() + "[[external]]\nname = \"slow\"" +
                            workplace.engine(hang).substr(std::string("[[external]]\nname = \"engine\"").size()),
                        "run"));
  const std::vector<int> pids = pidsIn(workplace.path("pids.done"));
  program.signal(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exitCode, 130);
  EXPECT_THAT(result.err, HasSubstr("--resume goes on"));
  EXPECT_TRUE(endSoon(pids));

  // The same suite; only the first engine has finished.
  ASSERT_EQ(workplace.jobs().size(), 2u);
  RunningProgram again(std::vector<std::string>{"run", workplace.path("suite.toml"), "--out", workplace.path("run"),
                                                "--store", workplace.path("store"), "--resume"});
  fs::remove(workplace.path("pids.done"));
  pidsIn(workplace.path("pids.done"));
  again.signal(SIGINT);
  EXPECT_EQ(again.wait().exitCode, 130);
  ASSERT_EQ(workplace.jobs().size(), 3u);
  EXPECT_EQ(workplace.jobs()[2]["job"]["technique"]["name"], "slow");
}

// Flicker looks back to the measured frame before.
TEST(External, Resumed_GetsTheMissingFramesAndTheMeasuredOneBefore) {
  const Workplace workplace;
  // The engine's second picture is not there yet.
  fs::rename(workplace.reference("2"), workplace.path("later.exr"));
  EXPECT_EQ(workplace.run(workplace.engine(), "run").exitCode, 2);
  fs::rename(workplace.path("later.exr"), workplace.reference("2"));
  ASSERT_EQ(workplace.run(workplace.engine(), "run", {"--resume"}).exitCode, 0);
  const std::vector<nlohmann::json> jobs = workplace.jobs();
  ASSERT_EQ(jobs.size(), 2u);
  EXPECT_FALSE(jobs[0]["job"]["frames"][0]["image"].is_null());
  EXPECT_EQ(jobs[1]["job"]["frames"].size(), 3u);  // the probes' history
  EXPECT_FALSE(jobs[1]["job"]["frames"][0]["image"].is_null());
  EXPECT_TRUE(jobs[1]["job"]["frames"][1]["image"].is_null());
  EXPECT_FALSE(jobs[1]["job"]["frames"][2]["image"].is_null());
  EXPECT_EQ(workplace.externalCells("run").size(), 2u);
}

// The same technique in two renderers that share no line of code. What is left are half-float cube maps, edges and the
// driver's approximate decoding of sRGB textures: relMSE 5.8e-6 measured for 640x360, of which a tenfold is allowed.
TEST(External, ThreeCubeCamera_DrawsWhatTheRasterDraws) {
  const TemporaryFolder folder;
  const std::string suite = fmt::format(R"(
schema = 1
name = "three"
image = {{ size = [160, 90], samples = 4 }}
cost = {{ repetitions = 0 }}
technique = {{ resolution = 64, bounces = 2 }}
[[scene]]
use = "builtin:mirrors?count=3"
frames = 1
[[external]]
name = "three.js"
command = ["{}/bench/external/three-cubecamera/render"]
)",
                                        kSource);
  writeFileAtomically(folder.file("suite.toml"), suite);
  const ProgramResult result =
      runProgram({"run", folder.file("suite.toml"), "--out", folder.file("run"), "--store", folder.file("store")});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  if (const std::size_t at = result.err.find("skipped: "); at != std::string::npos)
    GTEST_SKIP() << result.err.substr(at, result.err.find('\n', at) - at);
  const auto picture = [&](const std::string& suffix) {
    return rgbOf(readImage(folder.file("run/images/0-mirrors-frame1" + suffix + ".exr")).pixels);
  };
  EXPECT_LT(computeErrorSums(picture(""), picture("-external=three.js")).relmse, 6e-5);
}

}  // namespace
}  // namespace pb
