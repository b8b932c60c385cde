// The program's main job on suites that are as small as can be.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/results.h"
#include "scenes/files.h"
#include "scenes/image_io.h"
#include "tests/cli/workplace.h"

namespace pb {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kSmall = R"(
schema = 1
name = "small"
image = { size = [32, 18], samples = 1 }
cost = { repetitions = 0 }
[[scene]]
use = "builtin:mirrors?count=2"
frames = [0, 2]
[grid]
resolution = [8, 16]
refresh = ["every-frame", "static"]
[tolerance]
mse = { relative = 0.01 }
)";

class SmallSuite : public Workplace {
 public:
  explicit SmallSuite(const std::string& suite = kSmall) : Workplace(suite) {}

  // The cells as they stand in results.json; equal texts mean equal bits.
  std::vector<std::string> cells(const std::string& out) const {
    std::vector<std::string> lines;
    for (const CellResult& cell : readResults(path(out)).cells) lines.push_back(toJson(cell));
    return lines;
  }
};

std::ptrdiff_t lineCount(const std::string& path) {
  return fs::exists(path) ? std::ranges::count(readFile(path), '\n') : 0;
}

TEST(Run, OfASmallSuite_WritesResultsTablesAndImages) {
  const SmallSuite workplace;
  const ProgramResult result = workplace.run("run");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  // Results on standard output, progress on standard error.
  EXPECT_THAT(result.out, testing::StartsWith(readFile(workplace.path("run/report.md"))));
  EXPECT_THAT(result.out, testing::EndsWith("\n\nreport: " + workplace.path("run/report.html") + "\n"));
  EXPECT_THAT(result.err, HasSubstr("8 cells in 4 raster sequences, 2 references"));
  EXPECT_THAT(result.err, HasSubstr("control: 1 of 1"));
  EXPECT_THAT(result.err, HasSubstr("errors of mirrors: 8 of 8"));

  const Results results = readResults(workplace.path("run"));
  EXPECT_EQ(results.cells.size(), 8u);
  EXPECT_EQ(results.provenance.controlOutcome, "passed");
  EXPECT_EQ(results.tolerance.size(), 1u);
  for (const CellResult& cell : results.cells) {
    EXPECT_GT(cell.metrics.sums.mse, 0);
    EXPECT_TRUE(cell.maskMetrics.has_value());
    EXPECT_GT(cell.maskMetrics->sums.mse, cell.metrics.sums.mse);  // the mask is where the approximation is
  }
  EXPECT_TRUE(fs::exists(workplace.path("run/results.csv")));
  EXPECT_FALSE(fs::exists(workplace.path("run/benchmark.json")));  // no cost was measured

  std::size_t references = 0, renderings = 0, maps = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(workplace.path("run/images"))) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with("-reference.exr"))
      ++references;
    else if (name.ends_with(".exr"))
      ++renderings;
    else if (name.ends_with("-flip.png"))
      ++maps;
  }
  EXPECT_EQ(references, 2u);
  EXPECT_EQ(renderings, 4u);
  EXPECT_EQ(maps, 4u);
}

TEST(Run, WithAnyNumberOfThreads_HasTheSameBits) {
  const SmallSuite workplace;
  ASSERT_EQ(workplace.run("one", {"--threads", "1", "--store", workplace.path("store-one")}).exitCode, 0);
  ASSERT_EQ(workplace.run("three", {"--threads", "3", "--store", workplace.path("store-three")}).exitCode, 0);
  EXPECT_EQ(workplace.cells("one"), workplace.cells("three"));
}

TEST(Run, FromStoredReferences_HasTheSameBits) {
  const SmallSuite workplace;
  ASSERT_EQ(workplace.run("first").exitCode, 0);
  ASSERT_EQ(workplace.run("second").exitCode, 0);
  EXPECT_EQ(workplace.cells("first"), workplace.cells("second"));
}

