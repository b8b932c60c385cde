// Attributions of scenes in which it is known where the error comes from.
#include "bench/attribution.h"

#include <gmock/gmock.h>

#include "bench/attribution_runner.h"
#include "bench/attribution_steps.h"
#include "bench/axes.h"
#include "scenes/files.h"
#include "tests/error_message.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

// --- The chain of techniques

std::vector<std::string> axesThatDiffer(const Technique& a, const Technique& b) {
  std::vector<std::string> axes;
  const auto valuesA = describe(a), valuesB = describe(b);
  for (std::size_t i = 0; i < valuesA.size(); ++i)
    if (valuesA[i] != valuesB[i]) axes.push_back(valuesA[i].first);
  return axes;
}

Technique ofManyApproximations() {
  Technique technique;
  for (const auto& [axis, value] : std::vector<std::pair<const char*, const char*>>{{"resolution", "32"},
                                                                                    {"refresh", "faces?k=1"},
                                                                                    {"bounces", "2"},
                                                                                    {"filter", "box-mips"},
                                                                                    {"format", "rgba8-srgb"},
                                                                                    {"hysteresis", "0.5"}})
    setAxis(technique, axis, value);
  return technique;
}

TEST(AttributionSteps, EachChangesOneApproximation) {
  const Technique technique = ofManyApproximations();
  const std::vector<RasterStep> steps = rasterSteps(technique, 512);
  ASSERT_THAT(steps, SizeIs(4));
  EXPECT_THAT(axesThatDiffer(steps[0].technique, steps[1].technique), ElementsAre("resolution"));
  EXPECT_EQ(steps[0].technique.resolution, 512);
  EXPECT_THAT(axesThatDiffer(steps[2].technique, steps[3].technique), ElementsAre("filter", "format"));
  EXPECT_THAT(axesThatDiffer(steps[3].technique, technique), ElementsAre("refresh", "bounces", "hysteresis"));
  EXPECT_TRUE(steps[1].isTraced && !steps[2].isTraced);
}

TEST(AttributionSteps, MapsOfMoreTexelsThanPerfectOnesStayAsTheyAre) {
  Technique technique;
  technique.resolution = 1024;
  EXPECT_EQ(rasterSteps(technique, 512)[0].technique.resolution, 1024);
}

// --- Which cells

Suite suiteWith(const std::string& attribution) {
  return parseSuite(R"(
schema = 1
name = "test"
technique = { resolution = 64, bounces = 2 }
scene = [{ use = "builtin:teapot", frames = "3..4" }, { use = "builtin:glass" }]
grid = { resolution = [32, 64, 128], bounces = [1, 3] }
)" + attribution,
                    "test.toml", "");
}

std::vector<std::string> attributedKeys(const Suite& suite, const PlanFilter& filter = {}) {
  std::vector<std::string> keys;
  for (const PlannedSequence& sequence : makePlan(suite, filter).sequences)
    for (const int frame : sequence.attributedFrames)
      keys.push_back(shortKey(makeCell(suite, sequence, frame).key(), describe(Technique())));
  return keys;
}

TEST(AttributedCells, AreThoseNearestToTheBaseTechniqueAtTheLastFrame) {
  const Suite suite = suiteWith("attribution = {}");
  EXPECT_THAT(attributedKeys(suite), ElementsAre(AllOf(HasSubstr("teapot"), HasSubstr("frame=4 resolution=64")),
                                                 AllOf(HasSubstr("glass"), HasSubstr("frame=0 resolution=64"))));
  EXPECT_THAT(attributedKeys(suiteWith("")), SizeIs(0));
}

TEST(AttributedCells, AreChosenByTheirKeys) {
  EXPECT_THAT(attributedKeys(suiteWith("attribution = { cells = \"teapot.*resolution=32\", frames = \"all\" }")),
              SizeIs(4));
}

TEST(AttributedCells, AreChosenFromWhatOnlyLeaves) {
  EXPECT_THAT(attributedKeys(suiteWith("attribution = {}"), {.only = "teapot.*frame=3.*resolution=128", .shard = {}}),
              ElementsAre(AllOf(HasSubstr("teapot"), HasSubstr("frame=3 resolution=128"))));
}

TEST(AttributedCells, OfAllShards_AreThoseOfTheWhole) {
  const Suite suite = suiteWith("attribution = {}");
  std::vector<std::string> keys;
  for (int part = 1; part <= 3; ++part) {
    const std::vector<std::string> more = attributedKeys(suite, {.only = std::nullopt, .shard = {part, 3}});
    keys.insert(keys.end(), more.begin(), more.end());
  }
  EXPECT_EQ(keys, attributedKeys(suite));
}

TEST(AttributedCells, ThatMatchNothing_AreRefused) {
  const Suite suite = suiteWith("attribution = { cells = \"nomatch\" }");
  EXPECT_THAT(messageOf([&] { makePlan(suite); }), HasSubstr("'nomatch', matches no cell of suite 'test'"));
}

