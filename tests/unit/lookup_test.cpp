// Lookups against closed forms and against the reference's pictures.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "raster/lookup.h"
#include "raster/planar.h"
#include "raster/proxy.h"
#include "raster/reflection.h"
#include "reference/renderer.h"
#include "tests/error_message.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec2;
using glm::vec3;

// --- Pure functions --------------------------------------------------------------------------------------------------

class Random {
 public:
  float in(float lower, float upper) { return std::uniform_real_distribution<float>(lower, upper)(engine_); }
  vec3 in(vec3 lower, vec3 upper) { return {in(lower.x, upper.x), in(lower.y, upper.y), in(lower.z, upper.z)}; }
  vec3 direction() {
    vec3 d(0.0f);
    while (glm::length(d) < 0.1f || glm::length(d) > 1.0f) d = in(vec3(-1.0f), vec3(1.0f));
    return glm::normalize(d);
  }

 private:
  std::mt19937 engine_{5};
};

// Positions are sums of a few numbers below 10 with rounding of 6e-8 each; along grazing rays a wall's distance divides
// by small components.
constexpr float kRounding = 1e-4f;

TEST(BoxProxy, PointInABoxRoomSeesExactlyTheWallPoint) {
  Random random;
  const vec3 lower(-3.0f, 0.0f, -2.0f), upper(4.0f, 3.0f, 5.0f);
  for (int i = 0; i < 1000; ++i) {
    const vec3 from = random.in(lower, upper), probe = random.in(lower, upper), d = random.direction();
    const vec3 hit = probe + shading::boxProxyDirection(from, d, lower, upper, probe);
    const vec3 inwards = glm::min(hit - lower, upper - hit);
    EXPECT_NEAR(std::min({inwards.x, inwards.y, inwards.z}), 0.0f, kRounding) << "on a wall, inside of the others";
    EXPECT_LT(glm::length(glm::cross(hit - from, d)), kRounding);
    EXPECT_GT(glm::dot(hit - from, d), 0.0f);
  }
}

TEST(BoxProxy, FromOutsideARayThatLeavesKeepsItsDirection) {
  const vec3 d(1.0f, 0.0f, 0.0f);
  EXPECT_EQ(shading::boxProxyDirection({5, 0, 0}, d, vec3(-1), vec3(1), vec3(0)), d);
}

TEST(SphereProxy, PointInsideSeesExactlyTheSpherePoint) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const vec3 from = 1.4f * random.direction() * random.in(0.0f, 1.0f), d = random.direction();
    const vec3 hit = shading::sphereProxyDirection(from, d, 1.5f);
    EXPECT_NEAR(glm::length(hit), 1.5f, kRounding);
    EXPECT_LT(glm::length(glm::cross(hit - from, d)), kRounding);
    EXPECT_GT(glm::dot(hit - from, d), 0.0f);
  }
}

TEST(SphereProxy, FromOutsideRaysThatMissKeepTheirDirection) {
  EXPECT_EQ(shading::sphereProxyDirection({3, 0, 0}, {0, 1, 0}, 1.0f), vec3(0, 1, 0));
  EXPECT_EQ(shading::sphereProxyDirection({3, 0, 0}, {1, 0, 0}, 1.0f), vec3(1, 0, 0));
  EXPECT_NEAR(glm::length(shading::sphereProxyDirection({3, 0, 0}, {-1, 0, 0}, 1.0f)), 1.0f, kRounding);
}

// Reciprocal depth, along the axis of a direction's face, of a plane normal . p = offset.
float reciprocalDepth(vec3 direction, vec3 normal, float offset) {
  const vec3 a = glm::abs(direction);
  return std::max(glm::dot(normal, direction) / (offset * std::max({a.x, a.y, a.z})), 0.0f);
}

