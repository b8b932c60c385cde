// Oracle probes against closed forms and against rasterised captures.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "reference/probe.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

constexpr int kResolution = 32;

ReferenceSettings oneRayATexel() {
  ReferenceSettings settings;
  settings.samplesPerAxis = 1;
  settings.spp = 2;
  return settings;
}

std::array<Image, 6> trace(const std::shared_ptr<const Snapshot>& snapshot, const Probe& probe,
                           int resolution = kResolution, const ReferenceSettings& settings = oneRayATexel()) {
  return traceProbe(ReferenceScene(snapshot), probe, resolution, settings);
}

// Directions of the texels, transcribed from OpenGL 4.5 core, table 8.19, and kept apart from
// scenes/shading/cubemap.glsl: for face +X, sc = -rz and tc = -ry, and so on.
glm::vec3 specifiedDirection(int face, float sc, float tc) {
  const std::array<glm::vec3, 6> directions = {
      {{1.0f, -tc, -sc}, {-1.0f, -tc, sc}, {sc, 1.0f, tc}, {sc, -1.0f, -tc}, {sc, -tc, 1.0f}, {-sc, -tc, -1.0f}}};
  return directions[static_cast<std::size_t>(face)];
}

template <class Check>  // (face, x, y, direction)
void forEachTexel(int resolution, const Check& check) {
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < resolution; ++y)
      for (int x = 0; x < resolution; ++x) {
        const float n = static_cast<float>(resolution);
        const float sc = (2.0f * static_cast<float>(x) + 1.0f) / n - 1.0f;
        const float tc = (2.0f * static_cast<float>(y) + 1.0f) / n - 1.0f;
        check(static_cast<std::size_t>(face), x, y, specifiedDirection(face, sc, tc));
      }
}

TEST(OracleProbe, AloneUnderTheSkyHoldsTheSkyExactly) {
  Scene scene = makeBall(glm::vec3(0.0f), makeMirrorMaterial("mirror"));
  scene.environment = makeProceduralSky();
  const auto snapshot = snapshotOf(std::move(scene));
  const std::array<Image, 6> faces = trace(snapshot, snapshot->probes.front());
  forEachTexel(kResolution, [&](std::size_t face, int x, int y, const glm::vec3& d) {
    const glm::vec3 expected = environmentRadiance(snapshot->environment(), glm::normalize(d));
    // Directions differ in their last bit at most, which the sun's glow magnifies to a few 1e-6 of its value.
    const glm::vec3 difference = glm::abs(faces[face](x, y) - expected);
    ASSERT_LE(std::max({difference.x, difference.y, difference.z}), 1e-5f * (1.0f + expected.x)) << face << x << y;
  });
}

// A box seen from inside, its points coloured 0.5 + position / 4 m.
Scene makeRoom() {
  Scene scene = makeEmptyScene(kBlack);
  Material wall = makeUnlit(kWhite);
  wall.doubleSided = true;
  Mesh mesh = makeBoxMesh(glm::vec3(4.0f));
  for (const glm::vec3& p : mesh.positions) mesh.colors.emplace_back(0.5f + 0.25f * p, 1.0f);
  addInstance(scene, "room", finishMesh(std::move(mesh)), addMaterial(scene, wall));
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.1f, 16, 8)), addMaterial(scene, makeMirrorMaterial("mirror")));
  return scene;
}

TEST(OracleProbe, FacesLieAsOpenGlHasThem) {
  const auto snapshot = snapshotOf(makeRoom());
  const std::array<Image, 6> faces = trace(snapshot, snapshot->probes.front());
  forEachTexel(kResolution, [&](std::size_t face, int x, int y, const glm::vec3& d) {
    const glm::vec3 difference = glm::abs(faces[face](x, y) - (0.5f + 0.5f * d));
    // Vertices' colours interpolated in float.
    ASSERT_LE(std::max({difference.x, difference.y, difference.z}), 4e-6f) << face << ' ' << x << ' ' << y;
  });
}

TEST(OracleProbe, DistancesAreThoseAlongTheAxis) {
  const auto snapshot = snapshotOf(makeRoom());
  const auto distances = traceProbeDistances(ReferenceScene(snapshot), snapshot->probes.front(), kResolution);
  forEachTexel(kResolution, [&](std::size_t face, int x, int y, const glm::vec3&) {
    ASSERT_NEAR(distances[face](x, y), 2.0f, 1e-5f) << face << ' ' << x << ' ' << y;
  });
}

