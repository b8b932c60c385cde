// Emissive screens: pictures that depend on the time alone, and distances that sphere tracing may step by.
#include "scenes/screen.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <random>

#include "scenes/builtin.h"
#include "scenes/error.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

const int kPrograms = static_cast<int>(shading::kScreenPrograms);

Screen makeScreen(int program) {
  Screen screen;
  screen.name = "screen";
  screen.program = static_cast<float>(program);
  return screen;
}

double meanDifference(const ImageRgba& a, const ImageRgba& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::length(glm::dvec3(a[i]) - glm::dvec3(b[i]));
  return sum / static_cast<double>(a.size());
}

TEST(Screen, OfOneThread_HasTheSameBitsAsOfMany) {
  for (int program = 0; program < kPrograms; ++program) {
    const ImageRgba many = renderScreen(makeScreen(program), 0.7).levels[0];
    const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(renderScreen(makeScreen(program), 0.7).levels[0], many) << program;
  }
}

TEST(Screen, AfterItsPeriod_ShowsTheSame) {
  for (int program = 0; program < kPrograms; ++program) {
    const Screen screen = makeScreen(program);
    EXPECT_EQ(renderScreen(screen, 0.0).levels[0], renderScreen(screen, 8.0).levels[0]) << program;
  }
}

TEST(Screen, PhaseIsTimeInPeriods) {
  Screen later = makeScreen(0);
  later.phase = 0.25f;
  EXPECT_EQ(renderScreen(later, 0.0).levels[0], renderScreen(makeScreen(0), 1.0).levels[0]);
}

TEST(Screen, MovesBetweenFrames) {
  for (int program = 0; program < kPrograms; ++program) {
    const Screen screen = makeScreen(program);
    // Far above what rounding could do: something moved by texels.
    EXPECT_GT(meanDifference(renderScreen(screen, 0.4).levels[0], renderScreen(screen, 0.9).levels[0]), 0.005)
        << program;
  }
}

TEST(Screen, ShowsFiniteRadianceThatIsNotBlack) {
  for (int program = 0; program < kPrograms; ++program) {
    const Texture picture = renderScreen(makeScreen(program), 1.3);
    for (const glm::vec4& texel : picture.levels[0])
      for (int c = 0; c < 3; ++c) {
        ASSERT_TRUE(std::isfinite(texel[c])) << program;
        ASSERT_GT(texel[c], 0.0f) << program;
      }
  }
}

// Points on the program's surfaces, where rays from the picture's eye and from the other sides meet them.
std::vector<glm::vec3> surfacePoints(float program, float turn, std::mt19937& engine) {
  std::normal_distribution<float> normal;
  std::vector<glm::vec3> points;
  while (points.size() < 400) {
    const glm::vec3 origin = 3.0f * glm::normalize(glm::vec3(normal(engine), std::abs(normal(engine)), normal(engine)));
    const glm::vec3 target = 0.6f * glm::vec3(normal(engine), normal(engine), normal(engine));
    const glm::vec3 direction = glm::normalize(target - origin);
    const shading::ScreenHit hit = shading::traceScreen(program, origin, direction, turn);
    if (hit.distance < shading::kScreenFar) points.push_back(origin + hit.distance * direction);
  }
  return points;
}

TEST(ScreenDistance, NeverExceedsTheDistanceToTheSurface) {
  // Otherwise sphere tracing steps through it. Points count as on the surface below kScreenHit, which twisted bodies
  // divide by up to 1.83: they are up to 2 kScreenHit off.
  const float kSlack = 2.0f * shading::kScreenHit;
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(-3.0f, 3.0f);
  for (int program = 0; program < kPrograms; ++program)
    for (const float turn : {0.0f, 1.2f, 2.9f, 4.6f}) {
      const std::vector<glm::vec3> surface = surfacePoints(static_cast<float>(program), turn, engine);
      for (int i = 0; i < 500; ++i) {
        const glm::vec3 p(uniform(engine), 0.5f * uniform(engine), uniform(engine));
        const float d = shading::screenDistance(static_cast<float>(program), p, turn);
        for (const glm::vec3& s : surface) ASSERT_LE(d, glm::distance(p, s) + kSlack) << program << " at " << turn;
      }
    }
}