TEST(DistanceImpostor, OneSecantStepFindsAPlane) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const vec3 normal = random.direction(), from = random.in(vec3(-0.5f), vec3(0.5f));
    const float offset = random.in(1.0f, 4.0f);
    const vec3 d = random.direction();
    // In front of the plane and towards it, with both ends of the search in front of the probe's half space.
    if (glm::dot(normal, d) < 0.1f || glm::dot(normal, from) < 0.0f) continue;
    const vec3 far = glm::length(from) * d;
    const auto sample = [&](float t) {
      const vec3 direction = shading::impostorDirection(from, far, t);
      return vec2(t, shading::impostorExcess(direction, t, reciprocalDepth(direction, normal, offset)));
    };
    const float t = shading::impostorSecant(sample(0.0f), sample(1.0f));
    const float way = glm::length(from) * t / (1.0f - t);
    EXPECT_NEAR(glm::dot(normal, from + way * d), offset, 2e-4f * offset / glm::dot(normal, d)) << i;
  }
}

TEST(SingleView, MapsTexturesAndReflectionsAsTheReportDoes) {
  // The middle of a screen seen straight on; its corner; a reflection along its edge.
  EXPECT_EQ(shading::singleViewCoordinates({0.5f, 0.5f}, {0, 0}), vec2(0.5f));
  EXPECT_EQ(shading::singleViewCoordinates({1.0f, 0.0f}, {0, 0}), vec2(0.5625f, 0.4375f));
  EXPECT_EQ(shading::singleViewCoordinates({1.0f, 0.5f}, {1, 0}), vec2(0.75f, 0.5f));
}

Technique withLookup(const std::string& lookup, int resolution = 64) {
  Technique technique;
  technique.resolution = resolution;
  technique.lookup = parseSpec(lookup);
  return technique;
}

TEST(Lookups, RefuseUnknownNamesAndParameters) {
  const auto message = [](const std::string& spec) { return messageOf([&] { checkLookup(parseSpec(spec)); }); };
  EXPECT_THAT(message("box-prox"), testing::HasSubstr("nearest is 'box-proxy'"));
  EXPECT_THAT(message("sphere-proxy?radios=2"), testing::HasSubstr("nearest is 'radius'"));
  EXPECT_THAT(message("sphere-proxy?radius=-1"), testing::HasSubstr("radius"));
  EXPECT_THAT(message("distance-impostor?steps=300"), testing::HasSubstr("steps"));
  for (const Lookup& lookup : lookups()) EXPECT_NO_THROW(checkLookup({lookup.name, {}}));
}

Scene makeBallsAlongX(std::initializer_list<float> places) {
  Scene scene = makeEmptyScene(kBlack);
  const auto ball = finishMesh(makeSphereMesh(0.3f, 16, 8));
  const int mirror = addMaterial(scene, makeMirrorMaterial("mirror"));
  for (const float x : places) {
    Node node;
    node.translation.x = x;
    addInstance(scene, "ball", ball, mirror, node);
  }
  return scene;
}

Reflection blendAt(float x, std::initializer_list<float> probes) {
  Scene scene = makeBallsAlongX(probes);
  Material coated = makeMetalMaterial("coated", vec3(1.0f), vec3(2.0f), 0.6f);
  addBox(scene, vec3(x, 0, 0), vec3(0.1f), coated);
  Technique technique;
  technique.coats = Coats::blendedProbes;
  const auto snapshot = snapshotOf(std::move(scene));
  return reflectionOf(technique, *snapshot, snapshot->instances.back());
}

TEST(BlendedProbes, WeighTwoByInverseDistance) {
  const Reflection at = blendAt(1.0f, {0.0f, 4.0f});
  EXPECT_EQ(at.probe, 0);
  EXPECT_EQ(at.second, 1);
  EXPECT_NEAR(at.secondWeight, (1.0f / 3.0f) / (1.0f + 1.0f / 3.0f), 1e-6f);
  EXPECT_NEAR(blendAt(0.0f, {0.0f, 4.0f}).secondWeight, 0.0f, 1e-5f);
  EXPECT_EQ(blendAt(1.0f, {0.0f}).second, -1);
}

