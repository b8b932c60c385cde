// Which techniques capture alike, by what their captures show.
#include "raster/equal_captures.h"

#include <gtest/gtest.h>

#include "raster/lookup_records.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

constexpr int kHeightPx = 64;

// One mirror among matte boxes: its captures show no specular surface.
Scene makeMirrorAmongMatte() {
  Scene scene = makeBall(glm::vec3(0.5f), makeMirrorMaterial("mirror"));
  addBox(scene, {0, -1.2f, 0}, {4, 0.2f, 4}, makeDiffuseMaterial("floor", glm::vec3(0.5f)));
  return scene;
}

// Two mirrors that see each other.
Scene makeTwoMirrors() {
  Scene scene = makeMirrorAmongMatte();
  addBox(scene, {1.6f, 0, 0}, glm::vec3(0.8f), makeMirrorMaterial("other mirror"));
  return scene;
}

CaptureKey keyOf(const Technique& technique, const std::shared_ptr<const Snapshot>& snapshot, int frames = 1) {
  CaptureKeyMaker maker(technique, kHeightPx);
  for (int frame = 0; frame < frames; ++frame) maker.advance(*snapshot);
  return maker.key();
}

using Change = void (*)(Technique&);

void expectEqual(const Scene& scene, Change change, bool areEqual, const char* what, int frames = 1) {
  const auto snapshot = snapshotOf(scene);
  const Technique base = withResolution(32);
  Technique changed = base;
  change(changed);
  EXPECT_EQ(keyOf(base, snapshot, frames) == keyOf(changed, snapshot, frames), areEqual) << what;
}

struct ChangeCase {
  const char* what;
  Change change;
  bool actsOnCapturesWithoutMirrors, actsOnCapturesOfMirrors;
};

const ChangeCase kChanges[] = {
    {"preset", [](Technique& t) { t.preset = "best"; }, false, false},
    {"lookup", [](Technique& t) { t.lookup = parseSpec("box-proxy"); }, false, true},
    {"lookup that reads distances", [](Technique& t) { t.lookup = parseSpec("distance-impostor"); }, false, true},
    {"bounces", [](Technique& t) { t.bounces = 3; }, false, true},
    {"feedback", [](Technique& t) { t.feedback = Feedback::sky; }, false, true},
    {"fresnel", [](Technique& t) { t.fresnel = parseSpec("schlick"); }, false, true},
    {"geometry term", [](Technique& t) { t.geometryTerm = GeometryTerm::smithK; }, false, true},
    {"refraction without glass", [](Technique& t) { t.refraction = Refraction::twoInterface; }, false, false},
    {"dispersion without glass", [](Technique& t) { t.dispersion = Dispersion::off; }, false, false},
    {"filter without rough surfaces", [](Technique& t) { t.filter = ProbeFilter::none; }, false, false},
    {"shadow maps without shadows", [](Technique& t) { t.shadowResolution = 256; }, false, false},
    {"coats without any", [](Technique& t) { t.coats = Coats::none; }, false, false},
    {"mirrors without probe without any", [](Technique& t) { t.withoutProbe = WithoutProbe::nearestProbe; }, false,
     false},
    {"resolution", [](Technique& t) { t.resolution = 16; }, true, true},
    {"format", [](Technique& t) { t.format = ProbeFormat::rgb9e5; }, true, true},
    {"storage", [](Technique& t) { t.storage = Storage::octahedral; }, true, true},
    {"levels of smooth maps", [](Technique& t) { t.mips = true; }, true, true},
    {"seamless", [](Technique& t) { t.seamless = false; }, true, true},
    {"faces", [](Technique& t) { t.faces = CapturedFaces::topHalf; }, true, true},
    {"hysteresis", [](Technique& t) { t.hysteresis = 0.5f; }, true, true},
    {"bounce order", [](Technique& t) { t.bounceOrder = BounceOrder::simultaneous; }, true, true},
    {"texture filter", [](Technique& t) { t.textureFilter = TextureFilter::hardware; }, true, true},
    {"lights of captures", [](Technique& t) { t.captureLights = false; }, true, true},
    {"textures of captures", [](Technique& t) { t.captureTextures = false; }, true, true},
    {"triangles of captures", [](Technique& t) { t.captureLod = 0.5f; }, true, true},
    {"far plane of captures", [](Technique& t) { t.captureFar = 5.0f; }, true, true},
    {"placement", [](Technique& t) { t.placement = Placement::origin; }, true, true},
    {"sharing of probes", [](Technique& t) { t.sharing = parseSpec("count?probes=1"); }, true, true},
    {"self reflection", [](Technique& t) { t.selfReflection = SelfReflection::splitParts; }, true, true},
    {"resolution scale", [](Technique& t) { t.resolutionScale = ResolutionScale::distance; }, true, true},
};

TEST(EqualCaptures, OfOneProbe_DifferByWhatActsOnMapsOnly) {
  for (const ChangeCase& c : kChanges)
    expectEqual(makeMirrorAmongMatte(), c.change, !c.actsOnCapturesWithoutMirrors, c.what);
}

TEST(EqualCaptures, OfMirrorsThatSeeEachOther_DifferByLookupsToo) {
  for (const ChangeCase& c : kChanges) expectEqual(makeTwoMirrors(), c.change, !c.actsOnCapturesOfMirrors, c.what);
}

TEST(EqualCaptures, ThatShowOtherGlass_DifferByItsRefraction) {
  Scene scene = makeMirrorAmongMatte();
  Material glass = makeGlass(1.5f);
  glass.constants.kind.z = 0.5f;
  addBox(scene, {1.6f, 0, 0}, glm::vec3(0.8f), glass);
  expectEqual(
      scene, [](Technique& t) { t.refraction = Refraction::thickSlab; }, false, "refraction");
}

