#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/suite.h"
#include "tests/error_message.h"

namespace pb {
namespace {

using testing::HasSubstr;

constexpr const char* kHead = "schema = 1\nname = \"s\"\n[[scene]]\nuse = \"builtin:mirrors\"\n";

Suite parse(const std::string& scene, const std::string& tolerance) {
  return parseSuite(kHead + scene + "[tolerance]\n" + tolerance, "s.toml", "");
}

std::string refusalOf(const std::string& scene, const std::string& tolerance) {
  return messageOf([&] { parse(scene, tolerance); });
}

TEST(SuiteTolerance, Preset_GivesBothLevels) {
  for (const TolerancePreset& preset : tolerancePresets()) {
    const Suite suite = parse("", "preset = \"" + preset.name + "\"\n");
    EXPECT_EQ(suite.tolerance, preset.levels.fail);
    EXPECT_EQ(suite.warnTolerance, preset.levels.warn);
  }
}

TEST(SuiteTolerance, MetricBesideAPreset_ReplacesBothOfItsLevels) {
  const Suite suite = parse("", "preset = \"default\"\nssim = { absolute = 0.5 }\nmse = { absolute = 2 }\n");
  EXPECT_EQ(findTolerance(suite.tolerance, "ssim")->absolute, 0.5);
  EXPECT_EQ(findTolerance(suite.warnTolerance, "ssim"), nullptr);
  EXPECT_EQ(findTolerance(suite.tolerance, "mse")->absolute, 2);
  EXPECT_NE(findTolerance(suite.warnTolerance, "flip_hdr"), nullptr);
}

TEST(SuiteTolerance, WarningLevel_StandsBesideATree) {
  const Suite suite = parse(
      "", "mse = { any = [{ absolute = 1 }, { all = [{ relative = 2 }] }], warn = { all = [{ absolute = 0.5 }] } }\n");
  EXPECT_EQ(suite.tolerance[0].second.kind, Tolerance::Kind::any);
  EXPECT_EQ(suite.tolerance[0].second.children[1].kind, Tolerance::Kind::all);
  ASSERT_EQ(suite.warnTolerance.size(), 1u);
  EXPECT_EQ(suite.warnTolerance[0].second.children[0].absolute, 0.5);
}

TEST(SuiteTolerance, OfAScene_IsFoundByItsNameAndCamera) {
  const Suite suite = parse("camera = \"front\"\ntolerance = { mse = { absolute = 3 } }\n", "mse = { absolute = 1 }\n");
  const SceneTolerances scenes = sceneTolerancesOf(suite);
  ASSERT_EQ(scenes.size(), 1u);
  EXPECT_EQ(scenes.begin()->first, "scene=builtin:mirrors camera=front");
  EXPECT_EQ(scenes.begin()->second.fail[0].second.absolute, 3);
}

TEST(SuiteTolerance, PresetOfAScene_HoldsForGatedMetricsOnly) {
  const Suite suite = parse("tolerance = { preset = \"loose\" }\n", "ssim = { absolute = 1 }\n");
  ASSERT_EQ(suite.scenes[0].tolerance.fail.size(), 1u);
  EXPECT_EQ(suite.scenes[0].tolerance.fail[0].first, "ssim");
}

TEST(SuiteTolerance, BadOnes_AreRefusedWithTheirPlace) {
  EXPECT_THAT(refusalOf("", "preset = \"strickt\"\n"), testing::AllOf(HasSubstr("s.toml:6"), HasSubstr("'strict'")));
  EXPECT_THAT(refusalOf("", "mse = { absolute = 1, warn = {} }\n"), HasSubstr("the tolerance of 'mse' wants relative"));
  EXPECT_THAT(refusalOf("", "mse = { any = [{ absolute = 1, warn = { absolute = 1 } }] }\n"), HasSubstr("'warn'"));
  EXPECT_THAT(refusalOf("tolerance = { mae = { absolute = 3 } }\n", "mse = { absolute = 1 }\n"),
              HasSubstr("s.toml:5: a scene's tolerance wants a metric that [tolerance] has too, got 'mae'"));
}

}  // namespace
}  // namespace pb