TEST(BlendedProbes, WeightsAreContinuousWhereTheSecondProbeChanges) {
  // At 2.5 the probes at 0 and 5 are as far away as each other; the nearest is the one at 2.
  const Reflection before = blendAt(2.499f, {0.0f, 2.0f, 5.0f}), after = blendAt(2.501f, {0.0f, 2.0f, 5.0f});
  EXPECT_EQ(before.probe, 1);
  EXPECT_EQ(before.second, 0);
  EXPECT_EQ(after.second, 2);
  EXPECT_NEAR(before.secondWeight, 0.0f, 1e-3f);
  EXPECT_NEAR(after.secondWeight, 0.0f, 1e-3f);
  // Where nearest and second change places, each has one half.
  EXPECT_NEAR(blendAt(0.999f, {0.0f, 2.0f, 5.0f}).secondWeight, 0.5f, 1e-2f);
  EXPECT_NEAR(blendAt(1.001f, {0.0f, 2.0f, 5.0f}).secondWeight, 0.5f, 1e-2f);
}

// --- Pictures --------------------------------------------------------------------------------------------------------

class RasterLookup : public RasterTest {};
INSTANTIATE_TEST_SUITE_P(Gl, RasterLookup, kBackends, nameOfBackend);

constexpr int kSize = 64;

// A room of half edge 2 around the origin whose walls shine in ramps of red and green, linear in the position.
constexpr float kHalfRoom = 2.0f;

void addShiningRoom(Scene& scene) {
  constexpr int kTexels = 64;
  ImageRgba texels(kTexels, kTexels);
  for (int y = 0; y < kTexels; ++y)
    for (int x = 0; x < kTexels; ++x)
      texels(x, y) = {(static_cast<float>(x) + 0.5f) / kTexels, (static_cast<float>(y) + 0.5f) / kTexels, 1.0f, 1.0f};
  const int ramps = addTexture(scene, makeTexture("ramps", std::move(texels)));
  const float h = kHalfRoom;
  const std::array<std::array<vec3, 3>, 6> walls = {{{vec3(h, -h, -h), vec3(0, 0, 2 * h), vec3(0, 2 * h, 0)},
                                                     {vec3(-h, -h, h), vec3(0, 0, -2 * h), vec3(0, 2 * h, 0)},
                                                     {vec3(-h, h, -h), vec3(2 * h, 0, 0), vec3(0, 0, 2 * h)},
                                                     {vec3(-h, -h, h), vec3(2 * h, 0, 0), vec3(0, 0, -2 * h)},
                                                     {vec3(h, -h, h), vec3(-2 * h, 0, 0), vec3(0, 2 * h, 0)},
                                                     {vec3(-h, -h, -h), vec3(2 * h, 0, 0), vec3(0, 2 * h, 0)}}};
  for (const auto& [p, u, v] : walls) {
    Material wall = makeTexturedMaterial("wall", ramps, vec2(1.0f), vec3(1, 1, 0.1f));
    wall.constants.kind.x = shading::kSurfaceUnlit;
    wall.constants.baseColorSlot.sampler_ = {shading::kWrapClamp, shading::kWrapClamp, shading::kFilterLinear,
                                             shading::kFilterLinear};
    addInstance(scene, "wall", finishMesh(makeQuadMesh(p, u, v)), addMaterial(scene, wall));
  }
  scene.room = Bounds{vec3(-h), vec3(h)};
}

// A mirror in the room, before the camera, turned a little aside, with its probe at `probe`.
std::shared_ptr<const Snapshot> mirrorInRoom(vec3 probe) {
  Scene scene;
  scene.environment = makeConstantEnvironment(kBlack);
  addShiningRoom(scene);
  addCamera(scene, "camera", {0.3f, 0.2f, 1.7f}, {0.0f, 0.1f, -0.5f}, 0.8f, 0.01f);
  Node node;
  node.translation = {0.1f, 0.0f, -0.7f};
  node.rotation = glm::angleAxis(0.35f, vec3(0, 1, 0));
  node.probe = ProbeSettings{.position = glm::inverse(node.rotation) * (probe - node.translation)};
  addInstance(scene, "mirror", finishMesh(makeQuadMesh({-0.6f, -0.5f, 0}, {1.2f, 0, 0}, {0, 1.0f, 0})),
              addMaterial(scene, makeMirrorMaterial("mirror")), node);
  return snapshotOf(std::move(scene));
}

