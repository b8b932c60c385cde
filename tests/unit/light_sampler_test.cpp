#include "reference/light_sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <random>

#include "reference/environment_density.h"
#include "tests/analytic/reference_scenes.h"
#include "tests/statistics.h"

namespace pb {
namespace {

using namespace test;

class Numbers {
 public:
  explicit Numbers(unsigned seed) : generator_(seed) {}
  float next() { return static_cast<float>(generator_() >> 8) * 0x1p-24f; }
  glm::vec2 next2() {
    const float x = next();
    return {x, next()};
  }
  glm::vec3 direction() {
    const float z = 2.0f * next() - 1.0f, r = std::sqrt(std::max(1.0f - z * z, 0.0f));
    const float phi = 2.0f * shading::kPi * next();
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937 generator_;
};

// A dark sky with a sun of one texel, 1e5 times brighter than the rest, at a corner of the cube, where the filter's
// footprint lies on three faces.
Environment makeSunnyCube(int n, float dark = 0.01f) {
  std::vector<ImageRgba> faces(6, ImageRgba(n, n, glm::vec4(dark, dark, dark, 1.0f)));
  faces[2](n - 1, n - 1) = {1000.0f, 900.0f, 800.0f, 1.0f};
  return makeCubeEnvironment("sun", std::move(faces));
}

Environment makeGlow(float exponent) {
  shading::Sky sky{};
  sky.horizon = {0.4f, 0.5f, 0.6f, 0.0f};
  sky.zenith = {0.1f, 0.2f, 0.6f, 0.0f};
  sky.below = {0.05f, 0.05f, 0.0f, 0.0f};
  sky.glow = {50.0f, 40.0f, 30.0f, exponent};
  sky.toGlow = glm::vec4(glm::normalize(glm::vec3(0.3f, 0.8f, -0.5f)), 0.0f);
  return makeGradientEnvironment(sky);
}

struct Lit {
  const char* name;
  std::shared_ptr<const Snapshot> snapshot;
  int quadrature;  // points along a face's edge: a multiple of the environment's cells and of kFaceBins

