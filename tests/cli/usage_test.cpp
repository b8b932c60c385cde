// What the program answers without rendering anything: usage, bad input, compare.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "scenes/files.h"
#include "scenes/image_io.h"
#include "tests/cli/program.h"

namespace pb {
namespace {

using testing::HasSubstr;

const std::string kPairs = PROBEBENCH_SOURCE_DIR "/tests/data/metrics/images/";

// One sentence on standard error, nothing on standard output.
void expectRefused(const ProgramResult& result, int exitCode, const std::string& part) {
  EXPECT_EQ(result.exitCode, exitCode) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, testing::StartsWith("probebench: "));
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr(part));
}

struct BadUsage {
  std::vector<std::string> arguments;
  const char* part;
};

class BadUsages : public testing::TestWithParam<BadUsage> {};

TEST_P(BadUsages, AreOneSentenceAndExitCode2) { expectRefused(runProgram(GetParam().arguments), 2, GetParam().part); }

INSTANTIATE_TEST_SUITE_P(
    Table, BadUsages,
    testing::Values(
        BadUsage{{}, "a command is wanted"}, BadUsage{{"rnu"}, "command 'rnu' is not known; nearest is 'run'"},
        BadUsage{{"imit", "ok.gltf", "-o", "x.toml"}, "command 'imit' is not known; "},
        BadUsage{{"report", "absent", "more", "-x", "y"}, "not expected on the command line: -x y;"},
        BadUsage{{"run"}, "SUITE is required"}, BadUsage{{"run", "quick", "--treads", "1"}, "--treads"},
        BadUsage{{"run", "quick", "--threads", "-1"}, "--threads"}, BadUsage{{"run", "quick", "--gl", "glx"}, "glx"},
        BadUsage{{"run", "quikc"}, "'quikc' is not known; nearest is 'quick'"},
        BadUsage{{"run", "absent.toml"}, "absent.toml"},
        BadUsage{{"run", "quick", "--set", "resolution=100"},
                 "axis 'resolution' wants powers of two from 8 to 4096, got 100"},
        BadUsage{{"run", "quick", "--set", "resolution"}, "AXIS=VALUE"},
        BadUsage{{"run", "quick", "--set", "bounces=1", "--set", "bounces=2"}, "--set names axis 'bounces' twice"},
        BadUsage{{"run", "quick", "--set", "bounces=1,01"}, "--set names value '1' of axis 'bounces' twice"},
        BadUsage{{"run", "quick", "--out", ""}, "--out: wants a folder"},
        BadUsage{{"run", "quick", "--scene", "builtin:teapto"}, "teapot"},
        BadUsage{{"run", "quick", "--scene", "absent.glb"}, "absent.glb"},
        BadUsage{{"scenes", "info", "absent.obj"}, "absent.obj"},
        BadUsage{{"scenes", "info", PROBEBENCH_SOURCE_DIR "/tests/data/obj/broken.obj"},
                 "broken.obj: face 1 wants vertex 4 of 3 before it"},
        BadUsage{{"run", "quick", "--only", "(", "--dry-run"}, "regular expression"},
        BadUsage{{"run", "quick", "--only", "xyz", "--dry-run"}, "matches no cell"},
        BadUsage{{"run", "quick", "--shard", "3/2", "--dry-run"}, "--shard wants I/N"},
        BadUsage{{"render", "builtin:mirrors", "--with", "pencil", "-o", "a.exr"}, "pencil"},
        BadUsage{{"run", "quick", "--dry-run", "--scene", "builtin:metals", "--set", "lookup=planar"}, "is not flat"},
        BadUsage{{"run", "quick", "--dry-run", "--scene", "builtin:mirrors?count=64", "--set", "resolution=4096"},
                 "the device allows"},
        BadUsage{{"render", "builtin:mirrors", "--with", "oracle", "-o", "a.exr", "--depth", "1"},
                 "--depth of at least 2"},
        BadUsage{{"render", "builtin:mirrors", "--with", "oracle", "-o", "a.exr", "--set", "lookup=single-view"},
                 "single-view"},
        BadUsage{{"render", "builtin:mirrors", "--with", "raster", "-o", "a.gif"}, ".exr or .png, got 'a.gif'"},
        BadUsage{{"render", "builtin:mirrors", "--with", "raster", "-o", "a.exr", "--size", "0x4"}, "WIDTHxHEIGHT"},
        BadUsage{{"render", "builtin:mirrors", "--with", "raster", "-o", "a.exr", "--size", "640"}, "WIDTHxHEIGHT"},
        BadUsage{{"render", "builtin:mirrors", "--with", "raster", "-o", "a.exr", "--samples", "3"}, "square number"},
        BadUsage{{"render", "builtin:mirrors", "--with", "reference", "-o", "a.exr", "--spp", "3"}, "even number"},
        BadUsage{{"render", "builtin:mirrors", "--with", "reference", "-o", "a.exr", "--depth", "0"}, "depth wants"},
        BadUsage{{"render", "builtin:mirrors", "--with", "raster", "-o", "a.exr", "--aov", "normals=n.exr"},
                 "ids=FILE.exr"},
        BadUsage{{"render", "builtin:mirrors", "--with", "raster", "-o", "a.exr", "--set", "bounces=1,2"},
                 "takes one value"},
        BadUsage{{"render", "builtin:mirrors", "--with", "raster", "-o", "a.exr", "--set", "bounces=1", "--set",
                  "bounces=2"},
                 "--set names axis 'bounces' twice"},
        BadUsage{{"render", "builtin:mirrors", "--with", "raster", "-o", "a.exr", "--exposure", "nan"},
                 "wants a number from -32 to 32, got 'nan'"},
        BadUsage{{"render", "builtin:mirrors", "--with", "reference", "-o", "a.exr", "--seed", "-1"}, "got '-1'"},
        BadUsage{{"render", "builtin:mirrors", "--with", "raster", "-o", "a.exr", "--aov", "ids=./a.exr"},
                 "-o and --aov want different files"},
        BadUsage{{"render", "builtin:mirrors", "--with", "reference", "-o", "a.exr", "--camera", "nobody"}, "nobody"},
        BadUsage{{"compare", "absent.exr", "absent.exr"}, "absent.exr"},
        BadUsage{{"compare", kPairs + "ldr_lines.ref.png", kPairs + "hdr_const.ref.pfm"},
                 "both images must be 8-bit (sRGB) or both float (linear)"},
        BadUsage{{"compare", kPairs + "ldr_lines.ref.png", kPairs + "ldr_tiny.ref.png"}, "size"},
        BadUsage{{"compare", kPairs + "ldr_lines.ref.png", kPairs + "ldr_lines.ref.png", "--ppd", "0"},
                 "pixels per degree"},
        BadUsage{{"compare", kPairs + "ldr_lines.ref.png", kPairs + "ldr_lines.ref.png", "--tone-mapper", "x"},
                 "--tone-mapper: x not in {aces,hable,reinhard}"},
        BadUsage{{"compare", kPairs + "ldr_lines.ref.png", kPairs + "ldr_lines.ref.png", "--tone-mapper", "1"},
                 "--tone-mapper: 1 not in {aces,hable,reinhard}"},
        BadUsage{{"compare", kPairs + "ldr_lines.ref.png", kPairs + "ldr_lines.ref.png", "--heatmap", "map.jpg"},
                 "--heatmap wants a file named .png, got 'map.jpg'"},
        BadUsage{{"scenes", "export", "builtin:mirrors", "-o", "a.gltf"}, "-o wants a file named .glb, got 'a.gltf'"},
        BadUsage{{"report", "absent", "--page-mb", "nan"}, "wants a number from 0 to 1e+06, got 'nan'"},
        BadUsage{{"report", "absent"}, "absent"}, BadUsage{{"check", "absent", "--baseline", "b.json"}, "absent"},
        BadUsage{{"bless", "absent", "--baseline", "b.json", "--reason", "r"}, "absent"},
        BadUsage{{"merge", "absent", "-o", "m"}, "absent"}, BadUsage{{"axes"}, "subcommand is required"},
        BadUsage{{"axes"}, "see probebench axes --help"},
        BadUsage{{"scenes", "info"}, "see probebench scenes info --help"},
        BadUsage{{"axes", "info", "resolutoin"}, "nearest is 'resolution'"},
        BadUsage{{"scenes", "info", "builtin:absent"}, "absent"}));

