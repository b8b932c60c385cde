// Refraction in the rasteriser against closed forms and against the reference's pictures.
//
// Most scenes stand under a sky whose colour is the direction: 0.5 + 0.5 d. With a reflectance of 0 a pixel of glass
// then says in which direction its ray left.
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <string>

#include "raster/inward_distance.h"
#include "reference/renderer.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

constexpr int kSize = 64;  // samples of the pictures, along an edge

// Directions read from the sky: its faces are interpolated linearly between texels that are 1/64 apart on a face, so
// by h^2 / 8 = 3e-5 beside the sphere, which the normalisation takes away again; the rest are floats.
constexpr float kDirectionError = 1e-4f;
// The same through the cube map of a probe of 128 texels along an edge: halves between 0 and 1, 2^-12, in each of three
// channels that are scaled by 2, and as above.
constexpr float kMapDirectionError = 1.5e-3f;

const std::array kTechniques = {Refraction::oneInterface, Refraction::twoInterface, Refraction::cubemapBackface,
                                Refraction::thickSlab};

Environment makeDirectionSky() {
  constexpr int kFaceSize = 128;
  std::vector<ImageRgba> faces;
  for (int face = 0; face < 6; ++face) {
    ImageRgba image(kFaceSize, kFaceSize);
    for (int y = 0; y < kFaceSize; ++y)
      for (int x = 0; x < kFaceSize; ++x) {
        const glm::vec2 st = (2.0f * glm::vec2(x, y) + 1.0f) / static_cast<float>(kFaceSize) - 1.0f;
        image(x, y) = glm::vec4(0.5f + 0.5f * glm::normalize(shading::cubeDirection(face, st)), 1.0f);
      }
    faces.push_back(std::move(image));
  }
  return makeCubeEnvironment("directions", std::move(faces));
}

vec3 directionOf(vec3 color) { return glm::normalize(2.0f * color - 1.0f); }
float angle(vec3 a, vec3 b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

Scene makeSkyScene() {
  Scene scene;
  scene.environment = makeDirectionSky();
  addCamera(scene, "camera", vec3(0, 0, 3), vec3(0), 0.8f, 0.1f);
  return scene;
}

void addGlass(Scene& scene, Mesh mesh, const Material& material, Node node = {}) {
  addInstance(scene, "glass", finishMesh(std::move(mesh)), addMaterial(scene, material), std::move(node));
}

// Nothing is reflected: what is seen is refracted.
Technique withoutReflection(Refraction refraction, ProbeUse probes = ProbeUse::environmentOnly) {
  Technique technique;
  technique.resolution = 128;
  technique.refraction = refraction;
  technique.probes = probes;
  technique.fresnel = parseSpec("ratio?bias=0&scale=0");
  return technique;
}

vec3 rayOf(const Snapshot& snapshot, int x, int y) {
  const glm::vec2 st = (2.0f * glm::vec2(x, y) + 1.0f) / static_cast<float>(kSize) - 1.0f;
  return glm::normalize(shading::viewDirection(snapshot.camera, st));
}

float meanSquaredError(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(glm::dot(a[i] - b[i], a[i] - b[i])) / 3.0;
  return static_cast<float>(sum / static_cast<double>(a.size()));
}

// --- Distances through meshes ----------------------------------------------------------------------------------------

TEST(InwardDistance, OfABoxIsItsEdge) {
  const auto box = finishMesh(makeBoxMesh(vec3(1, 2, 3)));
  const std::vector<float> distances = inwardDistances(*box);
  for (std::size_t v = 0; v < distances.size(); ++v)
    EXPECT_NEAR(distances[v], std::abs(glm::dot(box->normals[v], vec3(1, 2, 3))), 1e-5f);
}

TEST(InwardDistance, OfASphereIsItsDiameter) {
  const auto sphere = finishMesh(makeSphereMesh(0.5f, 64, 32));
  // Chords of facets that span 2 pi / 64 end 1 - cos(pi / 64) = 1.2e-3 radii below the sphere on either side; corners
  // are moved 1 % into their triangles, whose normals they keep.
  const std::vector<float> distances = inwardDistances(*sphere);
  for (const std::uint32_t vertex : sphere->indices) EXPECT_NEAR(distances[vertex], 1.0f, 3e-3f);
}

TEST(InwardDistance, OfAnOpenMeshEndsAtItsBounds) {
  const auto quad = finishMesh(makeQuadMesh(vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)));
  for (const float distance : inwardDistances(*quad)) EXPECT_EQ(distance, 0.0f);
}