  bool hasLamps() const { return snapshot->instances.size() > 1; }
};

// A large lamp above and a small double-sided one aside, both of triangles of unequal size.
void addLamps(Scene& scene) {
  add(scene, makeSquareMesh({0, 3, 0}, {1, 0, 0}, {0, 0, 1}, 1.0f), makeEmitter({8, 8, 6}));
  Material bothSides = makeEmitter({3, 5, 9});
  bothSides.doubleSided = true;
  Node node;
  node.translation = {2, 0, 0};
  node.scale = {1.0f, 2.0f, -0.5f};  // mirrors
  add(scene, makeSphereMesh(0.2f, 8, 4), bothSides, node);
}

std::vector<Lit> makeCases() {
  std::vector<Lit> cases;
  const auto addCase = [&](const char* name, Environment environment, bool lamps, int quadrature = 512) {
    Scene scene = makeSceneUnder(std::move(environment));
    add(scene, makeSquareMesh({0, -1, 0}, {0, 0, 1}, {1, 0, 0}, 5.0f), makeDiffuseMaterial("floor", glm::vec3(0.5f)));
    if (lamps) addLamps(scene);
    cases.push_back({name, finish(std::move(scene)), quadrature});
  };
  addCase("sunny cube", makeSunnyCube(16), false);
  addCase("sunny cube of odd size", makeSunnyCube(21), false, 504);
  addCase("sky", makeProceduralSky(), false);
  addCase("sharp glow", makeGlow(20000.0f), false);
  addCase("lamps", makeConstantEnvironment(glm::vec3(0.0f)), true);
  addCase("sky and lamps", makeProceduralSky(), true);
  return cases;
}

// Calls visit(direction, solid angle) for the midpoints of n x n squares of each face of the cube.
void forEachDirection(int n, auto visit) {
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const glm::vec2 st = (2.0f * glm::vec2(x, y) + 1.0f) / static_cast<float>(n) - 1.0f;
        const glm::vec3 d = shading::cubeDirection(face, st);
        const double r = static_cast<double>(glm::length(d));
        visit(glm::normalize(d), 4.0 / (static_cast<double>(n) * n * r * r * r));
      }
}

constexpr int kFaceBins = 8;
constexpr std::size_t kBins = 6 * kFaceBins * kFaceBins;

std::size_t binOf(const glm::vec3& d) {
  const int face = shading::cubeFaceOf(d);
  const glm::vec2 st = shading::cubeFaceCoordinates(face, d);
  const auto bin = [](float c) {
    return std::clamp(static_cast<int>(0.5f * (c + 1.0f) * static_cast<float>(kFaceBins)), 0, kFaceBins - 1);
  };
  return static_cast<std::size_t>((face * kFaceBins + bin(st.y)) * kFaceBins + bin(st.x));
}

TEST(LightSampler, DensityOfTheEnvironment_IntegratesToItsShare) {
  for (const Lit& lit : makeCases()) {
    const LightSampler lights(*lit.snapshot);
    double integral = 0.0;
    forEachDirection(lit.quadrature, [&](const glm::vec3& d, double solidAngle) {
      integral += static_cast<double>(lights.pdfEnvironment(d)) * solidAngle;
    });
    if (std::string(lit.name) == "lamps") {
      EXPECT_EQ(integral, 0.0) << lit.name;
    } else if (!lit.hasLamps()) {
      EXPECT_NEAR(integral, 1.0, 1e-4) << lit.name;
    } else {
      EXPECT_GE(integral, 0.25 - 1e-4) << lit.name;
      EXPECT_LE(integral, 0.75 + 1e-4) << lit.name;
    }
  }
}

// The two functions tell the same density where sample() went.
TEST(LightSampler, SamplesTellTheDensityThatIsAskedFor) {
  for (const Lit& lit : makeCases()) {
    const LightSampler lights(*lit.snapshot);
    ASSERT_FALSE(lights.empty());
    const ReferenceScene reference(lit.snapshot);
    Numbers numbers(1);
    const glm::vec3 position(0.3f, -0.5f, 0.2f);
    int compared = 0;
    for (int i = 0; i < 2000; ++i) {
      const glm::vec2 u = numbers.next2();
      const auto sample = lights.sample(position, u, numbers.next());
      if (!sample) continue;
      EXPECT_NEAR(glm::length(sample->direction), 1.0f, 1e-6f);
      EXPECT_GT(sample->pdf, 0.0f);
      if (sample->instance >= 0) {
        // The same point of the same light: of all its triangles one has this density.
        const glm::vec3 point = position + sample->distance * sample->direction;
        bool found = false;
        const std::size_t count =
            lit.snapshot->instances[static_cast<std::size_t>(sample->instance)].mesh->triangleCount();
        for (std::uint32_t t = 0; t < count; ++t) {
          const float pdf = lights.pdfTriangle(sample->instance, t, position, point);
          found |= std::abs(pdf - sample->pdf) <= 1e-4f * sample->pdf;
        }
        EXPECT_TRUE(found) << lit.name;
      } else {
        // Rounding may take a direction across the border of its cell.
        compared += std::abs(lights.pdfEnvironment(sample->direction) - sample->pdf) <= 1e-4f * sample->pdf;
        EXPECT_EQ(sample->radiance, environmentRadiance(lit.snapshot->scene->environment, sample->direction));
      }
    }
    if (!lit.hasLamps()) {
      EXPECT_GE(compared, 1990) << lit.name;
    }
  }
}

// Adds the integral of the density over each bin of directions from `position`: the environment's on a grid of
// directions, those of lamps on a grid of points of each triangle, since a grid of directions would blur their outlines
// and would have to be far finer.
class BinnedDensity {
 public:
  BinnedDensity(const Lit& lit, const LightSampler& lights, const glm::vec3& position)
      : lights_(lights), position_(position) {
    forEachDirection(lit.quadrature,
                     [&](const glm::vec3& d, double solidAngle) { add(d, lights.pdfEnvironment(d), solidAngle); });
    for (std::size_t i = 0; i < lit.snapshot->instances.size(); ++i)
      for (std::uint32_t t = 0; t < lit.snapshot->instances[i].mesh->triangleCount(); ++t)
        addTriangle(lit.snapshot->instances[i], static_cast<int>(i), t);
  }

  const std::vector<double>& bins() const { return bins_; }

 private:
  void add(const glm::vec3& d, float pdf, double solidAngle) {
    bins_[binOf(d)] += static_cast<double>(pdf) * solidAngle;
  }

  // Its kParts^2 parts of equal size and shape, each as its centre.
  void addTriangle(const SnapshotInstance& instance, int index, std::uint32_t triangle) {
    constexpr int kParts = 256;
    std::array<glm::vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = glm::vec3(instance.worldFromObject *
                       glm::vec4(instance.mesh->positions[instance.mesh->indices[3 * triangle + k]], 1.0f));
    const glm::vec3 u = (p[1] - p[0]) / static_cast<float>(kParts), v = (p[2] - p[0]) / static_cast<float>(kParts);
    const glm::vec3 areaNormal = 0.5f * glm::cross(u, v);
    const auto addPart = [&](float a, float b) {
      const glm::vec3 point = p[0] + a * u + b * v, d = point - position_;
      const float r = glm::length(d);
      const double solidAngle = static_cast<double>(std::abs(glm::dot(areaNormal, d)) / (r * r * r));
      add(d / r, lights_.pdfTriangle(index, triangle, position_, point), solidAngle);
    };
    for (int j = 0; j < kParts; ++j)
      for (int i = 0; i + j < kParts; ++i) {
        const auto a = static_cast<float>(i), b = static_cast<float>(j);
        addPart(a + 1.0f / 3.0f, b + 1.0f / 3.0f);
        if (i + j + 1 < kParts) addPart(a + 2.0f / 3.0f, b + 2.0f / 3.0f);
      }
  }