// The scene, which isn't there either, is not even looked for: a picture may take hours.
TEST(Render, WithoutAPlaceForThePicture_IsRefusedBeforeItIsRendered) {
  const TemporaryFolder folder;
  expectRefused(runProgram({"render", "builtin:absent", "--with", "reference", "-o", folder.file("absent/a.exr")}), 3,
                "there is no folder '" + folder.file("absent") + "'");
}

TEST(Suites, WithAnUnknownKey_AreRefusedByFileAndLine) {
  const TemporaryFolder folder;
  const std::string suite = folder.file("s.toml");
  writeFileAtomically(suite, "schema = 1\nname = \"s\"\ngird = 1\n[[scene]]\nuse = \"builtin:mirrors\"\n");
  expectRefused(runProgram({"run", suite}), 2, suite + ":3: key 'gird' is not known; nearest is 'grid'");
}

TEST(DryRun, PrintsThePlanAndWritesNothing) {
  const TemporaryFolder folder;
  const ProgramResult result = runProgram({"run", "quick", "--dry-run", "--out", folder.file("run")});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("216 cells in 81 raster sequences, 8 references, 81 cost measurements"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Version, NamesTheProgramItsLibrariesAndTheDriver) {
  const ProgramResult result = runProgram({"--version"});
  EXPECT_EQ(result.exitCode, 0);
  for (const char* part : {"probebench ", "OpenGL ", "Embree ", "OpenImageIO ", "Google Benchmark "})
    EXPECT_THAT(result.out, HasSubstr(part));
}

TEST(Help, GoesToStandardOutputAndNamesEveryCommand) {
  const ProgramResult result = runProgram({"--help"});
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_EQ(result.err, "");
  for (const char* command :
       {"run", "render", "compare", "report", "check", "bless", "merge", "axes", "scenes", "certify", "selftest-gate"})
    EXPECT_THAT(result.out, HasSubstr(std::string("\n  ") + command + " "));
}

// What brings hundreds of libraries is loaded when it is needed: linked, it made every command start 0.3 s later.
TEST(Start, LoadsNeitherImageLibrariesNorDrivers) {
  const TemporaryFolder folder;
  const std::string list = folder.file("libraries");  // as ldd has them
  ASSERT_EQ(std::system(("LD_TRACE_LOADED_OBJECTS=1 '" PROBEBENCH_PROGRAM "' > '" + list + "'").c_str()), 0);
  const std::string libraries = readFile(list);
  EXPECT_THAT(libraries, HasSubstr("libtbb"));
  for (const char* library : {"libOpenImageIO", "libOSMesa", "libLLVM"})
    EXPECT_THAT(libraries, testing::Not(HasSubstr(library)));
}

TEST(Start, WithoutTheModuleOfImages_OnlyWhatNeedsImagesFails) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(PROBEBENCH_PROGRAM, folder.file("probebench"));
  ProgramOptions options;
  options.program = folder.file("probebench");
  EXPECT_EQ(runProgram({"scenes", "list"}, options).exitCode, 0);
  expectRefused(runProgram({"compare", kPairs + "ldr_lines.ref.png", kPairs + "ldr_lines.test.png"}, options), 3,
                "probebench_images.so");
}