TEST(Run, WithADamagedStore_WarnsAndRendersAnew) {
  const SmallSuite workplace;
  ASSERT_EQ(workplace.run("first").exitCode, 0);
  for (const fs::directory_entry& entry : fs::directory_iterator(workplace.path("store")))
    if (entry.path().extension() == ".exr") fs::resize_file(entry.path(), 100);
  const ProgramResult result = workplace.run("second");
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_THAT(result.err, HasSubstr("warning: stored reference"));
  EXPECT_EQ(workplace.cells("first"), workplace.cells("second"));
}

TEST(Run, WithOtherScenesAndAxes_ReplacesTheSuites) {
  const SmallSuite workplace;
  const ProgramResult result =
      workplace.run("run", {"--scene", "builtin:mirrors?count=1", "--scene", "builtin:mirrors?count=3", "--set",
                            "resolution=8", "--set", "refresh=static", "--only", "frame=2"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const Results results = readResults(workplace.path("run"));
  ASSERT_EQ(results.cells.size(), 2u);
  EXPECT_EQ(results.cells[0].scene, "builtin:mirrors?count=1");
  EXPECT_EQ(results.cells[1].scene, "builtin:mirrors?count=3");
  EXPECT_EQ(results.cells[0].frame, 2);
}

TEST(Run, SameSuiteAgain_OverwritesItsOwnFolderOnly) {
  const SmallSuite workplace;
  ASSERT_EQ(workplace.run("run").exitCode, 0);
  EXPECT_EQ(workplace.run("run", {"--set", "resolution=8"}).exitCode, 0);
  EXPECT_EQ(workplace.cells("run").size(), 4u);

  fs::create_directory(workplace.path("foreign"));
  writeFileAtomically(workplace.path("foreign/thesis.txt"), "years of work");
  const ProgramResult refused = workplace.run("foreign");
  EXPECT_EQ(refused.exitCode, 2);
  EXPECT_THAT(refused.err, HasSubstr("was not made by probebench"));
}

TEST(Run, Interrupted_KeepsFinishedCellsAndGoesOnWithResume) {
  const SmallSuite workplace;
  const std::vector<std::string> grid = {"--set", "resolution=8,16,32,64", "--set", "bounces=1,2,3"};
  constexpr std::ptrdiff_t kCells = 48;  // enough that the interrupt comes long before the last one
  ASSERT_EQ(workplace.run("whole", grid).exitCode, 0);

  RunningProgram program(workplace.command("stopped", grid));
  const std::string journal = workplace.path("stopped/journal.jsonl");
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (lineCount(journal) == 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  program.signal(SIGINT);
  const ProgramResult stopped = program.wait();
  EXPECT_EQ(stopped.exitCode, 130);
  EXPECT_THAT(stopped.err, HasSubstr("--resume goes on"));
  EXPECT_FALSE(fs::exists(workplace.path("stopped/results.json")));
  const std::ptrdiff_t kept = lineCount(journal);
  EXPECT_GE(kept, 1);
  EXPECT_LT(kept, kCells);

  std::vector<std::string> resume = grid;
  resume.emplace_back("--resume");
  const ProgramResult resumed = workplace.run("stopped", resume);
  EXPECT_EQ(resumed.exitCode, 0) << resumed.err;
  // Only what was missing is measured.
  EXPECT_THAT(resumed.err, HasSubstr(fmt::format("errors of mirrors: {0} of {0}", kCells - kept)));
  EXPECT_EQ(lineCount(journal), kCells);
  EXPECT_EQ(workplace.cells("stopped"), workplace.cells("whole"));
}

TEST(Resume, OfACompleteRun_MeasuresNothingAndSaysTheSame) {
  const SmallSuite workplace;
  const ProgramResult whole = workplace.run("run");
  ASSERT_EQ(whole.exitCode, 0) << whole.err;
  const std::string results = readFile(workplace.path("run/results.json"));
  const ProgramResult resumed = workplace.run("run", {"--resume"});
  EXPECT_EQ(resumed.exitCode, 0) << resumed.err;
  EXPECT_EQ(resumed.out, whole.out);
  EXPECT_THAT(resumed.err, testing::AllOf(HasSubstr("is complete"), testing::Not(HasSubstr("control"))));
  EXPECT_EQ(readFile(workplace.path("run/results.json")), results);
}

// Numbers don't depend on them, but what is stored has to be what the suite says.
TEST(Resume, OfACompleteRunWithOtherTolerances_StoresThem) {
  const SmallSuite workplace;
  ASSERT_EQ(workplace.run("run").exitCode, 0);
  const Results before = readResults(workplace.path("run"));
  std::string suite = readFile(workplace.suitePath());
  const std::size_t at = suite.find("[tolerance]");
  ASSERT_NE(at, std::string::npos);
  writeFileAtomically(workplace.suitePath(), suite.insert(at + 11, "\nrelmse = { relative = 0.125 }"));
  const ProgramResult resumed = workplace.run("run", {"--resume"});
  ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
  const Results after = readResults(workplace.path("run"));
  EXPECT_EQ(after.tolerance.size(), before.tolerance.size() + 1);
  ASSERT_NE(findTolerance(after.tolerance, "relmse"), nullptr);
  EXPECT_EQ(largestAllowedDelta(*findTolerance(after.tolerance, "relmse"), 1.0), 0.125);
}

// All four techniques share captures; of each something else is missing: nothing, a frame, the other frame, everything.
TEST(Resume, WithOnlySomeMembersOfAGroupOpen_HasTheSameBits) {
  const SmallSuite workplace;
  const std::vector<std::string> axes = {
      "--scene", "builtin:mirror-cube", "--set", "refresh=every-frame",
      "--set",   "resolution=16",       "--set", "lookup=infinite,box-proxy,sphere-proxy,distance-impostor"};
  const ProgramResult whole = workplace.run("run", axes);
  ASSERT_EQ(whole.exitCode, 0) << whole.err;
  EXPECT_THAT(whole.err, HasSubstr("of which 6 share another's captures"));
  const std::vector<std::string> cells = workplace.cells("run");
  std::string kept;
  for (const CellResult& cell : readResults(workplace.path("run")).cells) {
    const auto has = [&](const char* lookup) {
      return cell.key().find(std::string("lookup=") + lookup) != std::string::npos;
    };
    if (has("infinite") || (has("box-proxy") && cell.frame == 0) || (has("sphere-proxy") && cell.frame == 2))
      kept += toJson(cell) + '\n';
  }
  writeFileAtomically(workplace.path("run/journal.jsonl"), kept);
  fs::remove(workplace.path("run/results.json"));
  std::vector<std::string> resume = axes;
  resume.emplace_back("--resume");
  const ProgramResult resumed = workplace.run("run", resume);
  ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("errors of mirror-cube: 4 of 4"));
  EXPECT_EQ(workplace.cells("run"), cells);
}

// One level triangle of clear glass: every path that meets it chooses between the sky above and the ground below.
constexpr const char* kGlassTriangle = R"({
  "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
  "materials": [{"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AACAvwAAAAAAAIA/AACAPwAAAAAAAIA/AAAAAAAAAAAAAIC/"}],
  "extensionsUsed": ["KHR_materials_transmission"]})";

