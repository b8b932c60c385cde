// A fresh run of the shipped suite `quick` passes the gate of its stored baseline, and a run in which something is
// wrong doesn't.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/files.h"
#include "tests/cli/program.h"

namespace pb {
namespace {

const std::string kBaseline = std::string(PROBEBENCH_SOURCE_DIR) + "/results/baselines/quick.json";

// Costs are left out: they mean nothing while other tests run.
ProgramResult runQuick(const TemporaryFolder& folder, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {
      "run", "quick", "--no-cost", "--out", folder.file("run"), "--store", folder.file("store")};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return runProgram(arguments);
}

ProgramResult check(const TemporaryFolder& folder) {
  return runProgram({"check", folder.file("run"), "--baseline", kBaseline});
}

class Quick : public testing::TestWithParam<const char*> {};

// Exit code 4 is drift: nothing differs by more than it may, but another driver made the baseline, so counters were not
// compared.
TEST_P(Quick, FreshRun_PassesTheStoredBaseline) {
  const TemporaryFolder folder;
  const ProgramResult run = runQuick(folder, {"--gl", GetParam()});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  const ProgramResult verdict = check(folder);
  EXPECT_THAT(verdict.exitCode, testing::AnyOf(0, 4)) << verdict.out << verdict.err;
}

#ifdef PROBEBENCH_OSMESA
INSTANTIATE_TEST_SUITE_P(Backends, Quick, testing::Values("osmesa", "egl"));
#else
INSTANTIATE_TEST_SUITE_P(Backends, Quick, testing::Values("egl"));
#endif

// Of one scene, to be quick: the gate asks for every cell of its baseline.
TEST(QuickGate, MissingCells_Fail) {
  const TemporaryFolder folder;
  const ProgramResult run = runQuick(folder, {"--only", "builtin:mirrors.* resolution=(64|128)"});
  ASSERT_EQ(run.exitCode, 0) << run.err;
  EXPECT_EQ(check(folder).exitCode, 1);
}

}  // namespace
}  // namespace pb