TEST(Start, WithTheModuleOfAnotherVersion_IsRefusedByItsPath) {
  ProgramOptions options;
  options.program = "/usr/bin/env";
  expectRefused(runProgram({"LD_LIBRARY_PATH=" PROBEBENCH_FOREIGN_MODULE_DIR, PROBEBENCH_PROGRAM, "compare",
                            kPairs + "ldr_lines.ref.png", kPairs + "ldr_lines.test.png"},
                           options),
                3, PROBEBENCH_FOREIGN_MODULE_DIR "/probebench_images.so' belongs to another version");
}

TEST(Axes, ListAndInfo_AgreeOnNames) {
  const ProgramResult list = runProgram({"axes", "list"});
  EXPECT_EQ(list.exitCode, 0);
  for (const char* axis : {"resolution", "refresh", "bounces", "feedback", "bounce_order", "texture_filter"}) {
    EXPECT_THAT(list.out, HasSubstr(axis));
    EXPECT_THAT(runProgram({"axes", "info", axis}).out, HasSubstr(std::string("axis     ") + axis)) << axis;
  }
}

TEST(StandardOutput, ThatCantBeWritten_IsAnEnvironmentError) {
  ProgramOptions full;
  full.standardOutput = "/dev/full";
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"axes", "list"}, {"--help"}, {"--version"}}) {
    const ProgramResult result = runProgram(command, full);
    EXPECT_EQ(result.exitCode, 3) << command.front();
    EXPECT_THAT(result.err, HasSubstr("standard output can't be written"));
  }
}

