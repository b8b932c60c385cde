// Environments: directions, ambient light, resampling, repair of bad values.
#include "scenes/environment.h"

#include <gmock/gmock.h>

#include <functional>
#include <glm/geometric.hpp>

#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr float kPi = 3.14159265f;

// Direction through (u, v) of an equirectangular image, from the convention in environment.h: written independently of
// the loader's inverse.
glm::vec3 directionAt(float u, float v) {
  const float azimuth = 2.0f * kPi * (u - 0.5f), polar = kPi * v;
  return {std::sin(azimuth) * std::sin(polar), std::cos(polar), -std::cos(azimuth) * std::sin(polar)};
}

template <class Radiance>
Image makeEquirectangular(int width, const Radiance& radiance) {
  Image image(width, width / 2);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < width; ++x)
      image(x, y) = radiance(directionAt((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                         (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height())));
  return image;
}

class EnvironmentFile : public ::testing::Test {
 protected:
  Environment load(const Image& image) {
    const std::string path = folder_.file("sky.exr");
    writeExr(path, image);
    return loadEnvironment(path, warnings_);
  }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

// A grid of directions that avoids the axes.
std::vector<glm::vec3> someDirections() {
  std::vector<glm::vec3> directions;
  for (float u = 0.013f; u < 1.0f; u += 0.091f)
    for (float v = 0.03f; v < 1.0f; v += 0.083f) directions.push_back(directionAt(u, v));
  return directions;
}

float maxDifference(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 d = glm::abs(a - b);
  return std::max({d.x, d.y, d.z});
}

TEST_F(EnvironmentFile, LinearInTheDirection_IsSeenInTheRightDirections) {
  const auto radiance = [](glm::vec3 d) { return glm::vec3(1.0f) + 0.9f * d; };
  const Environment environment = load(makeEquirectangular(512, radiance));
  EXPECT_THAT(warnings_, IsEmpty());
  // Two bilinear steps, each with an error of at most h^2/8 |f''| in each of two axes: h = 2 pi / 512 rad and
  // |f''| <= 0.9 make 6.8e-5 in all.
  for (const glm::vec3& d : someDirections())
    EXPECT_LT(maxDifference(environmentRadiance(environment, d), radiance(d)), 1e-4f);
}

TEST_F(EnvironmentFile, OneBrightTexel_IsSeenWhereItStands) {
  for (const auto& [x, y] : {std::pair(40, 20), std::pair(3, 9), std::pair(120, 50)}) {
    Image image(128, 64);
    image(x, y) = glm::vec3(100.0f);
    const Environment environment = load(image);
    const glm::vec3 towards =
        directionAt((static_cast<float>(x) + 0.5f) / 128.0f, (static_cast<float>(y) + 0.5f) / 64.0f);
    // The cube's texels lie up to a third of an image texel off, two thirds along u in the row nearest to the pole:
    // at least (1 - 0.32) (1 - 0.7) of the value is left by bilinear lookups.
    EXPECT_GT(environmentRadiance(environment, towards).x, 20.0f);
    for (const glm::vec3& d : someDirections())
      if (glm::dot(d, towards) < std::cos(4.0f * 2.0f * kPi / 128.0f)) {
        EXPECT_EQ(environmentRadiance(environment, d).x, 0.0f);
      }
  }
}

TEST_F(EnvironmentFile, ImageCentreIsMinusZ_AndTheRightHalfPlusX) {
  const Environment environment =
      load(makeEquirectangular(256, [](glm::vec3 d) { return glm::max(d, glm::vec3(0.0f)); }));
  EXPECT_NEAR(environmentRadiance(environment, {1, 0, 0}).x, 1.0f, 1e-3f);
  EXPECT_NEAR(environmentRadiance(environment, {0, 1, 0}).y, 1.0f, 1e-3f);
  EXPECT_NEAR(environmentRadiance(environment, {0, 0, 1}).z, 1.0f, 1e-3f);
  Image half(256, 128);
  for (int y = 0; y < 128; ++y)
    for (int x = 128; x < 256; ++x) half(x, y) = glm::vec3(1.0f);
  const Environment right = load(half);
  EXPECT_NEAR(environmentRadiance(right, {1, 0, 0}).x, 1.0f, 1e-6f);
  EXPECT_NEAR(environmentRadiance(right, {-1, 0, 0}).x, 0.0f, 1e-6f);
}

TEST_F(EnvironmentFile, FacesJoinWithoutSeams) {
  const auto radiance = [](glm::vec3 d) { return glm::vec3(2.0f) + glm::vec3(d.x * d.y, d.y * d.z, d.z * d.x); };
  const Environment environment = load(makeEquirectangular(256, radiance));
  for (float t = -0.99f; t < 1.0f; t += 0.07f) {
    // Both sides of the edge between +X and +Z, and of that between +Y and -Z.
    for (const auto& [a, b] : {std::pair(glm::vec3(1.0f, t, 0.9999f), glm::vec3(0.9999f, t, 1.0f)),
                               std::pair(glm::vec3(t, 1.0f, -0.9999f), glm::vec3(t, 0.9999f, -1.0f))})
      EXPECT_LT(maxDifference(environmentRadiance(environment, glm::normalize(a)),
                              environmentRadiance(environment, glm::normalize(b))),
                5e-4f);  // the directions are 1e-4 rad apart and the gradient is at most 1; twice that for rounding
  }
}

TEST(CubeFaces, CoarserThanTheImage_AverageIt) {
  ImageRgba stripes(128, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 128; x += 2) stripes(x, y) = glm::vec4(2.0f);
  const std::vector<ImageRgba> faces = cubeFacesOf(stripes, 8);
  // A face's texel covers some five columns; an odd one more or less shifts the mean by a fifth at most.
  for (const int side : {0, 1, 4, 5})
    for (const glm::vec4& p : faces[static_cast<std::size_t>(side)]) EXPECT_NEAR(p.x, 1.0f, 0.2f);
}

TEST_F(EnvironmentFile, BadValuesAreRepaired_WithWarnings) {
  Image image(8, 4, glm::vec3(1.0f));
  image(1, 1) = {std::numeric_limits<float>::infinity(), 1.0f, 1.0f};
  image(2, 1) = {std::nanf(""), -1.0f, 1.0f};
  const Environment environment = load(image);
  EXPECT_THAT(warnings_,
              ::testing::UnorderedElementsAre(HasSubstr("2 negative or NaN"), HasSubstr("1 values that are infinite")));
  for (const ImageRgba& face : environment.faces)
    for (const glm::vec4& p : face) {
      EXPECT_GE(p.x, 0.0f);
      EXPECT_LE(p.x, 1.0f);
    }
}

TEST(RepairRadiance, CutsTooBrightValuesToTheLargestOther) {
  ImageRgba image(2, 2, {0.5f, 1, 2, 0.25f});
  image(1, 0) = {1e30f, 7, 1e9f, 1};
  std::vector<std::string> warnings;
  repairRadiance(image, "sun", warnings);
  EXPECT_EQ(image(1, 0), glm::vec4(1e9f, 7, 1e9f, 1));
  EXPECT_EQ(image(0, 0), glm::vec4(0.5f, 1, 2, 1));
  EXPECT_THAT(warnings, ::testing::ElementsAre(HasSubstr("'sun': 1 values")));
}

TEST(RepairRadiance, OfNothingButInfinities_IsBlack) {
  ImageRgba image(2, 1, glm::vec4(std::numeric_limits<float>::infinity()));
  std::vector<std::string> warnings;
  repairRadiance(image, "sun", warnings);
  EXPECT_EQ(image(0, 0), glm::vec4(0, 0, 0, 1));
  EXPECT_THAT(warnings, ::testing::ElementsAre(HasSubstr("6 values")));
}

TEST_F(EnvironmentFile, ThatIsNotTwiceAsWideAsHigh_IsStretchedWithAWarning) {
  load(Image(8, 8, glm::vec3(1.0f)));
  EXPECT_THAT(warnings_, ::testing::ElementsAre(HasSubstr("8 x 8")));
}

TEST_F(EnvironmentFile, SixImages_AreTheFacesInGlOrder) {
  const char* names[] = {"px", "nx", "py", "ny", "pz", "nz"};
  for (int f = 0; f < 6; ++f)
    writeExr(folder_.file(std::string("face-") + names[f] + ".exr"), Image(4, 4, glm::vec3(static_cast<float>(f + 1))));
  const Environment environment = loadEnvironment(folder_.file("face-*.exr"), warnings_);
  EXPECT_EQ(environmentRadiance(environment, {1, 0, 0}).x, 1.0f);
  EXPECT_EQ(environmentRadiance(environment, {0, -1, 0}).x, 4.0f);
  EXPECT_EQ(environmentRadiance(environment, {0, 0, -1}).x, 6.0f);
}

TEST_F(EnvironmentFile, SixImagesOfUnequalSize_AreRefused) {
  for (const char* name : {"px", "nx", "py", "ny", "pz", "nz"})
    writeExr(folder_.file(std::string(name) + ".exr"), Image(name[0] == 'p' ? 4 : 8, 4));
  EXPECT_THROW(loadEnvironment(folder_.file("*.exr"), warnings_), Error);
}

TEST(ProjectAmbient, OfUniformRadiance_IsThatRadianceOnEverySide) {
  const shading::Ambient ambient = projectAmbient(std::vector<ImageRgba>(6, ImageRgba(8, 8, {0.3f, 2.0f, 5.0f, 1.0f})));
  for (const glm::vec3& n : someDirections())
    EXPECT_LT(maxDifference(shading::ambientRadiance(ambient, n), {0.3f, 2.0f, 5.0f}), 3e-6f);  // float rounding
}

// Of a grey environment, sampled at the texels of a cube of 64 x 64 texels a face.
shading::Ambient ambientOf(const std::function<float(const glm::vec3& direction)>& radiance) {
  std::vector<ImageRgba> faces(6, ImageRgba(64, 64));
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const glm::vec2 st = (2.0f * glm::vec2(x, y) + 1.0f) / 64.0f - 1.0f;
        faces[static_cast<std::size_t>(face)](x, y) =
            glm::vec4(radiance(glm::normalize(shading::cubeDirection(face, st))));
      }
  return projectAmbient(faces);
}