Image truthOf(const std::shared_ptr<const Snapshot>& snapshot, int size = kSize) {
  ReferenceSettings settings;
  settings.samplesPerAxis = 1;
  settings.spp = 2;
  return ReferenceScene(snapshot).render(snapshot->camera, size, size, settings).mean();
}

// Share of the pixels, in which the images differ, by more than the tolerance in some channel.
double shareApart(const Image& a, const Image& b, float tolerance) {
  int apart = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const vec3 d = glm::abs(a[i] - b[i]);
    if (!(std::max({d.x, d.y, d.z}) <= tolerance)) ++apart;
  }
  return static_cast<double>(apart) / static_cast<double>(a.size());
}

// Colours up to 1 in halves are exact to 2^-12 = 2.4e-4, and interpolated between two of them. Seen from any point of
// the room, ramps bend by less than 4 across a face's unit, so interpolation of texels 2/256 apart adds 3e-5.
constexpr float kMapError = 5e-4f;
// Next to the room's edges texels of two walls are mixed, and distances to them. The mirror's picture takes a quarter
// of the image and shows a few edges, of about two texels' width each.
constexpr double kShareAtEdges = 0.03;

TEST_P(RasterLookup, BoxProxyAndImpostorSeeTheWallPointOfABoxRoom) {
  for (const vec3& probe : {vec3(0.0f), vec3(0.4f, -0.3f, 0.2f)}) {
    const auto snapshot = mirrorInRoom(probe);
    const Image truth = truthOf(snapshot);
    const auto share = [&](const char* lookup) {
      return shareApart(render(*snapshot, withLookup(lookup, 256), kSize, kSize), truth, kMapError);
    };
    EXPECT_LT(share("box-proxy"), kShareAtEdges);
    EXPECT_LT(share("distance-impostor"), kShareAtEdges);
    EXPECT_GT(share("infinite"), 0.15) << "most of the mirror's picture";
  }
}

TEST_P(RasterLookup, ImpostorWithoutLinearSearchIsExactOnTheWallsOfARoomToo) {
  const auto snapshot = mirrorInRoom(vec3(0.0f));
  EXPECT_LT(shareApart(render(*snapshot, withLookup("distance-impostor?steps=0&secant=8", 256), kSize, kSize),
                       truthOf(snapshot), 4.0f * kMapError),
            kShareAtEdges);
}

TEST_P(RasterLookup, SphereProxyIsExactInASphere) {
  // A finely tessellated shell whose radiance depends on the direction: its mirror image by closed form.
  Scene scene = makeEmptyScene(kBlack);
  Mesh shell = makeSphereMesh(2.0f, 256, 128);
  for (const vec3& p : shell.positions) shell.colors.emplace_back(0.5f + 0.2f * p, 1.0f);
  for (std::size_t i = 0; i < shell.indices.size(); i += 3) std::swap(shell.indices[i], shell.indices[i + 1]);
  for (vec3& n : shell.normals) n = -n;
  addInstance(scene, "shell", finishMesh(std::move(shell)), addMaterial(scene, makeUnlit(kWhite)));
  Node node;
  node.translation = {0.2f, 0.0f, -0.7f};
  node.probe = ProbeSettings{.position = -node.translation};
  addInstance(scene, "mirror", finishMesh(makeQuadMesh({-0.6f, -0.5f, 0}, {1.2f, 0, 0}, {0, 1.0f, 0})),
              addMaterial(scene, makeMirrorMaterial("mirror")), node);
  scene.cameras.clear();
  addCamera(scene, "inside", {0.3f, 0.2f, 1.5f}, {0.0f, 0.1f, -0.5f}, 0.8f, 0.01f);
  const auto snapshot = snapshotOf(std::move(scene));
  const Image truth = truthOf(snapshot);
  // Facets of 2.5 degrees lie up to 2 (1 - cos 1.25 deg) = 5e-4 inside of the sphere: as much in the colour, at slopes
  // of 0.2, as the halves of the map. The mirror's outline may differ.
  EXPECT_LT(shareApart(render(*snapshot, withLookup("sphere-proxy?radius=2", 256), kSize, kSize), truth, 1e-3f), 0.005);
  EXPECT_GT(shareApart(render(*snapshot, withLookup("sphere-proxy?radius=3", 256), kSize, kSize), truth, 1e-3f), 0.1);
}