std::vector<std::string> keysOf(const nlohmann::ordered_json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

TEST(Compare, OfFloatImages_PrintsEveryKeyOfTheFormat) {
  const ProgramResult result =
      runProgram({"compare", kPairs + "hdr_const.ref.pfm", kPairs + "hdr_const.test.pfm", "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto metrics = nlohmann::ordered_json::parse(result.out);
  EXPECT_THAT(keysOf(metrics),
              testing::IsSupersetOf({"bias", "mse", "rmse", "mae", "max_abs", "psnr", "relmse", "smape", "ssim",
                                     "ssim_luma", "ms_ssim", "flip_ldr", "flip_hdr"}));
  EXPECT_THAT(keysOf(metrics["flip_hdr"]),
              testing::IsSupersetOf({"mean", "weighted_q1", "weighted_median", "weighted_q3", "min", "max", "ppd",
                                     "start_exposure", "stop_exposure", "num_exposures"}));
}

TEST(Compare, OfEqualEightBitImages_HasInfinitePsnrAndNoHdrFlip) {
  const std::string image = kPairs + "ldr_lines.ref.png";
  const ProgramResult result = runProgram({"compare", image, image, "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto metrics = nlohmann::ordered_json::parse(result.out);
  EXPECT_EQ(metrics["psnr"], "inf");
  EXPECT_EQ(metrics["mse"], 0.0);
  EXPECT_EQ(metrics["flip_ldr"]["mean"], 0.0);
  EXPECT_TRUE(!metrics.contains("flip_hdr") || metrics["flip_hdr"].is_null());
}

TEST(Compare, FlipSettings_ReachTheMetric) {
  const ProgramResult result = runProgram({"compare", kPairs + "hdr_sky_sun.ref.exr", kPairs + "hdr_sky_sun.test.exr",
                                           "--json", "--ppd", "30", "--start-exposure", "-2", "--stop-exposure", "1.5",
                                           "--num-exposures", "3", "--tone-mapper", "hable"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto flip = nlohmann::ordered_json::parse(result.out)["flip_hdr"];
  EXPECT_EQ(flip["ppd"], 30.0);
  EXPECT_EQ(flip["start_exposure"], -2.0);
  EXPECT_EQ(flip["stop_exposure"], 1.5);
  EXPECT_EQ(flip["num_exposures"], 3);
}

TEST(Compare, Mask_LimitsTheAverageToItsWhitePixels) {
  const TemporaryFolder folder;
  // The left half differs by 0.5, the right half is equal; the mask is the right half.
  Image reference(32, 16, glm::vec3(1.0f)), test = reference, mask(32, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      test(x, y) = glm::vec3(1.5f);
      mask(x + 16, y) = glm::vec3(1.0f);
    }
  writeExr(folder.file("r.exr"), reference);
  writeExr(folder.file("t.exr"), test);
  writePng(folder.file("m.png"), mask);
  const auto mse = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"compare", folder.file("r.exr"), folder.file("t.exr"), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return nlohmann::ordered_json::parse(runProgram(arguments).out)["mse"].get<double>();
  };
  EXPECT_EQ(mse({}), 0.125);
  EXPECT_EQ(mse({"--mask", folder.file("m.png")}), 0.0);

  writePng(folder.file("empty.png"), Image(32, 16));
  expectRefused(runProgram({"compare", folder.file("r.exr"), folder.file("t.exr"), "--mask", folder.file("empty.png")}),
                2, "empty.png' has no pixel inside");
}

TEST(Compare, Heatmap_IsAPictureOfTheImagesSize) {
  const TemporaryFolder folder;
  const ProgramResult result = runProgram(
      {"compare", kPairs + "ldr_lines.ref.png", kPairs + "ldr_lines.test.png", "--heatmap", folder.file("map.png")});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(readImage(folder.file("map.png")).pixels.width(), readImage(kPairs + "ldr_lines.ref.png").pixels.width());
}

TEST(Compare, HeatmapThatCantBeWritten_IsSaidInsteadOfTheResult) {
  const std::string image = kPairs + "ldr_lines.ref.png";
  expectRefused(runProgram({"compare", image, image, "--heatmap", "/dev/null/m.png"}), 3, "/dev/null/m.png");
}

TEST(Scenes, ListAndExport_GiveAFileThatLoads) {
  const TemporaryFolder folder;
  EXPECT_THAT(runProgram({"scenes", "list"}).out, HasSubstr("builtin:teapot"));
  const std::string file = folder.file("t.glb");
  const ProgramResult exported = runProgram({"scenes", "export", "builtin:teapot", "-o", file});
  EXPECT_EQ(exported.exitCode, 0) << exported.err;
  const ProgramResult info = runProgram({"scenes", "info", file});
  EXPECT_EQ(info.exitCode, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("probe"));
}

}  // namespace
}  // namespace pb