TEST(AttributedCells, OfABadTableAreRefusedWithItsPlace) {
  const auto message = [](const std::string& table) { return messageOf([&] { suiteWith(table); }); };
  EXPECT_THAT(message("attribution = { cells = \"(\" }"), HasSubstr("test.toml:7: 'cells' wants a regular expression"));
  EXPECT_THAT(message("attribution = { frames = \"first\" }"), HasSubstr("wants last or all, got 'first'"));
  EXPECT_THAT(message("attribution = { spp = 3 }"), HasSubstr("'spp' wants an even number, got 3"));
  EXPECT_THAT(message("attribution = { cell = \".\" }"), HasSubstr("cells"));
}

// --- The model

TEST(Attribution, ComesBackFromJson) {
  const Attribution attribution{"scene",
                                "camera",
                                7,
                                {{"resolution", "32"}},
                                3,
                                {{"lookup", {{"mse", 0.25}, {"psnr", 6.0}}, {{"mse", 0.5}}}},
                                {{"ball", "mirror", 12, {{"lookup", {{"mse", 0.125}, {"bias", -0.5}}, {}}}}}};
  EXPECT_EQ(attributionFromJson(toJson(attribution), "test"), attribution);
}

TEST(Attribution, FinishedOnesOutliveAKill) {
  const TemporaryFolder folder;
  const Attribution attribution{"scene", "camera", 0, {}, 2, {{"lookup", {{"mse", 1.0}}, {}}}, {}};
  { RunDirectory(folder.path() / "run", {"suite", "f"}, false).append(attribution); }
  EXPECT_THAT(RunDirectory(folder.path() / "run", {"suite", "f"}, true).finishedAttributions(),
              ElementsAre(attribution));
  EXPECT_THAT(RunDirectory(folder.path() / "run", {"suite", "f"}, false).finishedAttributions(), SizeIs(0));
}

// --- Scenes with a known answer

constexpr char kSuite[] = R"(
schema = 1
name = "test"
image = {{ size = [64, 48], samples = 4 }}
reference = {{ spp = 2 }}
cost = {{ repetitions = 0 }}
technique = {{ {} }}
scene = [{{ use = "{}", frames = "{}" }}]
attribution = {{ resolution = {} }}
)";

struct Case {
  std::string technique;
  std::string scene = "builtin:mirror-cube";
  int frame = 0;
  int resolution = 256;  // of maps that stand for perfect ones
};

class AttributionOfScenes : public RasterTest {
 protected:
  Attribution attributionOf(const Case& c, std::shared_ptr<const Scene> scene = nullptr) {
    const TemporaryFolder folder;
    const ReferenceStore store(folder.path() / "store");
    Suite suite = parseSuite(fmt::format(kSuite, c.technique, c.scene, c.frame, c.resolution), "test", "");
    Scenes scenes = scene ? Scenes{scene} : loadScenes(suite);
    if (scene) suite.scenes.front().camera = scene->cameras.front().name;
    const Plan plan = makePlan(suite);
    RunDirectory directory(folder.path() / "run", {"test", ""}, false);
    Progress progress;
    const RunOutcome outcome = runPlan({suite, scenes, plan, device(), store, directory, progress});
    EXPECT_THAT(outcome.attribution, SizeIs(1));
    EXPECT_EQ(mseOf(outcome.attribution.front().steps.back()), outcome.cells.front().metrics.sums.mse)
        << "the last step is the cell itself";
    return outcome.attribution.front();
  }

  static double mseOf(const AttributionStep& step) {
    const auto found = std::ranges::find(step.metrics, "mse", &std::pair<std::string, double>::first);
    return found->second;
  }

  // Each step's share of the total mean squared error.
  static std::map<std::string, double> sharesOf(const Attribution& attribution) {
    std::map<std::string, double> shares;
    double before = 0.0;
    for (const AttributionStep& step : attribution.steps) {
      shares[step.step] = (mseOf(step) - before) / mseOf(attribution.steps.back());
      before = mseOf(step);
    }
    return shares;
  }

  static std::string largestOf(const std::map<std::string, double>& shares) {
    return std::ranges::max_element(shares, {}, &std::pair<const std::string, double>::second)->first;
  }
};
INSTANTIATE_TEST_SUITE_P(Backends, AttributionOfScenes, kBackends, nameOfBackend);