  const LightSampler& lights_;
  glm::vec3 position_;
  std::vector<double> bins_ = std::vector<double>(kBins, 0.0);
};

// Frequencies of directions in bins of the sphere against the density's integral over the bin; what is missing of 1 are
// the samples that find their lamp's dark side.
TEST(LightSampler, SamplesFollowTheDensity) {
  constexpr int kSamples = 40000;
  const glm::vec3 position(0.3f, -0.5f, 0.2f);
  const std::vector<Lit> cases = makeCases();
  for (const Lit& lit : cases) {
    const LightSampler lights(*lit.snapshot);
    std::vector<double> expected = BinnedDensity(lit, lights, position).bins();
    const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
    // The quadrature's error, as for the environment alone.
    EXPECT_LE(total, 1.0 + 1e-4) << lit.name;
    expected.push_back(lit.hasLamps() ? 1.0 - total : 0.0);
    for (double& e : expected) e *= kSamples;
    std::vector<double> observed(kBins + 1, 0.0);
    Numbers numbers(7);
    for (int i = 0; i < kSamples; ++i) {
      const glm::vec2 u = numbers.next2();
      const auto sample = lights.sample(position, u, numbers.next());
      ++observed[sample ? binOf(sample->direction) : kBins];
    }
    EXPECT_LT(std::abs(chiSquareScore(observed, expected)), sidakScore(static_cast<int>(cases.size()))) << lit.name;
  }
}

// Joined with directions that cover the whole sphere evenly, by the balance heuristic, samples estimate the integral of
// radiance: by quadrature for the environment.
TEST(LightSampler, WithEvenDirections_EstimatesTheIntegralOfRadiance) {
  for (const Lit& lit : makeCases()) {
    if (lit.hasLamps()) continue;
    const LightSampler lights(*lit.snapshot);
    const Environment& environment = lit.snapshot->scene->environment;
    constexpr float kEven = 0.25f / 3.14159265f;
    Numbers numbers(5);
    std::vector<double> values;
    for (int i = 0; i < 20000; ++i) {
      const glm::vec3 even = numbers.direction();
      float value = environmentRadiance(environment, even).x / (kEven + lights.pdfEnvironment(even));
      const glm::vec2 u = numbers.next2();
      if (const auto sample = lights.sample(glm::vec3(0.0f), u, numbers.next()))
        value += sample->radiance.x / (kEven + sample->pdf);
      values.push_back(static_cast<double>(value));
    }
    double integral = 0.0;
    forEachDirection(512, [&](const glm::vec3& d, double solidAngle) {
      integral += static_cast<double>(environmentRadiance(environment, d).x) * solidAngle;
    });
    const Statistics statistics = statisticsOf(values);
    EXPECT_NEAR(statistics.mean, integral, kSigmas * statistics.standardError + 1e-4 * integral) << lit.name;
    // No fireflies. A texel's filtered radiance is at most 16 times its mean (diagonal neighbours of the sun), the
    // median far below.
    EXPECT_LT(*std::ranges::max_element(values), 40.0 * integral) << lit.name;
  }
}

// Irradiance of a square lamp on the point below its centre: Lambert's closed form (shading/area_light.glsl).
TEST(LightSampler, LampsIrradiance_IsTheClosedForm) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  addLamps(scene);
  const auto snapshot = finish(std::move(scene));
  const LightSampler lights(*snapshot);
  const glm::vec3 position(0.4f, -0.3f, 0.1f), normal = glm::normalize(glm::vec3(0.2f, 1.0f, 0.1f));
  double closedForm = 0.0;
  for (const shading::AreaLight& light : snapshot->areaLights)
    closedForm += static_cast<double>(shading::areaLightIrradiance(light, position, normal).x);
  Numbers numbers(9);
  std::vector<double> values;
  for (int i = 0; i < 100000; ++i) {
    const glm::vec2 u = numbers.next2();
    const auto sample = lights.sample(position, u, numbers.next());
    const float cosine = sample ? std::max(glm::dot(sample->direction, normal), 0.0f) : 0.0f;
    values.push_back(sample ? static_cast<double>(sample->radiance.x * cosine / sample->pdf) : 0.0);
  }
  const Statistics statistics = statisticsOf(values);
  EXPECT_NEAR(statistics.mean, closedForm, kSigmas * statistics.standardError);
}

// Directions in which a bilinear filter mixes a little of the sun into a black texel.
TEST(LightSampler, DensityIsPositive_WhereverASunShinesOnBlack) {
  for (const int n : {5, 16, 1030}) {  // of 1030, cells are three texels wide and the last one is cut
    Scene scene = makeSceneUnder(makeSunnyCube(n, 0.0f));
    const auto snapshot = finish(std::move(scene));
    const LightSampler lights(*snapshot);
    Numbers numbers(3);
    int shining = 0;
    for (int i = 0; i < 20000; ++i) {
      // Around the sun's corner, as far as two texels.
      const float reach = 5.0f / static_cast<float>(n);
      const glm::vec3 d = glm::normalize(glm::vec3(1.0f) + reach * numbers.direction());
      const bool shines = environmentRadiance(snapshot->scene->environment, d) != glm::vec3(0.0f);
      shining += shines;
      EXPECT_TRUE(!shines || lights.pdfEnvironment(d) > 0.0f) << n;
    }
    EXPECT_GT(shining, 1000);
  }
}

TEST(LightSampler, UnlitSurfacesAndBlackSkies_AreNoLights) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  Material unlit = makeEmitter({5, 5, 5});
  unlit.constants.kind.x = shading::kSurfaceUnlit;
  add(scene, makeSquareMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f), unlit);
  const auto snapshot = finish(std::move(scene));
  const LightSampler lights(*snapshot);
  EXPECT_TRUE(lights.empty());
  EXPECT_FALSE(lights.sample({0, 0, 1}, {0.5f, 0.5f}, 0.5f).has_value());
  EXPECT_EQ(lights.pdfEnvironment({0, 1, 0}), 0.0f);
  EXPECT_EQ(lights.pdfTriangle(0, 0, {0, 0, 1}, {0, 0, 0}), 0.0f);
}

