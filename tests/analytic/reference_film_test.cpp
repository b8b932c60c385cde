// Samples, batches and settings of the reference renderer.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>

#include "reference/renderer.h"
#include "reference/sampler.h"
#include "scenes/error.h"
#include "tests/analytic/reference_scenes.h"

namespace pb {
namespace {

using namespace test;

Environment makeSteepSky() {
  shading::Sky sky;
  sky.horizon = {0.1f, 0.2f, 0.3f, 0.0f};
  sky.zenith = {2.0f, 1.0f, 0.5f, 0.0f};
  sky.below = {0.0f, 0.0f, 0.1f, 0.0f};
  sky.glow = {0.0f, 0.0f, 0.0f, 1.0f};
  sky.toGlow = {0.0f, 1.0f, 0.0f, 0.0f};
  return makeGradientEnvironment(sky);
}

// One ball of the given material above a mirror.
std::shared_ptr<const Snapshot> makeBall(const Material& material) {
  Scene scene = makeSceneUnder(makeSteepSky());
  add(scene, makeSphereMesh(1.0f, 32, 16), material);
  add(scene, makeSquareMesh({0, -1.2f, 0}, {0, 0, 1}, {1, 0, 0}, 2.0f), makeMirrorMaterial("mirror", glm::vec3(0.8f)));
  addCamera(scene, "camera", {0.5f, 1.0f, 4.0f}, {0, 0, 0}, glm::radians(35.0f), 0.1f);
  return finish(std::move(scene));
}

ReferenceImage renderBall(const Material& material, const ReferenceSettings& settings) {
  const auto snapshot = makeBall(material);
  return ReferenceScene(snapshot).render(snapshot->camera, 40, 40, settings);
}

TEST(Threads, AnyNumber_GivesTheSameBits) {
  const ReferenceSettings settings{.samplesPerAxis = 2, .spp = 6};
  const auto renderWith = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    return arena.execute([&] { return renderBall(makeGlass(1.5f), settings); });
  };
  const ReferenceImage one = renderWith(1);
  for (const int threads : {2, 5}) {
    const ReferenceImage many = renderWith(threads);
    EXPECT_EQ(one.batches, many.batches) << threads;
    EXPECT_EQ(one.raysTraced, many.raysTraced) << threads;
  }
}

TEST(Batches, AreAsManyAsTheSamplesAtMostSixteen) {
  for (const auto& [spp, batches] : {std::pair{2, 2}, {6, 6}, {16, 16}, {40, 16}})
    EXPECT_EQ(static_cast<int>(renderBall(makeGlass(1.5f), {.samplesPerAxis = 1, .spp = spp}).batches.size()), batches);
}

// Paths without random numbers are traced once, whatever spp is, and every batch and half is that picture exactly.
TEST(Batches, OfDeterministicPaths_AreEqual) {
  const Material mirror = makeMirrorMaterial("mirror", {0.9f, 0.8f, 0.7f});
  const ReferenceImage two = renderBall(mirror, {.samplesPerAxis = 3, .spp = 2});
  const ReferenceImage many = renderBall(mirror, {.samplesPerAxis = 3, .spp = 22});
  for (const Image& batch : many.batches) EXPECT_EQ(batch, two.batches.front());
  EXPECT_EQ(many.mean(), two.batches.front());
  EXPECT_EQ(many.half(0), many.half(1));
  EXPECT_EQ(many.raysTraced, two.raysTraced);
}

double meanSquare(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec3 d = glm::dvec3(a[i]) - glm::dvec3(b[i]);
    sum += glm::dot(d, d);
  }
  return sum / static_cast<double>(3 * a.size());
}

// Halves that were not independent, or whose mean were wrong, would make mean((A-B)^2)/4 miss the mean's true error.
TEST(Halves, OfStochasticPaths_EstimateTheNoiseOfTheMean) {
  const ReferenceImage image = renderBall(makeGlass(1.5f), {.samplesPerAxis = 1, .spp = 32});
  const Image truth = renderBall(makeGlass(1.5f), {.samplesPerAxis = 1, .spp = 1024, .seed = 77}).mean();
  const double floor = meanSquare(image.half(0), image.half(1)) / 4.0;
  const double error = meanSquare(image.mean(), truth);
  ASSERT_GT(floor, 0.0);
  // About 600 noisy pixels of unequal variance: each side has a relative deviation of some 10 %. The truth's own noise
  // adds 32 / 1024.
  EXPECT_NEAR(error / floor, 1.0, 0.35);
}

