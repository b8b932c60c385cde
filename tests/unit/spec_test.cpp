#include "scenes/spec.h"

#include <gmock/gmock.h>

#include "scenes/error.h"

namespace pb {
namespace {

TEST(Spec, NameAlone_HasNoParameters) {
  const Spec spec = parseSpec("static");
  EXPECT_EQ(spec.name, "static");
  EXPECT_TRUE(spec.parameters.empty());
}

TEST(Spec, PrintingGivesBackWhatWasParsed) {
  for (const char* text :
       {"static", "every-n?n=4", "ratio?bias=0&scale=1&power=5", "a/b.glb?mirror=all&environment=x/y z.exr",
        "a.glb?environment=(sky;constant?r=1&g=2@3)&mirror=all", "a.glb?environment=x (1).exr&mirror=(1)2"})
    EXPECT_EQ(printSpec(parseSpec(text)), text);
}

TEST(Spec, ParametersOfAParameter_StandInParentheses) {
  const Spec spec = parseSpec("a.glb?environment=(constant?r=1&g=(2)&b=3)&mirror=all");
  ASSERT_EQ(spec.parameters.size(), 2U);
  EXPECT_EQ(spec.parameters[0].second, "constant?r=1&g=(2)&b=3");
  EXPECT_EQ(spec.parameters[1].first, "mirror");
}

TEST(Spec, MalformedParameters_AreRefusedWithTheWholeText) {
  for (const char* text : {"", "?n=4", "every-n?n", "every-n?=4", "every-n?n=4&n=5"})
    EXPECT_THROW(parseSpec(text), Error) << text;
}

TEST(SpecReader, ValuesOutOfRangeAndTrailingText_AreRefused) {
  for (const char* value : {"0", "1001", "4x", "", "1e3", "-1", "99999999999999999999"}) {
    SpecReader reader(parseSpec(std::string("every-n?n=") + value), "refresh");
    EXPECT_THROW(reader.integer("n", 1, 1000, 4), Error) << value;
  }
}

TEST(SpecReader, UnknownParameter_NamesTheNearest) {
  SpecReader reader(parseSpec("mirrors?cuont=3"), "scene 'mirrors'");
  EXPECT_EQ(reader.integer("count", 1, 64, 5), 5);
  try {
    reader.finish();
    FAIL() << "an unknown parameter was accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "scene 'mirrors': parameter 'cuont' is not known; nearest is 'count'");
    EXPECT_EQ(error.kind(), Failure::input);
  }
}

TEST(Nearest, IsTheSmallestEditDistance) {
  const std::vector<std::string> words = {"refresh", "resolution", "bounces"};
  EXPECT_EQ(nearest("refesh", words), "refresh");
  EXPECT_EQ(nearest("resoluton", words), "resolution");
  EXPECT_EQ(nearest("bounce", words), "bounces");
}

TEST(UnknownMessage, NamesTheNearestWordOnlyIfItIsNear) {
  const std::vector<std::string> words = {"refresh", "resolution", "bounces"};
  EXPECT_EQ(unknownMessage("bonces", words), "'bonces' is not known; nearest is 'bounces'");
  EXPECT_EQ(unknownMessage("glossiness", words),
            "'glossiness' is not known; known are 'refresh', 'resolution', 'bounces'");
  EXPECT_THAT(unknownMessage("glossiness", std::vector<std::string>(25, "x")), testing::EndsWith("'x' and 5 more"));
}

TEST(ParseNumber, AcceptsOnlyWholeFiniteNumbers) {
  EXPECT_EQ(parseNumber("1e-5"), 1e-5);
  for (const char* text : {"", "nan", "inf", "1.0.0", "1 ", "0x10"}) EXPECT_EQ(parseNumber(text), std::nullopt) << text;
}

}  // namespace
}  // namespace pb