TEST_P(RasterLookup, FarAwayRoomsLookInfinite) {
  // Rays of proxies and impostors end so far away that only their direction counts.
  const auto snapshot = snapshotOf(makeBall(vec3(0.5f), makeMirrorMaterial("mirror")));
  const Image infinite = render(*snapshot, withLookup("infinite"));
  for (const char* lookup : {"box-proxy", "sphere-proxy", "distance-impostor"})
    EXPECT_LT(largestDifference(infinite, render(*snapshot, withLookup(lookup))), 1e-3f) << lookup;
}

TEST_P(RasterLookup, ImpostorsOfBothBounceOrdersSeeTheSameDistances) {
  Technique sequential = withLookup("distance-impostor", 32), simultaneous = sequential;
  simultaneous.bounceOrder = BounceOrder::simultaneous;
  const auto snapshot = mirrorInRoom(vec3(0.0f));
  EXPECT_EQ(render(*snapshot, sequential), render(*snapshot, simultaneous));
}

TEST_P(RasterLookup, DistancesCostFourBytesATexel) {
  const auto snapshot = mirrorInRoom(vec3(0.0f));
  const auto bytesOf = [&](const char* lookup) {
    RasterSequence sequence(device(), withLookup(lookup, 32), 8, 8, 1);
    return sequence.renderFrame(*snapshot).counters.probeBytes;
  };
  EXPECT_EQ(bytesOf("distance-impostor"), bytesOf("infinite") + 6 * 32 * 32 * 4);
}

// --- Planar ----------------------------------------------------------------------------------------------------------

// Matte objects on a mirror and behind it; one half below its plane.
Scene makeMirrorTable(bool doubleSided = false) {
  Scene scene;
  scene.environment = makeConstantEnvironment(vec3(0.2f, 0.3f, 0.5f));
  scene.environment.ambient = constantAmbient(vec3(0.4f));
  addBox(scene, {-0.5f, 0.25f, 0.0f}, vec3(0.5f), makeDiffuseMaterial("left", {0.8f, 0.2f, 0.1f}));
  addBox(scene, {0.5f, 0.0f, -0.3f}, {0.3f, 0.9f, 0.3f}, makeDiffuseMaterial("right", {0.2f, 0.7f, 0.1f}));
  addBox(scene, {0.0f, -0.8f, 0.0f}, {3.0f, 0.2f, 3.0f}, makeDiffuseMaterial("below", {0.9f, 0.9f, 0.1f}));
  addBox(scene, {0.0f, 1.0f, -2.0f}, {4.0f, 2.0f, 0.1f}, makeDiffuseMaterial("behind", {0.4f, 0.4f, 0.6f}));
  addDirectionalLight(scene, "lamp", {0.4f, 0.8f, 0.5f}, vec3(2.0f));
  Material mirror = makeMirrorMaterial("mirror", vec3(0.9f));
  mirror.doubleSided = doubleSided;
  addInstance(scene, "mirror", finishMesh(makeQuadMesh({-1, 0, 1}, {2, 0, 0}, {0, 0, -2})), addMaterial(scene, mirror));
  addCamera(scene, "above", {0.2f, 0.8f, 2.5f}, {0.0f, 0.1f, 0.0f}, 0.8f, 0.05f);
  addCamera(scene, "below", {0.2f, -0.5f, 2.5f}, {0.0f, 0.0f, 0.0f}, 0.8f, 0.05f);
  return scene;
}

std::shared_ptr<const Snapshot> snapshotOf(Scene scene, const char* camera) {
  finishScene(scene);
  return makeSnapshot(std::make_shared<const Scene>(std::move(scene)), 0, camera, 1.0);
}