TEST(Seeds, GiveOtherNoise) {
  const Material glass = makeGlass(1.5f);
  const Image one = renderBall(glass, {.samplesPerAxis = 1, .spp = 2, .seed = 1}).mean();
  EXPECT_EQ(one, renderBall(glass, {.samplesPerAxis = 1, .spp = 2, .seed = 1}).mean());
  EXPECT_NE(one, renderBall(glass, {.samplesPerAxis = 1, .spp = 2, .seed = 2}).mean());
  EXPECT_NE(one, renderBall(glass, {.samplesPerAxis = 1, .spp = 2, .seed = 1ull << 32 | 1}).mean());
}

TEST(Settings, OutOfRange_AreInputErrors) {
  const auto snapshot = makeBall(makeGlass(1.5f));
  const ReferenceScene scene(snapshot);
  const auto failureOf = [&](int width, const ReferenceSettings& settings) -> std::optional<Failure> {
    try {
      scene.render(snapshot->camera, width, 4, settings);
    } catch (const Error& error) {
      return error.kind();
    }
    return std::nullopt;
  };
  EXPECT_EQ(failureOf(4, {.samplesPerAxis = 1, .spp = 2, .depth = 1, .hiddenInstances = {1}}), std::nullopt);
  EXPECT_EQ(failureOf(0, {}), Failure::input);
  EXPECT_EQ(failureOf(4, {.samplesPerAxis = 0}), Failure::input);
  EXPECT_EQ(failureOf(4, {.spp = 0}), Failure::input);
  EXPECT_EQ(failureOf(4, {.spp = 3}), Failure::input);
  EXPECT_EQ(failureOf(4, {.depth = 0}), Failure::input);
  EXPECT_EQ(failureOf(4, {.hiddenInstances = {2}}), Failure::input);
  EXPECT_EQ(failureOf(4, {.hiddenInstances = {-1}}), Failure::input);
}

TEST(Cancelling, ThrowsInterrupted) {
  const auto snapshot = makeBall(makeGlass(1.5f));
  const std::atomic<bool> cancelled = true;
  try {
    ReferenceScene(snapshot).render(snapshot->camera, 4, 4, {}, &cancelled);
    FAIL() << "not interrupted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::interrupted);
  }
}

TEST(EmptyScene, ShowsTheEnvironment) {
  Scene scene = makeSceneUnder(makeConstantEnvironment({0.25f, 0.5f, 0.75f}));
  addCamera(scene, "camera", {0, 0, 1}, {0, 0, 0}, 1.0f, 0.1f);
  const auto snapshot = finish(std::move(scene));
  EXPECT_EQ(ReferenceScene(snapshot).render(snapshot->camera, 5, 3, {}).mean(), Image(5, 3, {0.25f, 0.5f, 0.75f}));
}

// Pearson's chi-square of 64 equal bins, as a standard normal variable (Wilson and Hilferty 1931).
double uniformityScore(const std::function<float(std::uint32_t)>& number) {
  constexpr int kBins = 64;
  constexpr std::uint32_t kCount = 64 * 1000;
  std::array<int, kBins> bins{};
  for (std::uint32_t i = 0; i < kCount; ++i) ++bins[static_cast<std::size_t>(number(i) * kBins)];
  const double expected = static_cast<double>(kCount) / kBins, freedom = kBins - 1;
  double chiSquare = 0.0;
  for (const int n : bins) chiSquare += (n - expected) * (n - expected) / expected;
  const double variance = 2.0 / (9.0 * freedom);
  return (std::cbrt(chiSquare / freedom) - (1.0 - variance)) / std::sqrt(variance);
}

TEST(Sampler, IsUniformAlongEveryArgument) {
  const auto first = [](std::uint64_t seed, std::uint32_t point, std::uint64_t sample) {
    return Sampler(seed, point, sample).next();
  };
  Sampler dimensions(1, 2, 3);
  // Two-sided: bins that are too even are no random numbers either.
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return first(i, 2, 3); })), kSigmas);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return first(1, i, 3); })), kSigmas);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return first(1, 2, i); })), kSigmas);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t) { return dimensions.next(); })), kSigmas);
}

// Neighbours along two arguments: the fractional part of their sum is uniform only if they are not tied together.
TEST(Sampler, NeighboursAreNotCorrelated) {
  const auto fraction = [](float x) { return x - std::floor(x); };
  const auto pair = [](std::uint32_t point, std::uint64_t sample) {
    Sampler sampler(1, point, sample);
    const float a = sampler.next();
    return std::pair{a, sampler.next()};
  };
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) {
              const auto [a, b] = pair(i, 0);
              return fraction(a + b);
            })),
            kSigmas);
  EXPECT_LT(std::abs(uniformityScore([&](std::uint32_t i) { return fraction(pair(i, 0).first + pair(i, 1).first); })),
            kSigmas);
  EXPECT_LT(
      std::abs(uniformityScore([&](std::uint32_t i) { return fraction(pair(i, 0).first + pair(i + 1, 0).first); })),
      kSigmas);
}

}  // namespace
}  // namespace pb
