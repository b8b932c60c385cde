// `check`, `bless`, `report` and `merge` on run directories of all conditions, and the gate's test of itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/results.h"
#include "scenes/files.h"
#include "tests/cli/program.h"
#include "tests/unit/sample_results.h"

namespace pb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// A run directory and the baseline that was blessed from it.
class Workplace {
 public:
  explicit Workplace(const Results& run = samples::makeResults()) {
    write("run", run);
    const ProgramResult blessed =
        runProgram({"bless", path("run"), "--baseline", path("baseline.json"), "--reason", "first"});
    EXPECT_EQ(blessed.exitCode, 0) << blessed.err;
  }

  std::string path(const std::string& name) const { return folder_.file(name); }
  void write(const std::string& folder, const Results& run) const { writeText(folder, toJson(run)); }
  void writeText(const std::string& folder, const std::string& text) const {
    std::filesystem::create_directories(path(folder));
    writeFileAtomically(path(folder + "/results.json"), text);
  }
  ProgramResult check(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"check", path("run"), "--baseline", path("baseline.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments);
  }

 private:
  TemporaryFolder folder_;
};

void expectOneSentence(const ProgramResult& result, const std::string& part) {
  EXPECT_EQ(result.exitCode, 2) << result.out << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr(part));
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
}

struct DamagedText {
  const char* name;
  std::string (*damage)(const std::string& text);
  const char* sentence;
};

class DamagedRun : public testing::TestWithParam<DamagedText> {};

TEST_P(DamagedRun, GivesOneSentenceAndNoTable) {
  const Workplace workplace;
  const std::string run = workplace.path("damaged"), baseline = workplace.path("baseline.json");
  workplace.writeText("damaged", GetParam().damage(readFile(workplace.path("run/results.json"))));
  const std::string stored = readFile(baseline);
  expectOneSentence(runProgram({"check", run, "--baseline", baseline, "--junit", workplace.path("junit.xml")}),
                    GetParam().sentence);
  expectOneSentence(runProgram({"bless", run, "--baseline", baseline, "--reason", "why"}), GetParam().sentence);
  expectOneSentence(runProgram({"report", run, "-o", workplace.path("tables")}), GetParam().sentence);
  expectOneSentence(runProgram({"merge", run, "-o", workplace.path("merged")}), GetParam().sentence);
  expectOneSentence(runProgram({"merge", workplace.path("run"), run, "-o", workplace.path("merged")}),
                    GetParam().sentence);
  EXPECT_EQ(readFile(baseline), stored);
  for (const char* output : {"junit.xml", "tables", "merged"})
    EXPECT_FALSE(std::filesystem::exists(workplace.path(output))) << output;
}

class DamagedBaseline : public testing::TestWithParam<DamagedText> {};

TEST_P(DamagedBaseline, GivesOneSentenceAndNoTable) {
  const Workplace workplace;
  const std::string path = workplace.path("baseline.json");
  writeFileAtomically(path, GetParam().damage(readFile(path)));
  const std::string stored = readFile(path);
  expectOneSentence(workplace.check({"--json"}), GetParam().sentence);
  expectOneSentence(runProgram({"bless", workplace.path("run"), "--baseline", path, "--reason", "why"}),
                    GetParam().sentence);
  EXPECT_EQ(readFile(path), stored);
}

std::string half(const std::string& text) { return text.substr(0, text.size() / 2); }
std::string empty(const std::string&) { return ""; }
std::string foreign(const std::string&) { return R"({"benchmarks": [], "context": {}})"; }
std::string noJson(const std::string&) { return "scene,camera,frame\n"; }
std::string ofAnotherVersion(const std::string& text) {
  return std::string(text).replace(text.find("_version\": 1"), 12, "_version\": 7");
}
std::string withoutProvenance(const std::string& text) {
  auto document = nlohmann::ordered_json::parse(text);
  document.erase("provenance");
  return document.dump();
}

