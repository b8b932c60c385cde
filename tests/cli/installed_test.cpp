// The program as `cmake --install` lays it out: away from its build folder, with its module in a folder of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "scenes/files.h"
#include "tests/cli/program.h"

namespace pb {
namespace {

using testing::HasSubstr;

class Installed : public testing::Test {
 protected:
  void SetUp() override {
    ProgramOptions cmake;
    cmake.program = PROBEBENCH_CMAKE;
    const ProgramResult installed = runProgram({"--install", PROBEBENCH_BUILD_DIR, "--prefix", folder_.path()}, cmake);
    ASSERT_EQ(installed.exitCode, 0) << installed.err;
    options_.program = folder_.file(PROBEBENCH_INSTALL_BINDIR "/probebench");
  }

  ProgramResult run(const std::vector<std::string>& arguments) const { return runProgram(arguments, options_); }
  ProgramResult compareImages() const {
    const std::string images = PROBEBENCH_SOURCE_DIR "/tests/data/metrics/images/";
    return run({"compare", images + "ldr_lines.ref.png", images + "ldr_lines.test.png"});
  }

  TemporaryFolder folder_;
  ProgramOptions options_;
};

TEST_F(Installed, SaysItsVersion) {
  const ProgramResult result = run({"--version"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_THAT(result.out, testing::StartsWith("probebench "));
}

TEST_F(Installed, ReadsImages_WithTheModuleThatWasInstalled) {
  EXPECT_EQ(compareImages().exitCode, 0) << compareImages().err;
  std::filesystem::remove(folder_.file(PROBEBENCH_INSTALL_MODULES_DIR "/probebench_images.so"));
  EXPECT_THAT(compareImages().err, HasSubstr("probebench_images.so"));
}

}  // namespace
}  // namespace pb
