#include "bench/axes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/error_message.h"

namespace pb {
namespace {

TEST(Axes, EveryAxis_ReadsBackWhatItPrints) {
  Technique technique;
  technique.resolution = 64;
  technique.refresh = parseSpec("faces?k=2");
  technique.bounces = 3;
  technique.feedback = Feedback::sky;
  technique.bounceOrder = BounceOrder::simultaneous;
  technique.textureFilter = TextureFilter::hardware;
  Technique copy;
  for (const auto& [axis, value] : describe(technique)) setAxis(copy, axis, value);
  EXPECT_EQ(copy, technique);
}

TEST(Axes, Table_NamesEachAxisOnceAndSaysWhereItComesFrom) {
  std::set<std::string> names;
  for (const Axis& axis : axisTable()) {
    EXPECT_TRUE(names.insert(axis.name).second) << axis.name;
    EXPECT_FALSE(axis.values.empty() || axis.description.empty() || axis.source.empty()) << axis.name;
  }
}

TEST(Axes, Resolution_TakesPowersOfTwoWithinItsRangeOnly) {
  for (const char* good : {"8", "64", "4096"}) EXPECT_EQ(canonicalAxisValue("resolution", good), good);
  for (const char* bad : {"4", "100", "8192", "64x", "-64", "", "1e2", "99999999999999999999"})
    EXPECT_EQ(messageOf([&] { canonicalAxisValue("resolution", bad); }),
              fmt::format("axis 'resolution' wants powers of two from 8 to 4096, got {}", bad));
}

TEST(Axes, Bounces_TakeOneToSixteenOnly) {
  for (const char* good : {"1", "16"}) EXPECT_EQ(canonicalAxisValue("bounces", good), good);
  for (const char* bad : {"0", "17"})
    EXPECT_EQ(messageOf([&] { canonicalAxisValue("bounces", bad); }),
              fmt::format("axis 'bounces' wants integers from 1 to 16, got {}", bad));
}

TEST(Axes, NamedValues_RefuseOthersByListingAll) {
  EXPECT_EQ(messageOf([] { canonicalAxisValue("feedback", "skies"); }),
            "axis 'feedback' wants previous-frame | sky, got skies");
}

TEST(Axes, Refresh_RefusesUnknownPoliciesAndParameters) {
  EXPECT_THAT(messageOf([] { canonicalAxisValue("refresh", "every-farme"); }), testing::HasSubstr("'every-frame'"));
  EXPECT_THAT(messageOf([] { canonicalAxisValue("refresh", "faces?n=2"); }), testing::HasSubstr("'n'"));
}

TEST(Axes, UnknownAxis_IsRefusedWithTheNearest) {
  EXPECT_EQ(messageOf([] { axisNamed("resolutoin"); }), "axis 'resolutoin' is not known; nearest is 'resolution'");
}

TEST(AxisValues, SeveralValues_AreSplitAtCommas) {
  const auto [axis, values] = parseAxisValues("refresh=static,faces?k=2");
  EXPECT_EQ(axis, "refresh");
  EXPECT_THAT(values, testing::ElementsAre("static", "faces?k=2"));
}

TEST(AxisValues, OfEveryAxisWithNames_AreTheirDefaultsForAnAsterisk) {
  for (const Axis& axis : axisTable())
    if (!axis.names.empty()) {
      EXPECT_EQ(parseAxisValues(axis.name + "=*").second, axis.names);
    }
}

TEST(AxisValues, WithoutEqualsSignOrValue_AreRefused) {
  for (const char* bad : {"resolution", "=64", "resolution=", "resolution=64,", "resolution=64,,128"})
    EXPECT_NE(messageOf([&] { parseAxisValues(bad); }), "no error") << bad;
}

}  // namespace
}  // namespace pb