TEST(ScreenDistance, OfKnownBodies) {
  EXPECT_FLOAT_EQ(shading::sphereDistance({0, 3, 4}, 1.0f), 4.0f);
  EXPECT_FLOAT_EQ(shading::boxDistance({4, 5, 0}, {1, 1, 1}), 5.0f);
  EXPECT_FLOAT_EQ(shading::boxDistance({0.5f, 0.0f, 0.0f}, {1, 1, 1}), -0.5f);
  EXPECT_FLOAT_EQ(shading::torusDistance({0, 1, 3}, 1.0f, 0.5f), 2.5f);
  EXPECT_FLOAT_EQ(shading::subtraction(-0.5f, -0.2f), 0.2f);
  // Far apart a union is the minimum; where both distances are equal it is a quarter of the blend below them.
  EXPECT_FLOAT_EQ(shading::smoothUnion(1.0f, 3.0f, 0.5f), 1.0f);
  EXPECT_FLOAT_EQ(shading::smoothUnion(1.0f, 1.0f, 0.5f), 0.875f);
}

TEST(SoftShadow, IsWholeBehindABodyAndNoneBesideIt) {
  // The ball of the ripples hovers over the water's middle.
  const glm::vec3 up(0, 1, 0);
  EXPECT_EQ(shading::softShadow(shading::kScreenRipples, {0.0f, -0.5f, 0.0f}, up, 0.0f, 8.0f), 0.0f);
  EXPECT_EQ(shading::softShadow(shading::kScreenRipples, {2.5f, -0.2f, 0.0f}, up, 0.0f, 8.0f), 1.0f);
}

TEST(Snapshot, HoldsItsScreensAtItsTime) {
  const auto scene = std::make_shared<const Scene>(makeBuiltinScene({"crt-heap", {{"count", "2"}}}));
  ASSERT_GT(scene->durationSeconds, 0.0);
  const auto first = makeSnapshot(scene, 0, "", 1.5), later = makeSnapshot(scene, 30, "", 1.5);
  const auto looped = makeSnapshot(scene, static_cast<int>(scene->durationSeconds * scene->framesPerSecond), "", 1.5);
  ASSERT_EQ(first->screens.size(), scene->screens.size());
  EXPECT_EQ(later->screens[1].levels[0], renderScreen(scene->screens[1], 1.0).levels[0]);
  EXPECT_NE(contentHash(*first), contentHash(*later));
  EXPECT_EQ(contentHash(*first), contentHash(*looped));
}

TEST(Snapshot, ScreensLightTheRoom) {
  const auto scene = std::make_shared<const Scene>(makeBuiltinScene({"crt-heap", {{"count", "3"}}}));
  const auto snapshot = makeSnapshot(scene, 0, "", 1.5);
  ASSERT_EQ(snapshot->areaLights.size(), 6U);  // two triangles each
  const glm::vec3 mean =
      glm::vec3(snapshot->screens[0].levels.back()(0, 0)) *
      glm::vec3(scene->materials[static_cast<std::size_t>(scene->instances.back().material)].constants.emission);
  // The brightest come first; each has the mean radiance of one of the pictures.
  bool found = false;
  for (const shading::AreaLight& light : snapshot->areaLights) found |= glm::vec3(light.radiance) == mean;
  EXPECT_TRUE(found);
}

TEST(FinishScene, BadScreens_AreRefused) {
  const auto refuses = [](auto change) {
    Scene scene;
    scene.screens.push_back(makeScreen(0));
    change(scene.screens[0]);
    EXPECT_THROW(finishScene(scene), Error);
  };
  refuses([](Screen& s) { s.program = shading::kScreenPrograms; });
  refuses([](Screen& s) { s.program = 0.5f; });
  refuses([](Screen& s) { s.widthPx = 0; });
  refuses([](Screen& s) { s.heightPx = 100000; });
  refuses([](Screen& s) { s.periodSeconds = 0.0f; });
  refuses([](Screen& s) { s.phase = std::nanf(""); });
}

}  // namespace
}  // namespace pb