const DamagedText kDamages[] = {{"half", half, "is truncated"},
                                {"empty", empty, "is truncated"},
                                {"foreign", foreign, "is not a probebench"},
                                {"no_json", noJson, "is not JSON"},
                                {"another_version", ofAnotherVersion, "_version 7, this version of probebench reads 1"},
                                {"without_provenance", withoutProvenance, "breaks its schema"}};

INSTANTIATE_TEST_SUITE_P(All, DamagedRun, testing::ValuesIn(kDamages),
                         [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(All, DamagedBaseline, testing::ValuesIn(kDamages),
                         [](const auto& test) { return test.param.name; });

TEST(DamagedRunDirectory, ThatHoldsAFolderInPlaceOfResults_IsRefused) {
  const Workplace workplace;
  std::filesystem::create_directories(workplace.path("odd/results.json"));
  expectOneSentence(runProgram({"report", workplace.path("odd")}), "results.json");
}

TEST(Check, ConfirmsACostByASecondRun) {
  Results run = samples::makeResults();
  run.cells.resize(2);  // of one sequence
  const Workplace workplace(run);
  for (CellResult& cell : run.cells) cell.cost = samples::makeCost(6);
  workplace.write("run", run);

  const ProgramResult alone = workplace.check();
  EXPECT_EQ(alone.exitCode, 4) << alone.out;
  EXPECT_THAT(alone.out, AllOf(HasSubstr("inconclusive"), HasSubstr("unconfirmed"), HasSubstr("--rerun SUITE")));
  expectOneSentence(workplace.check({"--confirm", workplace.path("run")}), "must be another one");
  for (CellResult& cell : run.cells) cell.cost = samples::makeCost(6.01);
  workplace.write("again", run);
  EXPECT_EQ(workplace.check({"--confirm", workplace.path("again")}).exitCode, 1);
  for (CellResult& cell : run.cells) cell.cost = samples::makeCost(3);
  workplace.write("again", run);
  EXPECT_EQ(workplace.check({"--confirm", workplace.path("again")}).exitCode, 0);
  run.provenance.gitHash = "other";
  workplace.write("again", run);
  expectOneSentence(workplace.check({"--confirm", workplace.path("again")}), "the second measurement must be");
}

TEST(Check, RerunWantsTheSuiteOfTheRun) {
  Results run = samples::makeResults();
  run.cells.resize(2);
  const Workplace workplace(run);
  for (CellResult& cell : run.cells) cell.cost = samples::makeCost(6);
  workplace.write("run", run);
  expectOneSentence(workplace.check({"--rerun", "gate"}), "the run is not one of suite 'gate'");
  workplace.write("run", samples::makeResults());  // in which no cost changed
  expectOneSentence(workplace.check({"--rerun", "gate"}), "the run is not one of suite 'gate'");
}

TEST(Check, PrintsAnnotationsForGitHub) {
  Results run = samples::makeResults();
  const Workplace workplace(run);
  run.cells[0].counters[1].second += 1;
  workplace.write("run", run);
  const ProgramResult result = workplace.check({"--annotations", "github"});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_THAT(result.out, HasSubstr("\n::error title=probebench fail::draws was 40, is 41, may change by 0"));
  EXPECT_EQ(workplace.check({"--annotations", "github", "--json"}).exitCode, 2);
  EXPECT_EQ(workplace.check({"--annotations", "gitlab"}).exitCode, 2);
}

// Other tests load the machine: unchanged runs must not alarm for that.
TEST(SelftestGate, CatchesEveryFaultAndPassesUnchangedRuns) {
  const ProgramResult result = runProgram({"selftest-gate", "--repeats", "2"});
  if (result.exitCode == 4) GTEST_SKIP() << result.err;  // the stored baseline is of another platform
  EXPECT_EQ(result.exitCode, 0) << result.out << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("2 unchanged runs: 0 alarms"), testing::Not(HasSubstr("| NO "))));
}

}  // namespace
}  // namespace pb
