#include "bench/suite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/axes.h"
#include "tests/error_message.h"

namespace pb {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kHead = "schema = 1\nname = \"s\"\n";
constexpr const char* kScene = "[[scene]]\nuse = \"builtin:mirrors\"\n";

Suite parse(const std::string& text) { return parseSuite(text, "suites/s.toml", "suites"); }

std::string refusalOf(const std::string& text) {
  return messageOf([&] { parse(text); });
}

TEST(Suite, WithEveryKey_IsReadWhole) {
  const Suite suite = parse(R"(
schema = 1
name = "all"
image = { size = [320, 200], samples = 9 }
reference = { depth = 3, diffuse = "traced", diffuse_depth = 2, spp = 8, max_noise = 1e-5, matched = false }
cost = { repetitions = 5 }
technique = { feedback = "sky", bounces = 2 }

[[scene]]
use = "builtin:mirrors?count=5"
frames = "2..4"
warmup = 1
camera = "front"
environment = "sky"
exposure = -1.5

[[scene]]
use = "glass.glb?mirror=all"
frames = [0, 3, 9]

[grid]
refresh = ["every-frame", "faces?k=1"]
resolution = [64, 128]

[tolerance]
flip_hdr = { relative = 0.02, absolute = 1e-4 }
mse = { any = [ { absolute = 1.0 }, { all = [ { relative = 0.5 }, { absolute = 2.0 } ] } ] }
)");
  EXPECT_EQ(suite.name, "all");
  EXPECT_EQ(suite.image, (ImageSettings{320, 200, 3}));
  EXPECT_EQ(suite.reference.depth, 3);
  EXPECT_EQ(suite.reference.spp, 8);
  EXPECT_EQ(suite.reference.maxNoise, 1e-5);
  EXPECT_FALSE(suite.reference.matched);
  EXPECT_EQ(suite.cost.repetitions, 5);
  EXPECT_EQ(suite.technique.feedback, Feedback::sky);
  EXPECT_EQ(suite.technique.bounces, 2);

  ASSERT_EQ(suite.scenes.size(), 2u);
  EXPECT_EQ(suite.scenes[0].name, "builtin:mirrors?count=5&environment=sky");
  EXPECT_EQ(suite.scenes[0].reference, "builtin:mirrors?count=5&environment=sky");
  EXPECT_THAT(suite.scenes[0].frames, ElementsAre(2, 3, 4));
  EXPECT_EQ(suite.scenes[0].startFrame(), 1);
  EXPECT_EQ(suite.scenes[0].camera, "front");
  EXPECT_EQ(suite.scenes[0].exposure, -1.5);
  EXPECT_EQ(suite.scenes[1].name, "glass.glb?mirror=all");
  EXPECT_EQ(suite.scenes[1].reference, "suites/glass.glb?mirror=all");
  EXPECT_THAT(suite.scenes[1].frames, ElementsAre(0, 3, 9));
  EXPECT_EQ(suite.scenes[1].startFrame(), 0);

  // In the axis table's order, whatever the file's is.
  EXPECT_THAT(suite.grid,
              ElementsAre(GridAxis{"resolution", {"64", "128"}}, GridAxis{"refresh", {"every-frame", "faces?k=1"}}));

  ASSERT_EQ(suite.tolerance.size(), 2u);
  EXPECT_EQ(suite.tolerance[0].first, "mse");  // in the metric table's order
  EXPECT_EQ(suite.tolerance[0].second.kind, Tolerance::Kind::any);
  EXPECT_EQ(suite.tolerance[0].second.children[1].kind, Tolerance::Kind::all);
  EXPECT_EQ(suite.tolerance[0].second.children[1].children[1].absolute, 2.0);
  EXPECT_EQ(suite.tolerance[1].second.relative, 0.02);
  EXPECT_EQ(suite.tolerance[1].second.absolute, 1e-4);
}

TEST(Suite, WithTheLeast_HasTheDocumentedDefaults) {
  const Suite suite = parse(std::string(kHead) + kScene);
  EXPECT_EQ(suite.image, (ImageSettings{640, 360, 2}));
  EXPECT_FALSE(suite.reference.depth.has_value());
  EXPECT_FALSE(suite.reference.maxNoise.has_value());
  EXPECT_EQ(suite.technique, Technique());
  EXPECT_THAT(suite.scenes[0].frames, ElementsAre(0));
  EXPECT_TRUE(suite.grid.empty());
}

TEST(Suite, RangesWithSteps_AndTimeSteps_AreRead) {
  const std::string scene = std::string(kHead) + "[[scene]]\nuse = \"builtin:teapot\"\n";
  EXPECT_THAT(parse(scene + "frames = \"0..60/20\"").scenes[0].frames, ElementsAre(0, 20, 40, 60));
  EXPECT_THAT(parse(scene + "frames = \"3..9/4\"").scenes[0].frames, ElementsAre(3, 7));
  EXPECT_EQ(parse(scene + "fps = 12").scenes[0].reference, "builtin:teapot?fps=12");
  EXPECT_EQ(parse(scene + "time_step = 0.25\nenvironment = \"sky\"").scenes[0].name,
            "builtin:teapot?environment=sky&time_step=0.25");
}

TEST(Suite, EnvironmentsThatFollowEachOther_AreRelativeToTheSuiteWhereTheyAreFiles) {
  const Suite suite = parse(std::string(kHead) + "[[scene]]\nuse = \"a.glb\"\nenvironment = \"x.exr;sky@1;y.exr@2.5\"");
  EXPECT_EQ(suite.scenes[0].reference, "suites/a.glb?environment=suites/x.exr;sky@1;suites/y.exr@2.5");
  const Suite grey = parse(std::string(kHead) + "[[scene]]\nuse = \"a.glb\"\nenvironment = \"sky;constant?r=1&g=2@2\"");
  EXPECT_EQ(grey.scenes[0].name, "a.glb?environment=(sky;constant?r=1&g=2@2)");
}

TEST(Suite, EnvironmentFile_IsRelativeToTheSuiteLikeTheScene) {
  const Suite suite = parse(std::string(kHead) + "[[scene]]\nuse = \"a.glb?environment=x.exr\"\n");
  EXPECT_EQ(suite.scenes[0].reference, "suites/a.glb?environment=suites/x.exr");
  EXPECT_EQ(suite.scenes[0].name, "a.glb?environment=x.exr");
}

// Runs go to out/NAME, which must not lie elsewhere.
TEST(Suite, WithANameThatIsNoFolder_IsRefused) {
  for (const char* name : {"", "../s", "a/b", "..", ".s"})
    EXPECT_THAT(messageOf([&] { parse(std::string("schema = 1\nname = \"") + name + "\"\n" + kScene); }),
                testing::StartsWith("suites/s.toml:2: 'name' is a folder's"))
        << name;
}

TEST(Suite, Variations_AreOneTableOrSeveralWithSettingsOfTheirOwn) {
  const std::string scene = std::string(kHead) + kScene;
  const Suite one = parse(scene + "[scene.vary]\nbounces = [2, 3]\nresolution = [64]\n");
  EXPECT_THAT(one.scenes[0].vary, ElementsAre(Variation{{}, {{"resolution", {"64"}}, {"bounces", {"2", "3"}}}}));
  const Suite two = parse(scene +
                          "[[scene.vary]]\nbounces = [2]\n[[scene.vary]]\n"
                          "on = { lookup = \"box-proxy\" }\nrefresh = [\"static\"]\n");
  EXPECT_THAT(two.scenes[0].vary, ElementsAre(Variation{{}, {{"bounces", {"2"}}}},
                                              Variation{{{"lookup", "box-proxy"}}, {{"refresh", {"static"}}}}));
  EXPECT_NE(canonicalText(one), canonicalText(two));
}

TEST(Suite, Asterisk_StandsForEveryNameThatTheListDoesNotHaveBeforeIt) {
  const Suite suite = parse(std::string(kHead) + kScene +
                            "vary = { lookup = \"*\", faces = [\"*\"] }\n"
                            "[grid]\nrefresh = [\"static\", \"every-n?n=3\", \"*\"]\nmips = [\"on\", \"*\"]\n");
  const Variation& vary = suite.scenes[0].vary[0];
  EXPECT_THAT(vary.values, ElementsAre(GridAxis{"lookup", axisNamed("lookup").names},
                                       GridAxis{"faces", {"all", "no-top-bottom", "top-half"}}));
  ASSERT_EQ(suite.grid.size(), 2U);
  EXPECT_THAT(suite.grid[0].second, testing::IsSupersetOf({"static", "every-n?n=3", "every-frame", "on-change"}));
  EXPECT_THAT(suite.grid[0].second, testing::Not(testing::Contains("every-n")));
  EXPECT_EQ(suite.grid[0].second.size(), axisNamed("refresh").names.size());
  EXPECT_THAT(suite.grid[1].second, ElementsAre("on", "off"));
}

struct BadSuite {
  const char* text;  // after the two lines of kHead
  const char* message;
};

class BadSuites : public testing::TestWithParam<BadSuite> {};

TEST_P(BadSuites, AreRefusedByRuleValueAndLine) {
  EXPECT_EQ(refusalOf(kHead + std::string(GetParam().text)), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadSuites,
    testing::Values(
        BadSuite{"gird = 1\n[[scene]]\nuse = \"x\"", "suites/s.toml:3: key 'gird' is not known; nearest is 'grid'"},
        BadSuite{"image = 3\n[[scene]]\nuse = \"x\"", "suites/s.toml:3: 'image' wants a table { ... }"},
        BadSuite{"image = { sise = [1, 2] }\n", "suites/s.toml:3: key 'sise' is not known; nearest is 'size'"},
        BadSuite{"image = { size = [1, 2, 3] }\n", "suites/s.toml:3: 'size' wants [width, height], got 3 values"},
        BadSuite{"image = { size = [0, 360] }\n",
                 "suites/s.toml:3: an image size is WIDTHxHEIGHT with sides from 16 to 16384, got '0x360'"},
        BadSuite{"image = { size = [1e300, 360] }\n",
                 "suites/s.toml:3: an image size is WIDTHxHEIGHT with sides from 16 to 16384, got '1e+300x360'"},
        BadSuite{"image = { samples = 5 }\n", "suites/s.toml:3: samples wants a square number from 1 to 64, got 5"},
        BadSuite{"image = { samples = -1 }\n", "suites/s.toml:3: 'samples' wants an integer from 1 to 64, got -1"},
        BadSuite{"image = { size = [8000, 16], samples = 9 }\n",
                 "suites/s.toml:3: 'image' may have at most 16384 samples along a side, got 24000"},
        BadSuite{"reference = { depth = 0 }\n",
                 "suites/s.toml:3: depth wants 'converged' or an integer from 1 to 64, got '0'"},
        BadSuite{"reference = { diffuse = \"traecd\" }\n",
                 "suites/s.toml:3: diffuse wants 'local' or 'traced', got 'traecd'"},
        BadSuite{"reference = { diffuse_depth = 2 }\n",
                 "suites/s.toml:3: 'diffuse_depth' belongs to diffuse = \"traced\""},
        BadSuite{"reference = { spp = 3 }\n",
                 "suites/s.toml:3: 'spp' wants an even number, one half for each of two images, got 3"},
        BadSuite{"reference = { matched = 1 }\n", "suites/s.toml:3: 'matched' wants true or false"},
        BadSuite{"reference = { max_noise = nan }\n",
                 "suites/s.toml:3: 'max_noise' wants a number from 0 to 1, got nan"},
        BadSuite{"cost = { repetitions = 1e9 }\n",
                 "suites/s.toml:3: 'repetitions' wants an integer from 0 to 1000, got 1000000000"},
        BadSuite{"technique = { bounces = 0 }\n", "suites/s.toml:3: axis 'bounces' wants integers from 1 to 16, got 0"},
        BadSuite{"technique = { bounces = [1] }\n", "suites/s.toml:3: 'bounces' wants a string or a number"},
        BadSuite{"", "suites/s.toml:1: the suite needs a key 'scene'"},
        BadSuite{"scene = []", "suites/s.toml:3: the suite needs at least one [[scene]]"},
        BadSuite{"[[scene]]\nframes = 1", "suites/s.toml:3: a [[scene]] needs a key 'use'"},
        BadSuite{"[[scene]]\nuse = 3", "suites/s.toml:4: 'use' wants a string"},
        BadSuite{"[[scene]]\nuse = \"x\"\nframes = \"3..1\"",
                 "suites/s.toml:5: 'frames' wants an increasing range of at most 10000 frames, got '3..1'"},
        BadSuite{
            "[[scene]]\nuse = \"x\"\nframes = \"0..8/0\"",
            "suites/s.toml:5: the step of 'frames' is an integer from 1 to 1000000, as in \"0..60/4\", got '0..8/0'"},
        BadSuite{"[[scene]]\nuse = \"x\"\nfps = 0", "suites/s.toml:5: 'fps' wants a number from 0.001 to 1000, got 0"},
        BadSuite{"[[scene]]\nuse = \"x\"\nenvironment = \"sky;black\"",
                 "suites/s.toml:4: environments after the first want their time, as in 'sky;black@2', got 'black'"},
        BadSuite{"[[scene]]\nuse = \"x\"\nframes = -1",
                 "suites/s.toml:5: a frame is an integer from 0 to 1000000, got '-1'"},
        BadSuite{"[[scene]]\nuse = \"x\"\nframes = [1, 1]",
                 "suites/s.toml:5: 'frames' wants increasing numbers, got 1 after 1"},
        BadSuite{"[[scene]]\nuse = \"x\"\nframes = []", "suites/s.toml:5: 'frames' wants 1 to 10000 frames, got 0"},
        BadSuite{"[[scene]]\nuse = \"x\"\nexposure = inf",
                 "suites/s.toml:5: 'exposure' wants a number from -32 to 32, got inf"},
        BadSuite{"[[scene]]\nuse = \"x?environment=sky\"\nenvironment = \"black\"",
                 "suites/s.toml:4: 'environment' stands both in 'x?environment=sky' and beside it"},
        BadSuite{"[[scene]]\nuse = \"x\"\n[[scene]]\nuse = \"x\"",
                 "suites/s.toml:5: scene 'x' stands twice with the same camera"},
        BadSuite{"[[scene]]\nuse = \"x\"\n[grid]\nresolution = [64,\n  100]",
                 "suites/s.toml:7: axis 'resolution' wants powers of two from 8 to 4096, got 100"},
        BadSuite{"[[scene]]\nuse = \"x\"\n[grid]\nresolution = [64, 64]",
                 "suites/s.toml:6: axis 'resolution' has the value 64 twice"},
        BadSuite{
            "[[scene]]\nuse = \"x\"\n[grid]\nresolution = [64, \"*\"]",
            "suites/s.toml:6: '*' stands for an axis's names, axis 'resolution' wants powers of two from 8 to 4096"},
        BadSuite{"[[scene]]\nuse = \"x\"\n[grid]\nmips = [\"*\", \"on\"]",
                 "suites/s.toml:6: axis 'mips' has the value on twice"},
        BadSuite{"[[scene]]\nuse = \"x\"\n[grid]\nresolution = []", "suites/s.toml:6: axis 'resolution' has no values"},
        BadSuite{"[[scene]]\nuse = \"x\"\n[grid]\nresolution = 64",
                 "suites/s.toml:6: 'resolution' wants a list [ ... ]"},
        BadSuite{"[[scene]]\nuse = \"x\"\n[grid]\nresolutoin = [64]",
                 "suites/s.toml:6: key 'resolutoin' is not known; nearest is 'resolution'"},
        BadSuite{"[[scene]]\nuse = \"x\"\n[tolerance]\nflip_hrd = { relative = 1 }",
                 "suites/s.toml:6: key 'flip_hrd' is not known; nearest is 'flip_hdr'"},
        BadSuite{"[[scene]]\nuse = \"x\"\n[tolerance]\nmse = {}",
                 "suites/s.toml:6: the tolerance of 'mse' wants relative, absolute, any or all"},
        BadSuite{"[[scene]]\nuse = \"x\"\n[tolerance]\nmse = { any = [] }", "suites/s.toml:6: 'mse' has an empty list"},
        BadSuite{"[[scene]]\nuse = \"x\"\n[tolerance]\nmse = { absolute = -1 }",
                 "suites/s.toml:6: 'absolute' wants a number from 0 to 1e+09, got -1"}));

TEST(Suite, OfAnotherSchema_IsRefused) {
  EXPECT_EQ(refusalOf("schema = 2\nname = \"s\"\n"), "suites/s.toml:1: 'schema' wants 1, the only version there is");
  EXPECT_EQ(refusalOf("name = \"s\"\n"), "suites/s.toml:1: the suite needs a key 'schema'");
}

TEST(Suite, ThatIsNoToml_IsRefusedWithItsLine) {
  EXPECT_THAT(refusalOf("schema = 1\nname = \"s\n"), testing::StartsWith("suites/s.toml:2: "));
}

TEST(Suite, UnknownName_IsRefusedWithTheNearestShippedOne) {
  try {
    loadSuite("quikc");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("'quikc' is not known; nearest is 'quick'"));
  }
}

TEST(ShippedSuites, AllParse) {
  EXPECT_THAT(shippedSuites(), testing::Contains("quick"));
  for (const std::string& name : shippedSuites()) EXPECT_EQ(loadSuite(name).name, name);
}

TEST(SuiteOptions, SetGridAxis_ReplacesOrAddsInTheTablesOrder) {
  Suite suite = parse(std::string(kHead) + kScene + "[grid]\nbounces = [1, 2]\n");
  setGridAxis(suite, {"resolution", {"64"}});
  setGridAxis(suite, {"bounces", {"3"}});
  EXPECT_THAT(suite.grid, ElementsAre(GridAxis{"resolution", {"64"}}, GridAxis{"bounces", {"3"}}));
}

TEST(SuiteText, DiffersWhenAnythingThatIsMeasuredDiffers) {
  const std::string base = std::string(kHead) + kScene;
  const std::string text = canonicalText(parse(base));
  EXPECT_EQ(canonicalText(parse(base + "[tolerance]\nmse = { relative = 1 }\n")), text);
  for (const char* change :
       {"frames = 1\n", "camera = \"c\"\n", "exposure = 1\n", "environment = \"black\"\n", "warmup = 3\n",
        "[grid]\nbounces = [2]\n", "[image]\nsamples = 1\n", "[reference]\nspp = 2\n", "[reference]\ndepth = 1\n",
        "[reference]\nmax_noise = 1e-3\n", "[reference]\nmatched = false\n", "[cost]\nrepetitions = 1\n",
        "[technique]\nbounces = 2\n"})
    EXPECT_NE(canonicalText(parse(base + change)), text) << change;
}

}  // namespace
}  // namespace pb