// --- Pictures --------------------------------------------------------------------------------------------------------

using RasterRefraction = RasterTest;
INSTANTIATE_TEST_SUITE_P(Gl, RasterRefraction, kBackends, nameOfBackend);

// The technique reflects nothing where light is refracted as well.
TEST_P(RasterRefraction, RatioInPlaceOfFresnelsLaw_LeavesMetalsAsTheyAre) {
  for (const Material& metal : {makeMirrorMaterial("mirror", vec3(0.9f, 0.5f, 0.1f)),
                                makeMetalMaterial("brushed", vec3(0.2f, 0.9f, 1.1f), vec3(3.9f, 2.4f, 2.3f), 0.4f)}) {
    const auto snapshot = snapshotOf(makeBall(kWhite, metal));
    Technique technique = withoutReflection(Refraction::oneInterface);
    const Image byRatio = render(*snapshot, technique);
    technique.fresnel = parseSpec("exact");
    EXPECT_EQ(byRatio, render(*snapshot, technique));
    EXPECT_GT(centreOf(byRatio).x, 0.5f);
  }
}

TEST_P(RasterRefraction, AnIndexOfOneShowsTheBackground) {
  const Image background = render(*snapshotOf(makeSkyScene()));
  Scene scene = makeSkyScene();
  addGlass(scene, makeSphereMesh(0.8f, 64, 32), makeGlassMaterial("clear", 1.0f));
  const auto snapshot = snapshotOf(std::move(scene));
  for (const Refraction refraction : kTechniques) {
    EXPECT_LT(largestDifference(render(*snapshot, withoutReflection(refraction)), background), kDirectionError);
    EXPECT_LT(largestDifference(render(*snapshot, withoutReflection(refraction, ProbeUse::dynamic)), background),
              kMapDirectionError);
  }
}

// Blended surfaces are collected with colour masked, over a part of the target: back faces are drawn in between.
TEST_P(RasterRefraction, OfTwoInterfacesHoldsForBlendedGlass) {
  const auto image = [&](float alphaMode) {
    Scene scene = makeSkyScene();
    Material material = makeGlassMaterial("half", 1.5f);
    material.constants.baseColor.w = 0.5f;
    material.constants.alpha.x = alphaMode;
    addGlass(scene, makeSphereMesh(0.8f, 64, 32), material);
    return render(*snapshotOf(std::move(scene)), withoutReflection(Refraction::twoInterface));
  };
  const Image background = render(*snapshotOf(makeSkyScene()));
  const Image opaque = image(shading::kAlphaOpaque), blended = image(shading::kAlphaBlend);
  EXPECT_GT(largestDifference(opaque, background), 0.1f);
  for (std::size_t i = 0; i < background.size(); ++i)
    EXPECT_LT(glm::distance(blended[i], 0.5f * (opaque[i] + background[i])), 1e-5f);
}

TEST_P(RasterRefraction, ThinWallsShowTheBackground) {
  const Image background = render(*snapshotOf(makeSkyScene()));
  Scene scene = makeSkyScene();
  addGlass(scene, makeSphereMesh(0.8f, 64, 32), makeGlassMaterial("bubble", 1.5f, 0.0f));
  const auto snapshot = snapshotOf(std::move(scene));
  for (const Refraction refraction : kTechniques)
    EXPECT_LT(largestDifference(render(*snapshot, withoutReflection(refraction)), background), kDirectionError);
}

