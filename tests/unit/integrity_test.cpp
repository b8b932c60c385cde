// Integrity of cube maps: pure functions, and the meter on captures with planted faults.
#include "bench/integrity.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "raster/fault.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

// Each texel shows its direction.
CubeFaces directionFaces(int n) {
  CubeFaces faces;
  for (int face = 0; face < 6; ++face) {
    Image image(n, n);
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const glm::vec2 st = (2.0f * glm::vec2(x, y) + 1.0f) / static_cast<float>(n) - 1.0f;
        image(x, y) = 0.5f + 0.5f * glm::normalize(shading::cubeDirection(face, st));
      }
    faces[static_cast<std::size_t>(face)] = image;
  }
  return faces;
}

Image mirrored(const Image& image) {
  Image result = image;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) result(x, y) = image(image.width() - 1 - x, y);
  return result;
}

TEST(EdgeStepRatio, OfSmoothDirectionsIsNearOne) {
  for (const int n : {2, 4, 16, 64}) EXPECT_NEAR(edgeStepRatio(directionFaces(n)), 1.0, 0.35) << n;
}

TEST(EdgeStepRatio, GrowsWithASwapAMirroringAndAnotherExposure) {
  const CubeFaces faces = directionFaces(32);
  const double intact = edgeStepRatio(faces);
  CubeFaces swapped = faces;
  std::swap(swapped[0], swapped[1]);
  EXPECT_GT(edgeStepRatio(swapped), 5.0 * intact);
  CubeFaces flipped = faces;
  flipped[3] = mirrored(flipped[3]);
  EXPECT_GT(edgeStepRatio(flipped), 2.0 * intact);
  CubeFaces dimmed = faces;
  for (glm::vec3& texel : dimmed[2]) texel *= 0.9f;
  EXPECT_GT(edgeStepRatio(dimmed), 1.1 * intact);
}

TEST(EdgeStepRatio, OfAUniformMapIsOne) {
  CubeFaces faces;
  faces.fill(Image(8, 8, glm::vec3(0.5f)));
  EXPECT_EQ(edgeStepRatio(faces), 1.0);
}

TEST(MisplacedFaces, AreCounted) {
  const CubeFaces faces = directionFaces(32), expected = directionFaces(16);
  EXPECT_EQ(misplacedFaces(faces, expected), 0);
  CubeFaces swapped = faces;
  std::swap(swapped[0], swapped[4]);
  EXPECT_EQ(misplacedFaces(swapped, expected), 2);
  CubeFaces flipped = faces;
  flipped[3] = mirrored(flipped[3]);
  EXPECT_EQ(misplacedFaces(flipped, expected), 1);
}

TEST(MisplacedFaces, AnotherBrightnessDoesNotMakeThem) {
  CubeFaces brighter = directionFaces(8);
  for (Image& face : brighter)
    for (glm::vec3& texel : face) texel *= 1.3f;
  EXPECT_EQ(misplacedFaces(brighter, directionFaces(16)), 0);
}

TEST(MeanRadiance, WeighsTexelsByTheirSolidAngle) {
  CubeFaces faces;
  faces.fill(Image(16, 16, glm::vec3(1.0f, 2.0f, 3.0f)));
  EXPECT_NEAR(meanRadiance(faces, texelSolidAngles(16)), 2.0, 1e-5);
  // Of the squared cosine to +X the mean over the sphere is 1/3; the midpoint rule errs by less than 1/n^2.
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const glm::vec2 st = (2.0f * glm::vec2(x, y) + 1.0f) / 16.0f - 1.0f;
        const float c = glm::normalize(shading::cubeDirection(face, st)).x;
        faces[static_cast<std::size_t>(face)](x, y) = glm::vec3(c * c);
      }
  EXPECT_NEAR(meanRadiance(faces, texelSolidAngles(16)), 1.0 / 3.0, 1.0 / 256.0);
}