// Mirrored views are kept in halves, exact to a part in 2048; directly seen surfaces are floats. Samples on outlines,
// which the rasteriser moves by up to 1/256 pixel, may show something else: of the 400 to 800 pixels on outlines here,
// which pass their samples at any distance, about one in 64 on each side. Measured: up to 18 pixels.
constexpr float kHalfError = 6e-4f;
constexpr double kShareOfOutlines = 0.006;

TEST_P(RasterLookup, PlanarEqualsTheReference) {
  for (const char* camera : {"above", "below"}) {
    const auto snapshot = snapshotOf(makeMirrorTable(true), camera);
    const Image truth = truthOf(snapshot);
    EXPECT_LE(shareApart(render(*snapshot, withLookup("planar"), kSize, kSize), truth, kHalfError), kShareOfOutlines)
        << camera;
    EXPECT_GT(shareApart(render(*snapshot, withLookup("distance-impostor", 256), kSize, kSize), truth, kHalfError),
              0.01);
  }
}

TEST_P(RasterLookup, PlanarMirrorsStandInTheirNodesSpace) {
  Scene scene = makeMirrorTable();
  for (Node& node : scene.nodes) {
    node.scale = {-1.0f, 1.5f, 0.7f};
    node.rotation = glm::angleAxis(0.2f, vec3(0, 0, 1));
  }
  const auto snapshot = snapshotOf(std::move(scene), "above");
  EXPECT_LE(shareApart(render(*snapshot, withLookup("planar"), kSize, kSize), truthOf(snapshot), kHalfError),
            kShareOfOutlines);
}

TEST_P(RasterLookup, PlanarCostsOneViewAndNoCaptures) {
  const auto snapshot = snapshotOf(makeMirrorTable(), "above");
  RasterSequence sequence(device(), withLookup("planar"), kSize, kSize, 2);
  const FrameCounters planar = sequence.renderFrame(*snapshot).counters;
  EXPECT_EQ(planar.facesCaptured, 1);
  EXPECT_EQ(planar.probeBytes, 4 * kSize * kSize * 8);
  Technique plain;
  plain.probes = ProbeUse::environmentOnly;
  RasterSequence plainSequence(device(), plain, kSize, kSize, 2);
  const FrameCounters once = plainSequence.renderFrame(*snapshot).counters;
  // The mirrored view draws neither the mirror nor the box below it.
  EXPECT_EQ(planar.draws, 2 * once.draws - 2);
}

TEST_P(RasterLookup, SeveralPlanarMirrorsShowEachOthersMaps) {
  Scene scene = makeMirrorTable();
  addInstance(scene, "second", finishMesh(makeQuadMesh({-1, 0.1f, -1.2f}, {2, 0, 0}, {0, 1.5f, 0})),
              addMaterial(scene, makeMirrorMaterial("mirror", vec3(0.9f))));
  const auto snapshot = snapshotOf(std::move(scene), "above");
  RasterSequence sequence(device(), withLookup("planar"), kSize, kSize, 1);
  EXPECT_EQ(sequence.renderFrame(*snapshot).counters.facesCaptured, 2 * 6 + 2);
  const Image truth = truthOf(snapshot), planar = sequence.readImage();
  EXPECT_LT(shareApart(planar, truth, 0.05f),
            0.5 * shareApart(render(*snapshot, withLookup("infinite", 256), kSize, kSize), truth, 0.05f));
}

TEST_P(RasterLookup, PlanarRefusesReflectorsThatAreNotFlat) {
  const auto message = [&](const Scene& scene) {
    return messageOf([&] { render(*snapshotOf(Scene(scene)), withLookup("planar")); });
  };
  EXPECT_EQ(message(makeBall(kBlack, makeMirrorMaterial("mirror"))),
            "lookup 'planar' wants flat reflectors, 'ball' is not flat");
  EXPECT_EQ(message(makeMirrorTable()), "no error");
}

// --- Single view -----------------------------------------------------------------------------------------------------