// An emitting ball around the probe, 2 m before a mirror of reflectance 0.5.
TEST(OracleProbe, OwnerIsHiddenFromTheProbeButNotFromTheMirrorsThatItSees) {
  Scene scene = makeEmptyScene(kBlack);
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.3f, 32, 16)), addMaterial(scene, makeUnlit(kWhite)));
  addInstance(scene, "mirror", finishMesh(makeQuadMesh({2, -1, -1}, {0, 0, 2}, {0, 2, 0})),
              addMaterial(scene, makeMirrorMaterial("mirror", glm::vec3(0.5f))));
  const auto snapshot = snapshotOf(std::move(scene));
  const Probe probe{.position = glm::vec3(0.0f), .owners = {0}, .zNear = 0.01f};
  const std::array<Image, 6> faces = trace(snapshot, probe, 33);
  const auto near = [](float value) { return glm::vec3(value); };
  EXPECT_LT(glm::distance(faces[0](16, 16), near(0.5f)), 1e-5f) << "the ball's image in the mirror";
  EXPECT_EQ(faces[1](16, 16), kBlack) << "the ball itself";
}

TEST(OracleProbe, DepthCountsTheHitsOfTheProbesOwnRays) {
  Scene scene = makeEmptyScene(glm::vec3(1.0f));
  // Facing mirrors of reflectance 0.5 at x = 2 and x = -2 under a white sky: after one hit the sky is seen.
  const int mirror = addMaterial(scene, makeMirrorMaterial("mirror", glm::vec3(0.5f)));
  addInstance(scene, "right", finishMesh(makeQuadMesh({2, -9, -9}, {0, 0, 18}, {0, 18, 0})), mirror);
  addInstance(scene, "left", finishMesh(makeQuadMesh({-2, -9, 9}, {0, 0, -18}, {0, 18, 0})), mirror);
  const auto snapshot = snapshotOf(std::move(scene));
  const Probe probe{.position = glm::vec3(0.0f), .owners = {}, .zNear = 0.01f};
  for (int depth = 1; depth <= 3; ++depth) {
    ReferenceSettings settings = oneRayATexel();
    settings.depth = depth;
    EXPECT_NEAR(trace(snapshot, probe, 33, settings)[0](16, 16).x, std::pow(0.5f, static_cast<float>(depth)), 1e-6f);
  }
}

TEST(OracleProbe, IsTheSameForAnyNumberOfThreads) {
  const auto snapshot = snapshotOf("metals");
  const std::array<Image, 6> faces = trace(snapshot, snapshot->probes.front(), 16);
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(trace(snapshot, snapshot->probes.front(), 16), faces);
}

class OracleProbeInRaster : public RasterTest {};
INSTANTIATE_TEST_SUITE_P(Backends, OracleProbeInRaster, kBackends, nameOfBackend);

// One mirror ball among diffuse things: nothing that its capture shows is approximated.
TEST_P(OracleProbeInRaster, RasterCaptureOfADiffuseSceneHoldsTheSameTexels) {
  const int resolution = 64;
  const auto snapshot = snapshotOf("mirrors?count=1");
  RasterSequence sequence(device(), withResolution(resolution), 16, 16, 1);
  sequence.renderFrame(*snapshot);
  const std::array<Image, 6> captured = sequence.readProbe(0);
  const std::array<Image, 6> traced = trace(snapshot, snapshot->probes.front(), resolution);
  int others = 0;
  forEachTexel(resolution, [&](std::size_t face, int x, int y, const glm::vec3&) {
    // Half floats round by 2^-11 of a value.
    const glm::vec3 bound = 2e-3f * (glm::abs(traced[face](x, y)) + 1e-3f);
    const glm::vec3 difference = glm::abs(captured[face](x, y) - traced[face](x, y));
    if (glm::any(glm::greaterThan(difference, bound))) ++others;
  });
  // Texels whose centre lies on an edge, of an object or, on the faces' diagonals, of the floor's tiles, which have no
  // filter: 54 of 24576.
  EXPECT_LE(others, 6 * resolution * resolution / 300);
}

}  // namespace
}  // namespace pb
