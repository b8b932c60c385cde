// What the attributions of one frame render: each image, each set of traced maps and equal captures once.
#include "bench/attribution_renders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

constexpr int kResolution = 64, kHeight = 64;

AttributedCell cellOf(const Technique& technique, int depth = 2) { return {technique, depth, depth}; }

Technique withLookup(const char* lookup) {
  Technique technique = withResolution(16);
  technique.lookup = parseSpec(lookup);
  return technique;
}

Technique with(void (*change)(Technique&)) {
  Technique technique = withResolution(16);
  change(technique);
  return technique;
}

// One mirror among matte surfaces: its captures show no maps.
AttributionRenders rendersOf(const std::vector<AttributedCell>& cells, bool sharesCaptures = true,
                             const std::string& scene = "mirror-cube") {
  return attributionRenders(cells, snapshotOf(scene), kResolution, kHeight, sharesCaptures);
}

std::vector<std::size_t> imagesOf(const AttributionRenders& renders) {
  std::vector<std::size_t> counts;
  for (const TracedSet& set : renders.traced) counts.push_back(set.images.size());
  for (const FreshSet& set : renders.fresh) counts.push_back(set.images.size());
  return counts;
}

// Every step of every cell has one image.
void expectAllOnce(const AttributionRenders& renders, std::size_t cells) {
  std::vector<ImageUse> uses;
  for (const TracedSet& set : renders.traced)
    for (const TracedImage& image : set.images) uses.insert(uses.end(), image.uses.begin(), image.uses.end());
  for (const FreshSet& set : renders.fresh)
    for (const FreshImage& image : set.images) uses.insert(uses.end(), image.uses.begin(), image.uses.end());
  EXPECT_THAT(uses, SizeIs(4 * cells));
  for (std::size_t cell = 0; cell < cells; ++cell)
    for (const char* step : {"lookup", "resolution", "capture", "filtered/format"})
      EXPECT_EQ(std::ranges::count(uses, ImageUse{cell, step}), 1) << cell << " " << step;
}

// Its format and filter are the best ones already: the last two steps are one image.
TEST(AttributionRenders, OfOneCell_AreItsImages) {
  const AttributionRenders renders = rendersOf({cellOf(withResolution(16))});
  EXPECT_THAT(imagesOf(renders), ElementsAre(1, 1, 1));
  expectAllOnce(renders, 1);
  EXPECT_EQ(renders.imageCount(), 3u);
}

TEST(AttributionRenders, OfOtherFormats_CaptureAfreshForThem) {
  const auto coarse = with([](Technique& t) { t.format = ProbeFormat::rgba8Srgb; });
  EXPECT_THAT(imagesOf(rendersOf({cellOf(coarse)})), ElementsAre(1, 1, 1, 1));
}

// What is gone in fresh captures and traced maps makes no other image.
TEST(AttributionRenders, OfCellsThatDifferInTime_AreThoseOfOne) {
  const std::vector<AttributedCell> cells = {cellOf(withResolution(16)),
                                             cellOf(with([](Technique& t) { t.refresh = parseSpec("static"); })),
                                             cellOf(with([](Technique& t) { t.bounces = 3; })),
                                             cellOf(with([](Technique& t) { t.hysteresis = 0.5f; })),
                                             cellOf(with([](Technique& t) { t.feedback = Feedback::sky; })),
                                             cellOf(with([](Technique& t) { t.iterations = Iterations::incremental; })),
                                             cellOf(with([](Technique& t) { t.preset = "best"; }))};
  const AttributionRenders renders = rendersOf(cells);
  EXPECT_THAT(imagesOf(renders), ElementsAre(1, 1, 1));
  expectAllOnce(renders, cells.size());
}

// Distances are traced beside the same faces, and captured beside them.
TEST(AttributionRenders, OfSeveralLookups_ShowTheSameMaps) {
  const std::vector<AttributedCell> cells = {cellOf(withLookup("infinite")), cellOf(withLookup("box-proxy")),
                                             cellOf(withLookup("distance-impostor"))};
  const AttributionRenders renders = rendersOf(cells);
  EXPECT_THAT(imagesOf(renders), ElementsAre(3, 3, 3));
  expectAllOnce(renders, cells.size());
  EXPECT_TRUE(renders.traced[0].withDistances && renders.traced[1].withDistances);
  EXPECT_FALSE(rendersOf({cells[0], cells[1]}).traced[0].withDistances);
}

// Where captures show maps, each lookup has its own.
TEST(AttributionRenders, OfLookupsThatShowInCaptures_ShareTracedMapsOnly) {
  const std::vector<AttributedCell> cells = {cellOf(withLookup("infinite")), cellOf(withLookup("box-proxy"))};
  EXPECT_THAT(imagesOf(rendersOf(cells, true, "mirrors?count=2")), ElementsAre(2, 2, 1, 1));
}

TEST(AttributionRenders, WithoutSharedCaptures_StillRenderEqualImagesOnce) {
  const std::vector<AttributedCell> cells = {cellOf(withLookup("infinite")), cellOf(withLookup("box-proxy")),
                                             cellOf(withLookup("infinite"))};
  const AttributionRenders renders = rendersOf(cells, false);
  EXPECT_THAT(imagesOf(renders), ElementsAre(2, 2, 1, 1));
  expectAllOnce(renders, cells.size());
}

// Traced maps are cut at another depth; fresh ones of deeper cells go through the shallower ones' state.
TEST(AttributionRenders, OfSeveralDepths_CaptureOnceForAll) {
  const std::vector<AttributedCell> cells = {cellOf(withResolution(16), 2), cellOf(withResolution(16), 4)};
  const AttributionRenders renders = rendersOf(cells, true, "mirrors?count=2");
  EXPECT_THAT(renders.traced, SizeIs(4));
  ASSERT_THAT(renders.fresh, SizeIs(1));
  ASSERT_THAT(renders.fresh[0].images, SizeIs(2));
  EXPECT_THAT(renders.fresh[0].techniques, SizeIs(1));
  EXPECT_LT(renders.fresh[0].images[0].renders, renders.fresh[0].images[1].renders);
  EXPECT_EQ(renders.fresh[0].renders(), renders.fresh[0].images[1].renders);
  expectAllOnce(renders, cells.size());
}

// A lone mirror's maps never get deeper than one hit.
TEST(AttributionRenders, OfDepthsThatMapsDontReach_End) {
  EXPECT_LE(rendersOf({cellOf(withResolution(16), 60)}).fresh[0].renders(), 2);
}

TEST(AttributionRenders, OfProbesThatStandElsewhere_ShareNothing) {
  const auto atOrigin = with([](Technique& t) { t.placement = Placement::origin; });
  EXPECT_THAT(rendersOf({cellOf(withResolution(16)), cellOf(atOrigin)}, true, "mirrors?count=2").traced, SizeIs(4));
}

TEST(TruncatedDepth, IsThatOfTheTruthWhereItHasNoMore) {
  TruthSettings truth;
  truth.depth = std::nullopt;
  EXPECT_EQ(truncatedDepth(truth, 3), std::optional(3));
  EXPECT_EQ(truncatedDepth(truth, 64), std::nullopt);
  truth.depth = 4;
  EXPECT_EQ(truncatedDepth(truth, 3), std::optional(3));
  EXPECT_EQ(truncatedDepth(truth, 5), std::optional(4));
}

}  // namespace
}  // namespace pb