// The faces of a lone glass ball show its back from inside with that refraction, and nothing of it with the others.
TEST(EqualCaptures, OfLoneGlass_DifferOnlyWhereItIsCapturedFromInside) {
  Material glass = makeGlass(1.5f);
  glass.constants.kind.z = 0.5f;
  const Scene scene = makeBall(glm::vec3(0.5f), glass);
  expectEqual(
      scene, [](Technique& t) { t.refraction = Refraction::thickSlab; }, true, "thick-slab");
  expectEqual(
      scene, [](Technique& t) { t.fresnel = parseSpec("schlick"); }, true, "fresnel");
  expectEqual(
      scene, [](Technique& t) { t.refraction = Refraction::cubemapBackface; }, false, "cubemap-backface");
}

TEST(EqualCaptures, ThatShowRoughSurfaces_DifferByTheirFilter) {
  Scene scene = makeMirrorAmongMatte();
  Material rough = makeMirrorMaterial("rough metal");
  rough.constants.kind.x = shading::kSurfaceGlossy;
  rough.constants.factors.y = 0.5f;
  rough.isSpecularDominant = false;
  addBox(scene, {1.6f, 0, 0}, glm::vec3(0.8f), rough);
  expectEqual(
      scene, [](Technique& t) { t.filter = ProbeFilter::none; }, false, "filter");
}

TEST(EqualCaptures, ThatShowDispersion_DifferByIt) {
  Scene scene = makeMirrorAmongMatte();
  Material glass = makeGlass(1.5f);
  glass.constants.kind.z = 0.5f;
  glass.constants.kind.w = 0.05f;
  addBox(scene, {1.6f, 0, 0}, glm::vec3(0.8f), glass);
  expectEqual(
      scene, [](Technique& t) { t.dispersion = Dispersion::off; }, false, "dispersion");
}

TEST(EqualCaptures, OfScenesWithSurfacesWithoutProbe_DifferByWhatTheseShow) {
  Scene scene = makeMirrorAmongMatte();
  addBox(scene, {1.6f, 0, 0}, glm::vec3(0.8f), makeMirrorMaterial("mirror without probe"));
  scene.nodes.back().probe.emplace().enabled = false;
  const auto nearest = [](Technique& t) { t.withoutProbe = WithoutProbe::nearestProbe; };
  const auto noCoats = [](Technique& t) { t.coats = Coats::none; };
  expectEqual(scene, nearest, false, "without_probe");
  expectEqual(scene, noCoats, true, "coats of a scene without any");

  Material coated = makeDiffuseMaterial("coated", glm::vec3(0.5f));
  coated.constants.kind.x = shading::kSurfaceGlossy;
  scene = makeMirrorAmongMatte();
  addBox(scene, {1.6f, 0, 0}, glm::vec3(0.8f), coated);
  expectEqual(scene, nearest, true, "without_probe of a scene whose mirrors have one");
  expectEqual(scene, noCoats, false, "coats");
}

// Whatever the policy, a sequence begins with complete maps.
TEST(EqualCaptures, OfRefreshPolicies_AreThoseOfEqualSchedules) {
  const auto once = [](Technique& t) { t.refresh = parseSpec("static"); };
  expectEqual(makeMirrorAmongMatte(), once, true, "one frame", 1);
  expectEqual(makeMirrorAmongMatte(), once, false, "two frames", 2);
}

TEST(EqualCaptures, OfIncrementalIterations_DifferAsTheyKeepRecords) {
  Technique incremental = withResolution(32);
  incremental.bounces = 2;
  incremental.iterations = Iterations::incremental;
  ASSERT_TRUE(repeatsLookups(incremental));
  Technique bruteForce = incremental;
  bruteForce.iterations = Iterations::bruteForce;
  const auto snapshot = snapshotOf(makeMirrorAmongMatte());
  EXPECT_NE(keyOf(incremental, snapshot), keyOf(bruteForce, snapshot));
  incremental.bounces = bruteForce.bounces = 1;
  EXPECT_EQ(keyOf(incremental, snapshot), keyOf(bruteForce, snapshot));
}

TEST(EqualCaptures, AreOfCapturedCubesWithoutBlendedSurfaces) {
  const Scene scene = makeMirrorAmongMatte();
  EXPECT_TRUE(mayShareCaptures(Technique(), scene));
  for (const char* lookup : {"planar", "single-view"}) {
    Technique technique;
    technique.lookup = parseSpec(lookup);
    EXPECT_FALSE(mayShareCaptures(technique, scene)) << lookup;
  }
  Technique given;
  given.probes = ProbeUse::given;
  EXPECT_FALSE(mayShareCaptures(given, scene));
  Scene shadowed = scene;
  shadowed.castsShadows = true;
  EXPECT_FALSE(mayShareCaptures(Technique(), shadowed)) << "each would hold shadow maps of its own";
  Technique twoInterfaces;
  twoInterfaces.refraction = Refraction::twoInterface;
  EXPECT_TRUE(mayShareCaptures(twoInterfaces, scene));
  Scene glass = scene;
  glass.materials.push_back(makeGlass(1.5f));
  glass.materials.back().constants.kind.z = 0.5f;
  EXPECT_TRUE(mayShareCaptures(Technique(), glass));
  EXPECT_FALSE(mayShareCaptures(twoInterfaces, glass)) << "each would hold back faces of its own";
  Scene blended = scene;
  blended.materials.front().constants.alpha.x = shading::kAlphaBlend;
  EXPECT_FALSE(mayShareCaptures(Technique(), blended));
}

}  // namespace
}  // namespace pb
