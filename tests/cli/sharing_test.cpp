// Cells that share captures and scores are, in every bit, what they are when they run alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "bench/results.h"
#include "scenes/image_io.h"
#include "tests/cli/workplace.h"

namespace pb {
namespace {

// The captures of the mirror cube and of the teapot show no maps, those of the mirrors each other's.
constexpr const char* kSuite = R"(
schema = 1
name = "sharing"
image = { size = [32, 18], samples = 4 }
reference = { spp = 2 }
cost = { repetitions = 0 }
technique = { resolution = 16 }
[images]
frames = "all"
[[scene]]
use = "builtin:mirror-cube"
frames = [0, 1]
[scene.vary]
lookup = ["box-proxy", "distance-impostor"]
feedback = ["sky"]
[[scene]]
use = "builtin:teapot"
frames = [2, 4]
[scene.vary]
refresh = ["static"]
[[scene]]
use = "builtin:mirrors?count=2"
frames = 0
[scene.vary]
lookup = ["box-proxy"]
refresh = ["static"]
[grid]
bounces = [1, 2]
)";

// The first technique, whose single iteration repeats no lookups, shares captures with brute force of two.
constexpr const char* kIterationsSuite = R"(
schema = 1
name = "sharing-iterations"
image = { size = [32, 18], samples = 4 }
reference = { spp = 2 }
cost = { repetitions = 0 }
technique = { resolution = 16 }
[[scene]]
use = "builtin:mirror-cube"
[grid]
iterations = ["incremental", "brute-force"]
bounces = [1, 2]
)";

#ifdef PROBEBENCH_OSMESA
const std::vector<const char*> kBackends = {"osmesa", "egl"};
#else
const std::vector<const char*> kBackends = {"egl"};
#endif

// What --only picks: of each scene, one sequence.
const std::vector<const char*> kAlone = {
    "mirror-cube.* bounces=1 feedback=previous-frame .*lookup=infinite |"
    "teapot.* refresh=every-frame bounces=1 |"
    "mirrors.* refresh=static bounces=2 .*lookup=infinite ",
    "mirror-cube.* bounces=2 feedback=previous-frame .*lookup=distance-impostor |"
    "teapot.* refresh=static bounces=2 |"
    "mirrors.* bounces=1 .*lookup=box-proxy "};

class Sharing : public testing::TestWithParam<const char*> {
 protected:
  // By key: the cells as they stand in results.json, equal texts mean equal bits, and their pictures.
  using Cells = std::map<std::string, std::pair<std::string, ImageRgba>>;
  static Cells run(const Workplace& workplace, const std::string& out, const std::vector<std::string>& more = {}) {
    const ProgramResult result = runProgram(onBackend(workplace.command(out, more)));
    EXPECT_EQ(result.exitCode, 0) << result.err;
    Cells cells;
    for (const CellResult& cell : readResults(workplace.path(out)).cells)
      cells[cell.key()] = {toJson(cell), readImage(workplace.path(out + "/" + cell.pictures.rendered)).pixels};
    return cells;
  }

  static std::vector<std::string> onBackend(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"--gl", GetParam()});
    return arguments;
  }

  static void expectAmong(const Cells& together, const Cells& alone) {
    for (const auto& [key, cell] : alone) {
      ASSERT_TRUE(together.contains(key)) << key;
      EXPECT_EQ(cell.first, together.at(key).first);
      EXPECT_TRUE(cell.second == together.at(key).second) << key;
    }
  }
};

TEST_P(Sharing, OfCaptures_ChangesNoBitOfAnyCell) {
  const Workplace workplace(kSuite);
  const auto together = run(workplace, "together");
  EXPECT_EQ(together.size(), 2u * 8 + 2u * 4 + 6);
  for (std::size_t i = 0; i < kAlone.size(); ++i) {
    const auto alone = run(workplace, "alone" + std::to_string(i), {"--only", kAlone[i]});
    EXPECT_EQ(alone.size(), 2u + 2u + 1u) << kAlone[i] << ": frames of one sequence a scene";
    expectAmong(together, alone);
  }
}

TEST_P(Sharing, OfIterationsThatRepeatNothing_ChangesNoBitOfAnyCell) {
  const Workplace workplace(kIterationsSuite);
  const auto together = run(workplace, "together");
  EXPECT_EQ(together.size(), 4u);
  const auto alone = run(workplace, "alone", {"--only", "bounces=2 "});  // of which none shares with the other
  EXPECT_EQ(alone.size(), 2u);
  expectAmong(together, alone);
}

TEST_P(Sharing, IsStatedByADryRun) {
  const ProgramResult result = runProgram(onBackend(Workplace(kSuite).command("out", {"--dry-run"})));
  // Cube: all but one of 8 sequences of 2 frames. Teapot: 2 bounces as 1 of either policy, 2 frames. Mirrors: frame 0
  // is the same whatever the policy, but not the lookup nor the bounces.
  EXPECT_THAT(result.out, testing::HasSubstr("30 raster frames, of which 20 share another's captures")) << result.err;
}

INSTANTIATE_TEST_SUITE_P(Backends, Sharing, testing::ValuesIn(kBackends),
                         [](const testing::TestParamInfo<const char*>& test) { return std::string(test.param); });

}  // namespace
}  // namespace pb
