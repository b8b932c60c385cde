// Unchanged runs raise no alarm. None in 100 proves with 95 % confidence that at most 3 % do: 1 - 0.05^(1/100).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace pb {
namespace {

TEST(SelftestGateSlow, HundredUnchangedRuns_RaiseNoAlarm) {
  const ProgramResult result = runProgram({"selftest-gate", "--no-faults", "--repeats", "100"});
  if (result.exitCode == 4) GTEST_SKIP() << result.err;  // the stored baseline is of another platform
  EXPECT_EQ(result.exitCode, 0) << result.out << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("100 unchanged runs: 0 alarms"));
}

}  // namespace
}  // namespace pb