// A slab turned by 40 degrees, which fills the picture.
std::shared_ptr<const Snapshot> snapshotOfSlab(float ior) {
  Scene scene = makeSkyScene();
  Node node;
  node.rotation = glm::angleAxis(glm::radians(40.0f), vec3(0, 1, 0));
  addGlass(scene, makeBoxMesh(vec3(20, 20, 0.5f)), makeGlassMaterial("slab", ior, 0.5f), node);
  return snapshotOf(std::move(scene));
}

float largestTurn(const Image& image, const Snapshot& snapshot) {
  float largest = 0.0f;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) largest = std::max(largest, angle(directionOf(image(x, y)), rayOf(snapshot, x, y)));
  return largest;
}

TEST_P(RasterRefraction, OfTwoInterfacesLeavesASlabsRaysParallel) {
  const auto slab = snapshotOfSlab(1.5f);
  std::array<double, kTechniques.size()> turns{};
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Image image = render(*slab, withoutReflection(kTechniques[i], ProbeUse::dynamic));
    turns[i] =
        static_cast<double>(glm::degrees(angle(directionOf(centreOf(image)), rayOf(*slab, kSize / 2, kSize / 2))));
  }
  std::printf(
      "slab of index 1.5 at 40 degrees, ray turned by: one-interface %.2f, two-interface %.2f, "
      "cubemap-backface %.2f, thick-slab %.2f degrees\n",
      turns[0], turns[1], turns[2], turns[3]);
  EXPECT_LT(largestTurn(render(*slab, withoutReflection(Refraction::twoInterface)), *slab), kDirectionError);
}

TEST_P(RasterRefraction, OfOneInterfaceTurnsASlabsRays) {
  const auto slab = snapshotOfSlab(1.5f);
  const Image image = render(*slab, withoutReflection(Refraction::oneInterface));
  const vec3 d = rayOf(*slab, kSize / 2, kSize / 2);
  const vec3 normal = glm::angleAxis(glm::radians(40.0f), vec3(0, 1, 0)) * vec3(0, 0, 1);
  EXPECT_LT(angle(directionOf(centreOf(image)), shading::refractedDirection(d, normal, 1.5f)), kDirectionError);
  EXPECT_GT(angle(directionOf(centreOf(image)), d), glm::radians(10.0f));  // 40 degrees - asin(sin(40 degrees) / 1.5)
}

TEST_P(RasterRefraction, OfAThickSlabLooksThroughTheRefractedRaysEnd) {
  const auto slab = snapshotOfSlab(1.5f);
  const Image image = render(*slab, withoutReflection(Refraction::thickSlab));
  const vec3 d = rayOf(*slab, kSize / 2, kSize / 2);
  const vec3 normal = glm::angleAxis(glm::radians(40.0f), vec3(0, 1, 0)) * vec3(0, 0, 1);
  // The viewer is 3 m from the slab's middle; its front is 0.25 m nearer along the normal.
  const vec3 eye(snapshotOfSlab(1.5f)->camera.origin);
  const vec3 front = eye + d * ((glm::dot(eye, normal) - 0.25f) / -glm::dot(d, normal));
  const vec3 exit = front + shading::slabExitOffset(d, normal, 1.5f, 0.5f);
  EXPECT_LT(angle(directionOf(centreOf(image)), exit - eye), kDirectionError);
}

// Where a ball of radius 1 around the origin sends the ray that meets it first at p: refracted twice.
vec3 throughBall(vec3 d, vec3 p, float ior) {
  const vec3 inside = shading::refractedDirection(d, p, ior);
  const vec3 exit = p - 2.0f * glm::dot(inside, p) * inside;
  return shading::refractedDirection(inside, -exit, 1.0f / ior);
}

struct BallErrors {
  float mean = 0.0f;  // radians
  int pixels = 0;
};

// Within 0.9 radii of the ball's centre as the viewer sees it, so that no facet of the silhouette counts.
BallErrors ballErrors(const Image& image, const Snapshot& snapshot, float ior) {
  BallErrors errors;
  const vec3 eye(snapshot.camera.origin);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const vec3 d = rayOf(snapshot, x, y);
      const float nearest = -glm::dot(eye, d);
      const float missSquared = glm::dot(eye, eye) - nearest * nearest;
      if (missSquared > 0.81f) continue;
      const vec3 p = eye + (nearest - std::sqrt(1.0f - missSquared)) * d;
      errors.mean += angle(directionOf(image(x, y)), throughBall(d, p, ior));
      ++errors.pixels;
    }
  errors.mean /= static_cast<float>(errors.pixels);
  return errors;
}

