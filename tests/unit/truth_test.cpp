#include "bench/truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <glm/geometric.hpp>

#include "bench/bounce_depth.h"
#include "scenes/environment.h"
#include "scenes/files.h"
#include "tests/analytic/reference_scenes.h"

namespace pb {
namespace {

constexpr ImageSettings kImage{16, 16, 1};

// A glass ball under the sky: reflection or refraction is chosen at random, so the reference has noise.
std::shared_ptr<const Snapshot> glassBall() {
  Scene scene = test::makeSceneUnder(makeProceduralSky());
  test::add(scene, makeSphereMesh(1.0f, 32, 16), test::makeGlass(1.5f));
  return test::finish(std::move(scene));
}

Grid<SampleId> nothingSeen(const Snapshot&) { return Grid<SampleId>(16, 16); }

std::shared_ptr<const Truth> makeTruth(const ReferenceStore& store, const TruthSettings& settings) {
  std::vector<std::string> warnings;
  const auto truth = TruthMaker(store, kImage, settings, nothingSeen).make(glassBall(), 0, warnings);
  EXPECT_TRUE(warnings.empty());
  return truth;
}

std::size_t entryCount(const TemporaryFolder& folder) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    count += entry.path().extension() == ".exr";
  return count;
}

TEST(Truth, SamplesAreAddedUntilTheNoiseIsMet) {
  const TemporaryFolder folder;
  const ReferenceStore store(folder.path());
  const auto start = makeTruth(store, {.depth = {}, .spp = 4, .maxNoise = {}});
  EXPECT_EQ(entryCount(folder), 1u);
  const auto quieter = makeTruth(store, {.depth = {}, .spp = 4, .maxNoise = start->noise / 8});
  EXPECT_LE(quieter->noise, start->noise / 8);
  // The pilot, which is the picture above, and mostly one pass: a second if the first was noisier than planned.
  EXPECT_GE(entryCount(folder), 2u);
  EXPECT_LE(entryCount(folder), 4u);
  const std::size_t entries = entryCount(folder);
  EXPECT_EQ(makeTruth(store, {.depth = {}, .spp = 4, .maxNoise = start->noise / 8})->mean, quieter->mean);
  EXPECT_EQ(entryCount(folder), entries);  // all from the store
}

TEST(Truth, ThatIsQuietEnough_IsThePilot) {
  const TemporaryFolder folder;
  const ReferenceStore store(folder.path());
  const auto uniform = makeTruth(store, {.depth = {}, .spp = 4, .maxNoise = {}});
  EXPECT_EQ(makeTruth(store, {.depth = {}, .spp = 4, .maxNoise = 2 * uniform->noise})->mean, uniform->mean);
  EXPECT_EQ(entryCount(folder), 1u);
}

TEST(Truth, ThatCantMeetTheNoise_StopsAtTheLimitOfSamples) {
  const TemporaryFolder folder;
  const auto truth = makeTruth(ReferenceStore(folder.path()), {.depth = {}, .spp = kMaxSpp / 2, .maxNoise = 0.0});
  EXPECT_GT(truth->noise, 0.0);
  EXPECT_EQ(entryCount(folder), 2u);
}

TEST(Truth, FloorIsThatOfItsHalvesAndTheMaskThatOfTheBall) {
  const TemporaryFolder folder;
  const auto truth = makeTruth(ReferenceStore(folder.path()), {});
  EXPECT_EQ(truth->floor[1].first, "relmse");
  EXPECT_EQ(truth->floor[1].second, truth->noise);
  EXPECT_NE(truth->halfA, truth->halfB);
  EXPECT_NE(truth->mask(8, 8), 0);
  EXPECT_EQ(truth->mask(0, 0), 0);
  // All noise is inside the mask: its mean there is larger by the share of pixels that the mask takes.
  const auto inside = static_cast<double>(std::ranges::count_if(truth->mask, [](unsigned char m) { return m != 0; }));
  EXPECT_NEAR(truth->maskFloor[0].second * inside, truth->floor[0].second * 256, 1e-9 * truth->floor[0].second * 256);
}

// Two balls that reflect each other and the sky. Each hit turns rays further away, so that none has 30 of them.
std::shared_ptr<const Snapshot> twoMirrors() {
  Scene scene = test::makeSceneUnder(makeProceduralSky());
  for (const float x : {-1.2f, 1.2f}) {
    Node node;
    node.translation = {x, 0.0f, 0.0f};
    test::add(scene, makeSphereMesh(1.0f, 32, 16), makeMirrorMaterial("mirror"), node);
  }
  return test::finish(std::move(scene));
}

TEST(Truth, Truncated_AreMadeForTheDepthsAskedForUntilNothingIsMissing) {
  const TemporaryFolder folder;
  const ReferenceStore store(folder.path());
  std::vector<std::string> warnings;
  const TruthMaker maker(store, kImage, {.depth = {}, .spp = 4, .maxNoise = {}}, nothingSeen);
  const auto truth = maker.make(twoMirrors(), 0, warnings, {1, 30, 40, kMaxMatchedDepth + 1});
  ASSERT_EQ(truth->truncated.size(), 4u);
  EXPECT_FALSE(truth->truncated.at(1).converged);
  EXPECT_NE(truth->truncated.at(1).mean, truth->mean);
  for (const int depth : {30, 40, kMaxMatchedDepth + 1}) EXPECT_TRUE(truth->truncated.at(depth).converged) << depth;
  // The converged one, depth 1, and depth 30, which turns out to be the converged one: 40 was not traced.
  EXPECT_EQ(entryCount(folder), 3u);
}

// Against itself a truncated truth has no error; against the converged one what bounces beyond the first bring.
TEST(Truth, Truncated_ScoresWhatHasItsBounces) {
  const TemporaryFolder folder;
  const ReferenceStore store(folder.path());
  std::vector<std::string> warnings;
  const auto converged = TruthMaker(store, kImage, {.depth = {}, .spp = 4, .maxNoise = {}}, nothingSeen)
                             .make(twoMirrors(), 0, warnings, {1});
  const auto single = TruthMaker(store, kImage, {.depth = 1, .spp = 4, .maxNoise = {}}, nothingSeen)
                          .make(twoMirrors(), 0, warnings, {1, 2});
  EXPECT_EQ(converged->truncated.at(1).compare(single->mean, nullptr).whole.sums.mse, 0.0);
  EXPECT_GT(converged->metrics.compare(single->mean).whole.sums.mse, 0.0);
  // Nothing is deeper than the suite's own depth.
  EXPECT_TRUE(single->truncated.at(1).converged && single->truncated.at(2).converged);
  EXPECT_EQ(entryCount(folder), 2u);
}

TEST(Truth, ObjectMap_TellsWhatPixelsShowAndWhere) {
  const TemporaryFolder folder;
  const auto snapshot = glassBall();
  const auto truth = makeTruth(ReferenceStore(folder.path()), {});
  EXPECT_EQ(truth->objects.inReference(8, 8), 0);
  EXPECT_EQ(truth->objects.inReference(0, 0), -1);
  EXPECT_EQ(truth->objects.inRaster(8, 8), -1);  // nothingSeen()
  EXPECT_EQ(truth->objects.atCentre(8, 8), 0);
  // On the unit sphere, but for its triangles: 32 x 16 of them come at most 1 - cos(pi / 16) = 2 % nearer.
  EXPECT_NEAR(glm::length(truth->objects.positions(8, 8)), 1.0f, 0.02f);
}

TEST(MostSpp, IsSppDoubledUpToTheLimit) {
  EXPECT_EQ(mostSpp({.depth = {}, .spp = 16, .maxNoise = {}}), kMaxSpp);
  EXPECT_EQ(mostSpp({.depth = {}, .spp = 100, .maxNoise = {}}), 800);
  EXPECT_EQ(mostSpp({.depth = {}, .spp = 3000, .maxNoise = {}}), 3000);
}

}  // namespace
}  // namespace pb
