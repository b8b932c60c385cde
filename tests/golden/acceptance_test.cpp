// What the lookups and placements are for, in numbers: each refinement on the scene that was made to show it.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "bench/results.h"
#include "scenes/files.h"
#include "tests/cli/program.h"

namespace pb {
namespace {

// Small enough for a few seconds; 320x180 with four samples orders these techniques alike (docs/source-documents.md).
constexpr const char* kSuite = R"(
schema = 1
name = "acceptance"
image = { size = [128, 72], samples = 1 }
reference = { spp = 8, matched = false }
cost = { repetitions = 0 }
technique = { resolution = 128 }
[[scene]]
use = "builtin:mirror-cube"
[scene.vary]
lookup = ["distance-impostor"]
[[scene]]
use = "builtin:planar-floor"
[scene.vary]
lookup = ["sphere-proxy", "box-proxy", "distance-impostor", "single-view", "planar"]
[[scene]]
use = "builtin:teapot"
[scene.vary]
placement = ["origin", "centroid"]
)";

// HDR-FLIP on the reflectors by scene, lookup and placement, of one run for all: it starts with the control.
std::map<std::string, double> errorsOfSuite() {
  const TemporaryFolder folder;
  const std::string suite = folder.file("suite.toml");
  writeFileAtomically(suite, kSuite);
  const ProgramResult run = runProgram({"run", suite, "--out", folder.file("run"), "--store", folder.file("store")});
  EXPECT_EQ(run.exitCode, 0) << run.err;
  std::map<std::string, double> errors;
  for (const CellResult& cell : readResults(folder.file("run")).cells) {
    const auto valueOf = [&](const std::string& axis) {
      return std::ranges::find(cell.technique, axis, &AxisValues::value_type::first)->second;
    };
    errors[cell.scene + " " + valueOf("lookup") + " " + valueOf("placement")] =
        cell.maskMetrics.value().flipHdr.value().mean;
  }
  return errors;
}

TEST(Refinements, AreAsMuchBetterAsTheScenesWereMadeToShow) {
  const std::map<std::string, double> errors = errorsOfSuite();
  const auto errorOf = [&](const std::string& scene, const std::string& lookup, const std::string& placement) {
    return errors.at("builtin:" + scene + " " + lookup + " " + placement);
  };
  // 0.18 against 0.54.
  EXPECT_LT(errorOf("mirror-cube", "distance-impostor", "explicit"),
            0.5 * errorOf("mirror-cube", "infinite", "explicit"));
  // 0.003 against 0.38 of the best of the others: not a matter of a few pixels.
  for (const char* lookup : {"infinite", "sphere-proxy", "box-proxy", "distance-impostor", "single-view"})
    EXPECT_LT(10.0 * errorOf("planar-floor", "planar", "explicit"), errorOf("planar-floor", lookup, "explicit"))
        << lookup;
  // 0.19 against 0.29: of the surface, or of the node that stands below it.
  EXPECT_LT(errorOf("teapot", "infinite", "centroid"), 0.9 * errorOf("teapot", "infinite", "origin"));
}

}  // namespace
}  // namespace pb