std::shared_ptr<const Snapshot> snapshotOfBall(float ior) {
  Scene scene = makeSkyScene();
  scene.nodes.front().translation.z = 4.0f;
  addGlass(scene, makeSphereMesh(1.0f, 256, 128), makeGlassMaterial("ball", ior, 2.0f));
  return snapshotOf(std::move(scene));
}

TEST_P(RasterRefraction, OfTwoInterfacesIsTheNearestToABallsClosedForm) {
  std::array<float, kTechniques.size()> errors{};
  const auto ball = snapshotOfBall(1.5f);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const BallErrors e = ballErrors(render(*ball, withoutReflection(kTechniques[i])), *ball, 1.5f);
    ASSERT_GT(e.pixels, 500);
    errors[i] = glm::degrees(e.mean);
  }
  std::printf(
      "ball of index 1.5, mean angle to the closed form: one-interface %.2f, two-interface %.2f, "
      "thick-slab %.2f degrees\n",
      static_cast<double>(errors[0]), static_cast<double>(errors[1]), static_cast<double>(errors[3]));
  EXPECT_LT(errors[1], 0.25f * errors[0]);
  EXPECT_LT(errors[1], 0.25f * errors[3]);
}

// The probe stands in the ball's centre, which rays leave at right angles.
TEST_P(RasterRefraction, OfACubeMapOfBackFacesIsOfOneInterfaceForABall) {
  const auto ball = snapshotOfBall(1.5f);
  EXPECT_LT(largestDifference(render(*ball, withoutReflection(Refraction::cubemapBackface, ProbeUse::dynamic)),
                              render(*ball, withoutReflection(Refraction::oneInterface, ProbeUse::dynamic))),
            0.03f);
}

TEST_P(RasterRefraction, OfACubeMapOfBackFacesSeesThroughThemFromTheProbe) {
  Scene scene = makeSkyScene();
  addGlass(scene, makeBoxMesh(vec3(1.0f)), makeGlassMaterial("cube", 1.5f));
  const auto cube = snapshotOf(std::move(scene));
  RasterSequence sequence(device(), withoutReflection(Refraction::cubemapBackface, ProbeUse::dynamic), kSize, kSize, 1);
  sequence.renderFrame(*cube);
  const Image front = sequence.readProbe(0)[4];  // towards +Z
  const vec3 d = glm::normalize(shading::cubeDirection(4, glm::vec2(1.0f / 128.0f + 0.5f, 1.0f / 128.0f)));
  EXPECT_LT(angle(directionOf(front(96, 64)), shading::refractedDirection(d, vec3(0, 0, -1), 1.0f / 1.5f)),
            kMapDirectionError);
}

// A ray that enters the front of a cube of index 1.5 never leaves by its side: it is bent to less than 42 degrees off
// the front's normal, more than 48 off the side's, whose critical angle is 42.
TEST_P(RasterRefraction, OfTwoInterfacesShowsTheDirectionOfTotalInternalReflection) {
  Scene scene = makeSkyScene();
  addGlass(scene, makeBoxMesh(vec3(1.0f)), makeGlassMaterial("cube", 1.5f));
  scene.nodes.front().translation = vec3(-1.5f, 0, 3);
  scene.nodes.front().rotation = glm::angleAxis(-std::atan(0.5f), vec3(0, 1, 0));
  const auto cube = snapshotOf(std::move(scene));
  const Image image = render(*cube, withoutReflection(Refraction::twoInterface));
  const vec3 eye(cube->camera.origin);
  int pixels = 0;
  for (int x = 0; x < kSize; ++x) {
    const vec3 d = rayOf(*cube, x, kSize / 2);
    const vec3 p = eye + d * ((0.5f - eye.z) / d.z);
    if (p.x < 0.4f || p.x > 0.47f) continue;  // on the front, beside the side's edge
    const vec3 inside = shading::refractedDirection(d, vec3(0, 0, 1), 1.5f);
    EXPECT_LT(angle(directionOf(image(x, kSize / 2)), inside * vec3(-1, 1, 1)), kDirectionError) << x;
    ++pixels;
  }
  EXPECT_GE(pixels, 2);
}