TEST(LightSampler, NothingStandsOutOfAConstantSky) {
  const auto snapshot = finish(makeSceneUnder(makeConstantEnvironment(glm::vec3(0.5f))));
  const LightSampler lights(*snapshot);
  EXPECT_TRUE(lights.empty());
  EXPECT_EQ(lights.pdfEnvironment({0, 1, 0}), 0.0f);
}

TEST(LightSampler, SingleSidedTriangles_AreDarkFromBehind) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  add(scene, makeSquareMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f), makeEmitter({1, 1, 1}));
  const auto snapshot = finish(std::move(scene));
  const LightSampler lights(*snapshot);
  EXPECT_TRUE(lights.sample({0, 0, 1}, {0.3f, 0.6f}, 0.1f).has_value());
  EXPECT_FALSE(lights.sample({0, 0, -1}, {0.3f, 0.6f}, 0.1f).has_value());
  EXPECT_GT(lights.pdfTriangle(0, 0, {0, 0, 1}, {0.1f, 0.1f, 0}), 0.0f);
  EXPECT_EQ(lights.pdfTriangle(0, 0, {0, 0, -1}, {0.1f, 0.1f, 0}), 0.0f);
}

// A texture of one bright texel: the mean over samples is the texture's mean, whatever a single point shows.
TEST(LightSampler, TexturedEmission_IsThatOfThePoint) {
  Scene scene = makeSceneUnder(makeConstantEnvironment(glm::vec3(0.0f)));
  ImageRgba pixels(4, 4, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  pixels(1, 2) = {16.0f, 8.0f, 4.0f, 1.0f};
  scene.textures.push_back(makeTexture("screen", std::move(pixels)));
  Material material = makeEmitter({1, 1, 1});
  material.emissionTexture = 0;
  material.constants.emissionSlot.offset.w = 1.0f;
  add(scene, makeSquareMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1.0f), material);
  const auto snapshot = finish(std::move(scene));
  const LightSampler lights(*snapshot);
  Numbers numbers(4);
  std::vector<double> values;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec2 u = numbers.next2();
    // From far away all points are at the same distance: radiance / density is radiance times the solid angle.
    const auto sample = lights.sample({0, 0, 100}, u, numbers.next());
    ASSERT_TRUE(sample.has_value());
    values.push_back(static_cast<double>(sample->radiance.x / sample->pdf) * 100.0 * 100.0 / 4.0);
  }
  const Statistics statistics = statisticsOf(values);
  EXPECT_NEAR(statistics.mean, 1.0, kSigmas * statistics.standardError);
  EXPECT_GT(statistics.variance, 1.0);
}

}  // namespace
}  // namespace pb