TEST_P(RasterLookup, SingleViewCapturesOneViewAProbe) {
  const auto snapshot = mirrorInRoom(vec3(0.0f));
  RasterSequence sequence(device(), withLookup("single-view", 32), kSize, kSize, 1);
  for (int frame = 0; frame < 2; ++frame) {
    const FrameCounters counters = sequence.renderFrame(*snapshot).counters;
    EXPECT_EQ(counters.facesCaptured, 1);
    EXPECT_EQ(counters.probeBytes, 32 * 32 * 8);
  }
}

// A quad made with its v downwards faces away: the same seen from its other side, its bitangent up.
Mesh turnedRound(Mesh mesh) {
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  for (vec3& n : mesh.normals) n = -n;
  for (glm::vec4& t : mesh.tangents) t.w = -t.w;
  return mesh;
}

TEST_P(RasterLookup, SingleViewShowsWhatIsInFrontOfTheMirrorItsRightWay) {
  // A mirror at the origin that faces +Z and the camera, with a lamp in front of it on the viewer's right and above.
  // Whichever way its texture coordinates run.
  for (const bool upsideDown : {false, true}) {
    const auto pictureOf = [&](vec3 lamp) {
      Scene scene = makeEmptyScene(kBlack);
      const Mesh upright = makeQuadMesh({-1, 1, 0}, {2, 0, 0}, {0, -2, 0});
      addInstance(scene, "mirror",
                  finishMesh(upsideDown ? makeQuadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}) : turnedRound(upright)),
                  addMaterial(scene, makeMirrorMaterial("mirror")));
      addBox(scene, lamp, vec3(2.0f), makeUnlit(kRed));
      return render(*snapshotOf(std::move(scene)), withLookup("single-view", 64), kSize, kSize);
    };
    const auto redIn = [](const Image& image, int x0, int y0) {
      double sum = 0.0;
      for (int y = y0; y < y0 + kSize / 2; ++y)
        for (int x = x0; x < x0 + kSize / 2; ++x) sum += static_cast<double>(image(x, y).x);
      return sum;
    };
    const Image rightAbove = pictureOf({2.2f, 2.2f, 10.0f}), leftBelow = pictureOf({-2.2f, -2.2f, 10.0f});
    EXPECT_GT(redIn(rightAbove, kSize / 2, 0), 4.0 * redIn(rightAbove, 0, kSize / 2) + 10.0);
    EXPECT_GT(redIn(leftBelow, 0, kSize / 2), 4.0 * redIn(leftBelow, kSize / 2, 0) + 10.0);
  }
}

// --- Blended ---------------------------------------------------------------------------------------------------------

TEST_P(RasterLookup, BlendedProbesMixWhatTwoMapsShow) {
  // A rough metal in the middle between two mirror balls, each of which has a large lamp of its own colour beside it
  // that hides the rest: its pixels are between those with either map.
  const auto pictureOf = [&](Coats coats, float x) {
    Scene scene = makeBallsAlongX({-20.0f, 20.0f});
    addBox(scene, {-20.0f, 0, 3.0f}, {60.0f, 60.0f, 1.0f}, makeUnlit(kRed));
    addBox(scene, {20.0f, 0, 3.2f}, {19.0f, 60.0f, 1.0f}, makeUnlit(kBlue));
    Node node;
    node.translation = {x, 0, 0};
    addInstance(scene, "rough", finishMesh(makeSphereMesh(0.8f, 32, 16)),
                addMaterial(scene, makeMetalMaterial("rough", vec3(0.2f), vec3(4.0f), 0.5f)), node);
    scene.cameras.clear();
    addCamera(scene, "camera", {x, 0, 2.4f}, {x, 0, 0}, 0.6f, 0.1f);
    Technique technique = withResolution(32);
    technique.coats = coats;
    return centreOf(render(*snapshotOf(std::move(scene)), technique));
  };
  const vec3 left = pictureOf(Coats::nearestProbe, -0.1f), right = pictureOf(Coats::nearestProbe, 0.1f);
  ASSERT_GT(glm::distance(left, right), 0.2f);
  EXPECT_LT(glm::distance(pictureOf(Coats::blendedProbes, 0.0f), 0.5f * (left + right)), 0.02f);
}

}  // namespace
}  // namespace pb