TEST(Run, WithANoisyReference_IsInconclusiveAlsoWhenResumed) {
  std::string suite = kSmall;
  suite.replace(suite.find("builtin:mirrors?count=2"), 23, "glass.gltf");
  suite.insert(suite.find("cost ="), "reference = { spp = 600, max_noise = 1e-12 }\n");
  const SmallSuite workplace(suite);
  writeFileAtomically(workplace.path("glass.gltf"), kGlassTriangle);
  const ProgramResult first = workplace.run("run");
  EXPECT_EQ(first.exitCode, 4) << first.err;
  EXPECT_THAT(first.err, HasSubstr("2 references are too noisy"));
  EXPECT_THAT(first.err, HasSubstr("at up to 600 samples"));
  const ProgramResult resumed = workplace.run("run", {"--resume"});
  EXPECT_EQ(resumed.exitCode, 4) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("2 references are too noisy"));

  std::vector<std::string> bless = {"bless",  workplace.path("run"), "--baseline", workplace.path("b.json"), "--reason",
                                    "because"};
  const ProgramResult refused = runProgram(bless);
  EXPECT_EQ(refused.exitCode, 4) << refused.err;
  EXPECT_FALSE(fs::exists(workplace.path("b.json")));
  bless.emplace_back("--force");
  EXPECT_EQ(runProgram(bless).exitCode, 0);
  const ProgramResult checked = runProgram({"check", workplace.path("run"), "--baseline", workplace.path("b.json")});
  EXPECT_EQ(checked.exitCode, 4) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("* Noise: max_noise is 1e-12, but references of scene"));
}