TEST(SolidAngles, SumToTheSphereAtEveryResolution) {
  // Differences of angles near 1 in float, 6e-8 each, of texels of which there are n^2.
  for (int n = 1; n <= 256; n *= 2) EXPECT_LT(solidAngleError(texelSolidAngles(n)), 1e-7 * (1 + n * n)) << n;
}

class IntegrityOfCaptures : public RasterTest {
 protected:
  MetricValues measure(const std::string& scene, const Technique& technique, const Fault& fault = {}) {
    const auto snapshot = snapshotOf(scene);
    plantFault(device(), fault);
    RasterSequence sequence(device(), technique, 64, 36, 1);
    sequence.renderFrame(*snapshot);
    const MetricValues values = IntegrityMeter().measure(sequence, technique, snapshot, 36);
    plantFault(device(), {});
    return values;
  }
  static double valueOf(const MetricValues& values, const std::string& name) {
    const auto found = std::ranges::find(values, name, &std::pair<std::string, double>::first);
    return found == values.end() ? std::nan("") : found->second;
  }
};
INSTANTIATE_TEST_SUITE_P(Backends, IntegrityOfCaptures, kBackends, nameOfBackend);

TEST_P(IntegrityOfCaptures, IntactMapsHaveNoMisplacedFace) {
  for (const char* scene : {"mirrors?count=2", "metals?grid=2", "mirror-room", "teapot"})
    EXPECT_EQ(valueOf(measure(scene, withResolution(64)), "misplaced_faces"), 0.0) << scene;
}

TEST_P(IntegrityOfCaptures, StepsAcrossEdgesAreThoseInsideOnEveryLevel) {
  const MetricValues values = measure("metals?grid=2", withResolution(64));
  for (int level = 0; level <= 3; ++level)
    EXPECT_NEAR(valueOf(values, fmt::format("edge_step_mip{}", level)), 1.0, 0.25) << level;
}

// The matte teapot passes the +X side at some time.
TEST_P(IntegrityOfCaptures, AStaleFaceShowsInItsEdgesOrItsEnergy) {
  const auto measureLater = [&](int frame, const Fault& fault) {
    const auto first = snapshotOf("teapot"), later = snapshotOf("teapot", frame);
    plantFault(device(), fault);
    RasterSequence sequence(device(), withResolution(64), 64, 36, 1);
    sequence.renderFrame(*first);
    sequence.renderFrame(*later);
    plantFault(device(), {});
    return IntegrityMeter().measure(sequence, withResolution(64), later, 36);
  };
  int different = 0;
  for (const int frame : {20, 40, 60, 80, 100})
    different += measureLater(frame, {FaultKind::staleFace}) != measureLater(frame, {}) ? 1 : 0;
  EXPECT_GE(different, 1);
}

TEST_P(IntegrityOfCaptures, SwappedFacesAreSeenWithoutAView) {
  const MetricValues values = measure("mirrors?count=2", withResolution(64), {FaultKind::swappedFaces});
  EXPECT_GE(valueOf(values, "misplaced_faces"), 2.0);
}

TEST_P(IntegrityOfCaptures, OnePercentOfEnergyIsSeen) {
  const double before = valueOf(measure("mirrors?count=2", withResolution(64)), "radiance_mip0");
  const double after =
      valueOf(measure("mirrors?count=2", withResolution(64), {FaultKind::energy, 1.01}), "radiance_mip0");
  EXPECT_NEAR(after / before, 1.01, 1e-3);
}

TEST_P(IntegrityOfCaptures, FiltersKeepTheEnergyOfEveryLevel) {
  Technique technique = withResolution(64);
  technique.filter = ProbeFilter::ggxPrefiltered;
  const MetricValues values = measure("metals?grid=2", technique);
  const double level0 = valueOf(values, "radiance_mip0");
  ASSERT_FALSE(std::isnan(valueOf(values, "radiance_mip3")));
  for (int level = 1; level <= 3; ++level)
    EXPECT_NEAR(valueOf(values, fmt::format("radiance_mip{}", level)) / level0, 1.0, 0.02) << level;
}

}  // namespace
}  // namespace pb