TEST_P(RasterRefraction, AbsorbsOverTheMaterialsThicknessOrOverTheWayThatIsSeen) {
  for (const Refraction refraction : kTechniques) {
    Scene scene = makeSkyScene();
    Material material = makeGlassMaterial("absorbing", 1.5f, 0.25f);
    setAttenuation(material, vec3(0.5f), 1.0f);
    Node node;
    node.scale = vec3(2.0f);  // thickness is in the mesh's units
    addGlass(scene, makeBoxMesh(vec3(1, 1, 0.5f)), material, node);
    const auto snapshot = snapshotOf(std::move(scene));
    const vec3 seen = centreOf(render(*snapshot, withoutReflection(refraction)));
    // Straight through the middle: 1 m of glass, the material says 0.5 m.
    const float expected = refraction == Refraction::twoInterface ? 0.5f : std::sqrt(0.5f);
    EXPECT_NEAR(seen.y / 0.5f, expected, 1e-2f);  // of the sky at the horizon; the middle lies between pixels
  }
}

TEST_P(RasterRefraction, TintsAtEachInterfaceThatIsCrossed) {
  for (const Refraction refraction : {Refraction::oneInterface, Refraction::twoInterface}) {
    Scene scene = makeEmptyScene(kWhite);
    Material material = makeGlassMaterial("tinted", 1.5f);
    material.constants.baseColor = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
    addGlass(scene, makeBoxMesh(vec3(1.0f)), material);
    const Image image = render(*snapshotOf(std::move(scene)), withoutReflection(refraction));
    EXPECT_NEAR(centreOf(image).x, refraction == Refraction::twoInterface ? 0.25f : 0.5f, 1e-5f);
  }
}

TEST_P(RasterRefraction, OfTwoInterfacesKeepsUniformLight) {
  Technique technique;
  technique.resolution = 32;
  technique.refraction = Refraction::twoInterface;
  Scene scene = makeEmptyScene(kWhite);
  addGlass(scene, makeTorusMesh(0.6f, 0.25f, 64, 32), makeGlassMaterial("torus", 1.5f));
  const Image image = render(*snapshotOf(std::move(scene)), technique);
  for (const vec3& color : image) EXPECT_NEAR(color.x, 1.0f, 1e-3f);  // a half's 2^-11, twice
}

TEST_P(RasterRefraction, OfTwoInterfacesDoesNotSeeOtherObjectsBackFaces) {
  const auto image = [&](bool withSecond) {
    Scene scene = makeSkyScene();
    addGlass(scene, makeSphereMesh(0.5f, 64, 32), makeGlassMaterial("near", 1.5f));
    Node behind;
    behind.translation.z = -3.0f;
    if (withSecond) addGlass(scene, makeBoxMesh(vec3(0.8f)), makeGlassMaterial("far", 1.5f), behind);
    return render(*snapshotOf(std::move(scene)), withoutReflection(Refraction::twoInterface));
  };
  EXPECT_EQ(image(false), image(true));  // the ball hides the box
}

TEST_P(RasterRefraction, FromInsideIsOfOneInterfaceWhateverTheTechnique) {
  Scene scene = makeSkyScene();
  addGlass(scene, makeBoxMesh(vec3(8.0f)), makeGlassMaterial("around", 1.5f));
  const auto inside = snapshotOf(std::move(scene));
  const Image image = render(*inside, withoutReflection(Refraction::oneInterface));
  EXPECT_LT(angle(directionOf(image(20, 32)),
                  shading::refractedDirection(rayOf(*inside, 20, 32), vec3(0, 0, 1), 1.0f / 1.5f)),
            kDirectionError);
  for (const Refraction refraction : kTechniques) EXPECT_EQ(render(*inside, withoutReflection(refraction)), image);
}