TEST(Run, ThatCantStart_KeepsTheEarlierRun) {
  const SmallSuite workplace;
  ASSERT_EQ(workplace.run("run").exitCode, 0);
  const char* variables[] = {"HOME", "XDG_CACHE_HOME"};
  std::map<const char*, std::string> before;
  for (const char* variable : variables) {
    if (const char* value = std::getenv(variable)) before[variable] = value;
    unsetenv(variable);
  }
  const ProgramResult result = runProgram({"run", workplace.path("suite.toml"), "--out", workplace.path("run")});
  for (const auto& [variable, value] : before) setenv(variable, value.c_str(), 1);
  EXPECT_EQ(result.exitCode, 3) << result.err;  // there is no folder for the references
  EXPECT_EQ(workplace.cells("run").size(), 8u);
}

TEST(Run, OfTechniquesThatASceneRefuses_EndsBeforeTheControl) {
  const SmallSuite workplace;
  // 64 cubes of 6 * 4096^2 texels of 8 bytes: 48 GiB. `metals` has rough spheres.
  for (const auto& [scene, setting, message] :
       {std::array{"builtin:mirrors?count=64", "resolution=4096", "the device allows"},
        std::array{"builtin:metals", "storage=octahedral", "filter must be none"}}) {
    const ProgramResult result = workplace.run("run", {"--scene", scene, "--set", setting});
    EXPECT_EQ(result.exitCode, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_THAT(result.err, testing::Not(HasSubstr("control")));
  }
}

TEST(Run, ResumedWithOtherSettings_IsRefused) {
  const SmallSuite workplace;
  ASSERT_EQ(workplace.run("run").exitCode, 0);
  const ProgramResult result = workplace.run("run", {"--resume", "--set", "resolution=8"});
  EXPECT_EQ(result.exitCode, 2);
  EXPECT_THAT(result.err, HasSubstr("--resume wants the same"));
}

TEST(Run, ShardsMerged_AreTheWhole) {
  const SmallSuite workplace;
  ASSERT_EQ(workplace.run("whole").exitCode, 0);
  ASSERT_EQ(workplace.run("a", {"--shard", "1/3"}).exitCode, 0);
  ASSERT_EQ(workplace.run("b", {"--shard", "2/3"}).exitCode, 0);
  ASSERT_EQ(workplace.run("c", {"--shard", "3/3"}).exitCode, 0);
  const auto merge = [&](std::vector<std::string> parts, const std::string& output) {
    std::vector<std::string> arguments = {"merge"};
    for (const std::string& part : parts) arguments.push_back(workplace.path(part));
    arguments.insert(arguments.end(), {"-o", workplace.path(output)});
    return runProgram(arguments);
  };
  const ProgramResult merged = merge({"a", "b", "c"}, "merged");
  EXPECT_EQ(merged.exitCode, 0) << merged.err;
  EXPECT_EQ(workplace.cells("merged"), workplace.cells("whole"));
  EXPECT_TRUE(fs::exists(workplace.path("merged/report.html")));
  for (const CellResult& cell : readResults(workplace.path("merged")).cells)
    EXPECT_TRUE(fs::exists(workplace.path("merged/" + cell.pictures.reference))) << cell.pictures.reference;

  const ProgramResult twice = merge({"a", "a"}, "twice");
  EXPECT_EQ(twice.exitCode, 2);
  EXPECT_THAT(twice.err, HasSubstr("stands in another run too"));

  const ProgramResult ontoPart = merge({"a", "b"}, "b/../a/");
  EXPECT_EQ(ontoPart.exitCode, 2);
  EXPECT_THAT(ontoPart.err, HasSubstr("may not replace one of its parts"));
  const ProgramResult ontoRun = merge({"a", "b"}, "whole");
  EXPECT_EQ(ontoRun.exitCode, 2);
  EXPECT_THAT(ontoRun.err, HasSubstr("already holds a run"));
  EXPECT_EQ(workplace.cells("whole").size(), 8u);

  const Results b = readResults(workplace.path("b"));
  const auto mergeWith = [&](const Results& changed) {
    writeFileAtomically(workplace.path("b/results.json"), toJson(changed));
    return merge({"a", "b"}, "changed").err;
  };
  Results changed = b;
  changed.provenance.sceneHashes.begin()->second = "0";
  EXPECT_THAT(mergeWith(changed), HasSubstr("must be of the same scenes"));
  changed = b;
  changed.provenance.controlOutcome = "failed";
  EXPECT_THAT(mergeWith(changed), HasSubstr("whose control did not pass"));
  changed = b;
  changed.cells.front().cost = CostResult();
  changed.provenance.threads += 1;
  EXPECT_THAT(mergeWith(changed), HasSubstr("same CPU and number of threads"));
  EXPECT_FALSE(fs::exists(workplace.path("changed")));
}

TEST(Gate, PassesTheBlessedRunAndFailsAnotherOne) {
  const SmallSuite workplace;
  ASSERT_EQ(workplace.run("run").exitCode, 0);
  const std::string baseline = workplace.path("baseline.json");
  const ProgramResult blessed =
      runProgram({"bless", workplace.path("run"), "--baseline", baseline, "--reason", "first"});
  EXPECT_EQ(blessed.exitCode, 0) << blessed.err;
  const ProgramResult same = runProgram(
      {"check", workplace.path("run"), "--baseline", baseline, "--junit", workplace.path("junit.xml"), "--json"});
  EXPECT_EQ(same.exitCode, 0) << same.out;
  EXPECT_TRUE(nlohmann::json::accept(same.out));
  EXPECT_THAT(readFile(workplace.path("junit.xml")), HasSubstr("<testsuite"));

  ASSERT_EQ(workplace.run("run", {"--set", "resolution=8"}).exitCode, 0);  // half of the cells are missing
  const ProgramResult other = runProgram({"check", workplace.path("run"), "--baseline", baseline});
  EXPECT_EQ(other.exitCode, 1);
  EXPECT_THAT(other.out, HasSubstr("missing"));
}

// As a program wrote it that didn't know these axes and counted no coats.
TEST(Gate, ReadsResultsFromBeforeAnAxisWasAdded) {
  const SmallSuite workplace;
  ASSERT_EQ(workplace.run("run").exitCode, 0);
  auto document = nlohmann::ordered_json::parse(readFile(workplace.path("run/results.json")));
  for (auto& cell : document["cells"]) {
    for (const char* axis : {"coats", "shadow_resolution"}) cell["technique"].erase(axis);
    for (const char* counter : {"coats_from_probe", "coats_from_environment"}) cell["counters"].erase(counter);
    cell.erase("coats_of_probes");
  }
  fs::create_directory(workplace.path("older"));
  writeFileAtomically(workplace.path("older/results.json"), document.dump());

  EXPECT_EQ(runProgram({"report", workplace.path("older")}).exitCode, 0);
  const ProgramResult merged = runProgram({"merge", workplace.path("older"), "-o", workplace.path("merged")});
  EXPECT_EQ(merged.exitCode, 0) << merged.err;
  const std::string baseline = workplace.path("baseline.json");
  const ProgramResult blessed =
      runProgram({"bless", workplace.path("merged"), "--baseline", baseline, "--reason", "first"});
  EXPECT_EQ(blessed.exitCode, 0) << blessed.err;
  const ProgramResult same = runProgram({"check", workplace.path("run"), "--baseline", baseline});
  EXPECT_EQ(same.exitCode, 0) << same.out;
  EXPECT_THAT(same.out, HasSubstr("were not compared: coats_from_environment, coats_from_probe."));

  ASSERT_EQ(workplace.run("run", {"--set", "coats=none"}).exitCode, 0);
  const ProgramResult other = runProgram({"check", workplace.path("run"), "--baseline", baseline});
  EXPECT_EQ(other.exitCode, 1);
  EXPECT_THAT(other.out, HasSubstr("coats=none"));
}

TEST(Run, WithCost_MeasuresWhatTheModelCounts) {
  std::string suite = kSmall;
  suite.replace(suite.find("repetitions = 0"), 15, "repetitions = 3");
  const SmallSuite workplace(suite);
  const ProgramResult result = workplace.run("run", {"--set", "refresh=every-frame,faces?k=1,static", "--set",
                                                     "bounces=1,2", "--only", "frame=0 .*resolution=8"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const Results results = readResults(workplace.path("run"));
  ASSERT_EQ(results.cells.size(), 6u);
  for (const CellResult& cell : results.cells) {
    ASSERT_TRUE(cell.cost.has_value());
    EXPECT_EQ(cell.cost->repetitions, 3);
    // Analytic and counted: 6NB+1 with N = 2 mirrors, 1+B for one face a frame, 1 for static.
    EXPECT_NEAR(cell.cost->measuredRendersPerFrame, cell.cost->rendersPerFrame, 1e-9) << cell.key();
    EXPECT_LE(cell.cost->frameMsLow, cell.cost->frameMs);
    EXPECT_GE(cell.cost->frameMsHigh, cell.cost->frameMs);
    EXPECT_GT(cell.cost->plainMs, 0);
  }
  EXPECT_EQ(results.cells[0].cost->rendersPerFrame, 13);
  EXPECT_EQ(results.cells[1].cost->rendersPerFrame, 25);
  EXPECT_EQ(results.cells[2].cost->rendersPerFrame, 2);
  EXPECT_EQ(results.cells[3].cost->rendersPerFrame, 3);
  EXPECT_EQ(results.cells[4].cost->rendersPerFrame, 1);

  const auto benchmark = nlohmann::json::parse(readFile(workplace.path("run/benchmark.json")));
  EXPECT_TRUE(benchmark["context"].contains("gl_renderer"));
  const auto isRepetition = [](const auto& b) { return b["run_type"] == "iteration"; };
  EXPECT_EQ(std::ranges::count_if(benchmark["benchmarks"], isRepetition), 6 * 3);
}

TEST(Run, OnAFullDisk_EndsWithOneSentenceAndNothingHalfWritten) {
  const SmallSuite workplace;
  // Small enough for no image, large enough for the marker and messages.
  ProgramOptions full;
  full.maxFileBytes = 1024;
  const ProgramResult result = runProgram(workplace.command("run"), full);
  EXPECT_EQ(result.exitCode, 3) << result.err;
  EXPECT_THAT(result.err, HasSubstr("\nprobebench: "));
  EXPECT_FALSE(fs::exists(workplace.path("run/results.json")));
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(fs::path(workplace.path("run")).parent_path()))
    if (entry.is_regular_file()) {
      EXPECT_LT(entry.file_size(), 1024u) << entry.path();
      EXPECT_NE(entry.path().extension(), ".exr") << entry.path();
    }
}

// /proc refuses new folders even to root.
TEST(Run, IntoAFolderThatCantBeMade_IsAnEnvironmentError) {
  const SmallSuite workplace;
  ProgramResult result = runProgram({"run", workplace.path("suite.toml"), "--out", "/proc/run"});
  EXPECT_EQ(result.exitCode, 3);
  EXPECT_THAT(result.err, HasSubstr("output folder '/proc/run' can't be made"));

  result = workplace.run("run", {"--store", "/proc/store"});
  EXPECT_EQ(result.exitCode, 3);
  EXPECT_THAT(result.err, HasSubstr("reference store '/proc/store' can't be made"));
}

TEST(Render, OfBothRenderers_WritesPicturesThatAgreeOutsideOfMirrors) {
  const SmallSuite workplace;
  for (const char* renderer : {"raster", "reference"}) {
    const ProgramResult result = runProgram({"render", "builtin:mirrors", "--with", renderer, "-o",
                                             workplace.path(std::string(renderer) + ".exr"), "--size", "64x36", "--aov",
                                             "ids=" + workplace.path(std::string(renderer) + "-ids.exr")});
    ASSERT_EQ(result.exitCode, 0) << result.err;
  }
  const Image raster = rgbOf(readImage(workplace.path("raster.exr")).pixels);
  const Image reference = rgbOf(readImage(workplace.path("reference.exr")).pixels);
  ASSERT_EQ(raster.width(), 64);
  EXPECT_NEAR(raster(32, 0).z, reference(32, 0).z, 1e-5f);  // the sky at the top
  EXPECT_NE(raster, reference);                             // the mirrors differ
  const std::vector<NamedPlane> ids = readExrChannels(workplace.path("raster-ids.exr"));
  ASSERT_EQ(ids.size(), 3u);
  EXPECT_EQ(ids[0].plane.width(), 128);  // 2 x 2 samples a pixel
}

// A preset sets every axis: what is set beside it counts, wherever it stands.
TEST(Render, SettingsBesideAPreset_CountInAnyOrder) {
  const SmallSuite workplace;
  const auto render = [&](const std::string& name, const std::vector<std::string>& settings) {
    std::vector<std::string> arguments = {"render", "builtin:mirrors",    "--with", "raster",
                                          "-o",     workplace.path(name), "--size", "32x18"};
    for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
    const ProgramResult result = runProgram(arguments);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return rgbOf(readImage(workplace.path(name)).pixels);
  };
  const Image before = render("before.exr", {"resolution=8", "preset=godot-once"});
  EXPECT_EQ(before, render("after.exr", {"preset=godot-once", "resolution=8"}));
  EXPECT_NE(before, render("alone.exr", {"preset=godot-once"}));
}

TEST(Render, IntoAFolderThatIsNotThere_IsAnEnvironmentError) {
  const ProgramResult result =
      runProgram({"render", "builtin:mirrors", "--with", "reference", "--size", "16x16", "-o", "/proc/a.exr"});
  EXPECT_EQ(result.exitCode, 3);
  EXPECT_THAT(result.err, HasSubstr("/proc/a.exr"));
}

TEST(Render, Exposure_ScalesByStops) {
  const SmallSuite workplace;
  for (const char* stops : {"0", "1"}) {
    const ProgramResult result = runProgram({"render", "builtin:mirrors", "--with", "reference", "--size", "16x16",
                                             "--exposure", stops, "-o", workplace.path(std::string(stops) + ".exr")});
    ASSERT_EQ(result.exitCode, 0) << result.err;
  }
  const Image plain = rgbOf(readImage(workplace.path("0.exr")).pixels);
  const Image brighter = rgbOf(readImage(workplace.path("1.exr")).pixels);
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_EQ(brighter[i], 2.0f * plain[i]);
}

}  // namespace
}  // namespace pb
