#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "scenes/error.h"
#include "scenes/files.h"
#include "tests/error_message.h"
#include "tests/unit/gate_fixture.h"

namespace pb {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Bless : public testing::Test {
 protected:
  TemporaryFolder folder_;
  const std::string path_ = folder_.file("baseline.json");
};

TEST_F(Bless, WritesWhatCheckPasses) {
  const Results run = samples::makeResults();
  bless(run, path_, "first", false);
  EXPECT_EQ(readBaseline(path_).reason, "first");
  EXPECT_EQ(check(run, readBaseline(path_)).verdict, GateVerdict::pass);
  bless(run, path_, "second", false);
  EXPECT_EQ(readBaseline(path_).reason, "second");
}

TEST_F(Bless, RefusesWithoutAReason) {
  for (const char* reason : {"", " \t\n"})
    EXPECT_THAT(messageOf([&] { bless(samples::makeResults(), path_, reason, true); }), HasSubstr("needs a reason"));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(Bless, RefusesAFailedControlAndAnEmptyRun) {
  Results failed = samples::makeResults(), empty = failed;
  failed.provenance.controlOutcome = "failed";
  empty.cells.clear();
  EXPECT_THAT(messageOf([&] { bless(failed, path_, "why", true); }), HasSubstr("control"));
  EXPECT_THAT(messageOf([&] { bless(empty, path_, "why", true); }), HasSubstr("without cells"));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(Bless, RefusesASuiteWithoutTolerances) {
  Results run = samples::makeResults();
  run.tolerance.clear();
  EXPECT_THAT(messageOf([&] { bless(run, path_, "why", true); }), HasSubstr("no [tolerance]"));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(Bless, RefusesAnotherDriverUnlessForced) {
  Results run = samples::makeResults();
  bless(run, path_, "first", false);
  run.provenance.glRenderer = "other GPU";
  EXPECT_THAT(messageOf([&] { bless(run, path_, "second", false); }),
              AllOf(HasSubstr("other GPU"), HasSubstr("llvmpipe"), HasSubstr("--force")));
  EXPECT_EQ(readBaseline(path_).reason, "first");
  bless(run, path_, "second", true);
  EXPECT_EQ(readBaseline(path_).reason, "second");
}

TEST_F(Bless, RefusesOtherLibrariesUnlessForced) {
  Results run = samples::makeResults();
  bless(run, path_, "first", false);
  run.provenance.libraries["Embree"] = "4.3.0";
  EXPECT_THAT(messageOf([&] { bless(run, path_, "second", false); }),
              AllOf(HasSubstr("Embree is '4.3.0', was '3.13.5'"), HasSubstr("--force")));
  bless(run, path_, "second", true);
  EXPECT_EQ(readBaseline(path_).reason, "second");
}

TEST_F(Bless, RefusesNoisyReferencesUnlessForced) {
  const Results noisy = withNoise(samples::makeResults(), 3.21e-5);
  try {
    bless(noisy, path_, "why", false);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::inconclusive);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("max_noise is 1e-05"), HasSubstr("3 references"),
                                    HasSubstr("'builtin:a' frame 0 with 3.21e-05"), HasSubstr("--force")));
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
  bless(noisy, path_, "why", true);
  EXPECT_EQ(check(noisy, readBaseline(path_)).verdict, GateVerdict::inconclusive);
}

TEST_F(Bless, ReplacesADamagedBaselineOnlyByForce) {
  writeFileAtomically(path_, "{");
  EXPECT_THAT(messageOf([&] { bless(samples::makeResults(), path_, "why", false); }),
              AllOf(HasSubstr("truncated"), HasSubstr("--force replaces it")));
  bless(samples::makeResults(), path_, "why", true);
  EXPECT_EQ(readBaseline(path_).reason, "why");
}

}  // namespace
}  // namespace pb