TEST_P(RasterRefraction, OnlyGlassOfTwoInterfacesDrawsBackFaces) {
  const auto countersOf = [&](Refraction refraction, float thickness) {
    Scene scene = makeSkyScene();
    addBox(scene, vec3(0, 0, -3), vec3(0.2f), makeDiffuseMaterial("grey", vec3(0.5f)));
    addGlass(scene, makeBoxMesh(vec3(0.3f)), makeGlassMaterial("cube", 1.5f, thickness));
    RasterSequence sequence(device(), withoutReflection(refraction), kSize, kSize, 1);
    return sequence.renderFrame(*snapshotOf(std::move(scene))).counters;
  };
  const FrameCounters one = countersOf(Refraction::oneInterface, 0.3f);
  const FrameCounters two = countersOf(Refraction::twoInterface, 0.3f);
  EXPECT_EQ(two.draws, one.draws + 1);
  EXPECT_EQ(two.triangles, one.triangles + 12);
  EXPECT_EQ(countersOf(Refraction::twoInterface, 0.0f), countersOf(Refraction::oneInterface, 0.0f));
}

// --- Against the reference -------------------------------------------------------------------------------------------

ReferenceSettings converged() {
  ReferenceSettings settings;
  settings.samplesPerAxis = 2;
  settings.spp = 8;
  return settings;
}

TEST_P(RasterRefraction, OfTwoInterfacesIsNearerToTheReferencesBallThanOfOne) {
  const auto ball = snapshotOfBall(1.5f);
  const Image truth = ReferenceScene(ball).render(ball->camera, kSize, kSize, converged()).mean();
  std::array<float, kTechniques.size()> errors{};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    Technique technique;
    technique.resolution = 128;
    technique.refraction = kTechniques[i];
    errors[i] = meanSquaredError(render(*ball, technique, kSize, kSize, 2), truth);
  }
  std::printf(
      "ball of index 1.5, MSE: one-interface %.2e, two-interface %.2e, cubemap-backface %.2e, thick-slab %.2e\n",
      static_cast<double>(errors[0]), static_cast<double>(errors[1]), static_cast<double>(errors[2]),
      static_cast<double>(errors[3]));
  // Measured: 0.50, 0.61 and 0.24. What is left is the rim, where the way inside is estimated too short, and light that
  // is reflected inside of the ball.
  for (const std::size_t other : {0u, 2u, 3u}) EXPECT_LT(errors[1], 0.75f * errors[other]) << other;
}

// What a mirror will show: the ball through a face of the mirror's cube map.
TEST_P(RasterRefraction, OfTwoInterfacesHoldsInCaptures) {
  Scene scene = makeSkyScene();
  Node left;
  left.translation.x = -4.0f;
  addInstance(scene, "mirror", finishMesh(makeSphereMesh(0.5f, 32, 16)),
              addMaterial(scene, makeMirrorMaterial("mirror")), left);
  addGlass(scene, makeSphereMesh(1.5f, 128, 64), makeGlassMaterial("ball", 1.5f, 3.0f));
  const auto snapshot = snapshotOf(std::move(scene));
  ReferenceSettings settings = converged();
  settings.hiddenInstances = {0};
  const Probe& probe = snapshot->probes[0];
  const Image truth =
      ReferenceScene(snapshot).render(cubeFaceView(probe.position, 0, probe.zNear), kSize, kSize, settings).mean();
  const auto errorOf = [&](Refraction refraction) {
    Technique technique;
    technique.resolution = kSize;
    technique.refraction = refraction;
    RasterSequence sequence(device(), technique, 8, 8, 1);
    sequence.renderFrame(*snapshot);
    return meanSquaredError(sequence.readProbe(0)[0], truth);
  };
  // Measured: 0.62, with a larger part of the rim in the picture than from the camera of the test above.
  EXPECT_LT(errorOf(Refraction::twoInterface), 0.8f * errorOf(Refraction::oneInterface));
}

}  // namespace
}  // namespace pb
