// The work of the frames that scripts/perf times is that of the stored baseline of the suite `frames`, to the last
// draw.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace pb {
namespace {

TEST(Frames, DoTheWorkOfTheirBaseline_AndMoreDrawsAreCaught) {
  const TemporaryFolder folder;
  const ProgramResult result =
      runProgram({"selftest-gate", "--suite", "frames", "--fault", "5 % more draws", "--store", folder.file("store")});
  if (result.exitCode == 4) GTEST_SKIP() << result.err;  // the stored baseline is of another platform
  EXPECT_EQ(result.exitCode, 0) << result.out << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr("| 5 % more draws | yes "));
}

}  // namespace
}  // namespace pb