// A mirror ball, and boxes so far away that it is nothing to them where on the ball a ray starts.
std::shared_ptr<const Scene> makeBallAmongFarBoxes(glm::vec3 sky, glm::vec3 laterSky = glm::vec3(-1.0f)) {
  Scene scene = makeEmptyScene(sky);
  if (laterSky.x >= 0.0f) scene.environmentChanges.push_back({0.3, makeConstantEnvironment(laterSky)});
  for (int i = 0; i < 24; ++i) {
    const float angle = 0.2618f * static_cast<float>(i);
    const glm::vec3 centre(1000.0f * std::cos(angle), 250.0f * static_cast<float>(i % 5 - 2),
                           1000.0f * std::sin(angle));
    addBox(scene, centre, glm::vec3(130.0f), makeUnlit(i % 2 == 0 ? kRed : kBlue));
  }
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.8f, 64, 32)),
              addMaterial(scene, makeMirrorMaterial("mirror")));
  finishScene(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

TEST_P(AttributionOfScenes, CoarseMapsOfFarThingsErrByResolution) {
  const auto shares = sharesOf(
      attributionOf({.technique = "resolution = 8", .resolution = 1024}, makeBallAmongFarBoxes(glm::vec3(0.2f))));
  EXPECT_GT(shares.at("resolution"), 0.95);
}

TEST_P(AttributionOfScenes, MapsOfEightBitsErrByFormatWhereTheSkyIsBright) {
  const auto shares = sharesOf(attributionOf({.technique = "resolution = 256, format = \"rgba8-srgb\""},
                                             makeBallAmongFarBoxes(glm::vec3(4.0f))));
  EXPECT_GT(shares.at("filtered/format"), 0.95);
}

TEST_P(AttributionOfScenes, NearThingsInACubesFacesErrByLookup) {
  const auto shares = sharesOf(attributionOf({.technique = "resolution = 256, lookup = \"infinite\""}));
  EXPECT_GT(shares.at("lookup"), 0.9);
}

TEST_P(AttributionOfScenes, OneBounceBetweenFacingMirrorsErrsByTruncation) {
  const auto shares = sharesOf(attributionOf(
      {.technique = "resolution = 256, bounces = 1, feedback = \"sky\", bounce_order = \"simultaneous\", lookup = "
                    "\"box-proxy\"",
       .scene = "builtin:hall-of-mirrors"}));
  EXPECT_EQ(largestOf(shares), "truncated bounces");
}

TEST_P(AttributionOfScenes, StaticMapsUnderAnotherSkyErrByStaleness) {
  const auto shares = sharesOf(attributionOf({.technique = "resolution = 256, refresh = \"static\"", .frame = 12},
                                             makeBallAmongFarBoxes(glm::vec3(0.2f), glm::vec3(0.8f))));
  EXPECT_GT(shares.at("stale"), 0.95);
}

// The matte teapot has moved on; what is near to the mirror one is looked up wrongly all the same.
TEST_P(AttributionOfScenes, StaticMapsOfWhatMovesErrByStalenessToo) {
  const auto shares = sharesOf(
      attributionOf({.technique = "resolution = 256, refresh = \"static\"", .scene = "builtin:teapot", .frame = 12}));
  EXPECT_GT(shares.at("stale"), 0.05);
  for (const char* step : {"resolution", "capture", "filtered/format"}) EXPECT_LT(shares.at(step), 0.01) << step;
}

// Faces that are due see the sky, but the others' maps are of many frames: fresh maps must be as deep. Of maps that are
// one iteration deep the share is 1.6; of those that are deep enough 0.1, from two ways to sample so few texels.
TEST_P(AttributionOfScenes, BouncesOfSeveralFramesAreNoErrorOfCaptures) {
  const auto shares = sharesOf(attributionOf(
      {.technique = "resolution = 64, refresh = \"faces?k=1\", feedback = \"sky\", lookup = \"box-proxy\"",
       .scene = "builtin:hall-of-mirrors",
       .frame = 8}));
  EXPECT_LT(std::abs(shares.at("capture")), 0.4);
}

// After as many iterations as the technique has, fresh maps of what stands still are its own.
TEST_P(AttributionOfScenes, NothingIsStaleThatStandsStill) {
  for (const char* technique : {"resolution = 32, bounces = 3, feedback = \"sky\"",
                                "resolution = 32, bounces = 2, bounce_order = \"simultaneous\""}) {
    const auto shares =
        sharesOf(attributionOf({.technique = technique, .scene = "builtin:hall-of-mirrors", .frame = 1}));
    EXPECT_NEAR(shares.at("stale"), 0.0, 1e-9) << technique;
  }
}

TEST_P(AttributionOfScenes, ErrorsOfObjectsAddUpToThoseOfTheImage) {
  const Attribution attribution = attributionOf({.technique = "resolution = 32"});
  for (std::size_t step = 0; step < attribution.steps.size(); ++step) {
    double sum = 0.0;
    for (const ObjectAttribution& object : attribution.objects)
      sum += static_cast<double>(object.pixels) * mseOf(object.steps[step]);
    // Pixels in which the renderers show different objects count for both.
    const double whole = mseOf(attribution.steps[step]);
    EXPECT_GE(sum / (64 * 48), whole * (1.0 - 1e-9));
    EXPECT_LE(sum / (64 * 48), whole * 1.1);
  }
}

}  // namespace
}  // namespace pb