TEST(ProjectAmbient, OfRadianceLinearInTheDirection_IsTheClosedForm) {
  // Irradiance / pi of L = 1 + a.d on normal n: 1 + (2/3) a.n.
  const glm::vec3 a(0.5f, -0.3f, 0.2f);
  const shading::Ambient ambient = ambientOf([&](const glm::vec3& d) { return 1.0f + glm::dot(a, d); });
  // The midpoint rule's error falls with n^2; measured 2.4e-5 for 64 texels, four times that for 32.
  for (const glm::vec3& n : someDirections())
    EXPECT_NEAR(shading::ambientRadiance(ambient, n).x, 1.0f + 2.0f / 3.0f * glm::dot(a, n), 1e-4f);
}

TEST(ProjectAmbient, OfABandTwoHarmonic_IsAQuarterOfIt) {
  // A_2 / pi = 1/4 (Ramamoorthi and Hanrahan 2001, eq. 8), so L = 2 + xy + (3 z^2 - 1) gives 2 + (xy + 3 z^2 - 1) / 4.
  const shading::Ambient ambient =
      ambientOf([](const glm::vec3& d) { return 2.0f + d.x * d.y + 3.0f * d.z * d.z - 1.0f; });
  for (const glm::vec3& n : someDirections())
    EXPECT_NEAR(shading::ambientRadiance(ambient, n).x, 2.0f + 0.25f * (n.x * n.y + 3.0f * n.z * n.z - 1.0f), 3e-4f);
}

