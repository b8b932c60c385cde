// Attributions of scenes in which it is known where the error comes from.
#include "bench/attribution.h"

#include <gmock/gmock.h>

#include "bench/attribution_runner.h"
#include "bench/attribution_steps.h"
#include "bench/axes.h"
#include "tests/temporary_folder.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::SizeIs;

// --- The chain of techniques
// ------------------------------------------------------------------------------------------

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
  EXPECT_THAT(axesThatDiffer(steps[3].technique, technique), ElementsAre("refresh", "hysteresis"));
  EXPECT_TRUE(steps[1].isTraced && !steps[2].isTraced);
}

TEST(AttributionSteps, MapsOfMoreTexelsThanPerfectOnesStayAsTheyAre) {
  Technique technique;
  technique.resolution = 1024;
  EXPECT_EQ(rasterSteps(technique, 512)[0].technique.resolution, 1024);
}

// --- The model
// --------------------------------------------------------------------------------------------------------

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
// ---------------------------------------------------------------------------------------

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