TEST(ConstantEnvironment, HasTheSameRadianceAndAmbientEverywhere) {
  std::vector<std::string> warnings;
  const Environment environment = loadEnvironment("constant?r=0.5&g=1&b=2", warnings);
  for (const glm::vec3& d : someDirections()) {
    EXPECT_EQ(environmentRadiance(environment, d), glm::vec3(0.5f, 1.0f, 2.0f));
    EXPECT_EQ(shading::ambientRadiance(environment.ambient, d), glm::vec3(0.5f, 1.0f, 2.0f));
  }
}

TEST(ProceduralSky, IsBrightestAtItsSun_AndLightsFromAbove) {
  const Environment sky = makeProceduralSky();
  const glm::vec3 sun(sky.sky.toGlow);
  for (const glm::vec3& d : someDirections()) EXPECT_LE(environmentRadiance(sky, d).x, environmentRadiance(sky, sun).x);
  EXPECT_GT(shading::ambientRadiance(sky.ambient, {0, 1, 0}).y, shading::ambientRadiance(sky.ambient, {0, -1, 0}).y);
}

TEST(LoadEnvironment, UnknownName_IsRefusedWithTheKnownOnes) {
  std::vector<std::string> warnings;
  try {
    loadEnvironment("skye", warnings);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Failure::input);
    EXPECT_THAT(e.what(), HasSubstr("sky, black, white"));
  }
}

}  // namespace
}  // namespace pb
