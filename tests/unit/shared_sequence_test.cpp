// Sequences that share their captures are, in every bit, those that have their own, on both GL backends.
#include "raster/shared_sequence.h"

#include <gtest/gtest.h>

#include "raster/equal_captures.h"
#include "scenes/error.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

constexpr int kWidth = 48, kHeight = 27;

struct Change {
  const char* what;
  void (*apply)(Technique&);
};

std::shared_ptr<const Scene> finished(Scene scene) {
  finishScene(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

// A ball of dispersing glass that sees none but matte surfaces.
std::shared_ptr<const Scene> makeLoneGlass() {
  Material glass = makeGlass(1.5f);
  glass.constants.kind.z = 0.5f;   // thickness
  glass.constants.kind.w = 0.05f;  // dispersion
  Scene scene = makeBall(glm::vec3(0.5f), glass);
  addBox(scene, {0, -1.2f, 0}, {4, 0.2f, 4}, makeDiffuseMaterial("floor", glm::vec3(0.7f, 0.5f, 0.2f)));
  addBox(scene, {-1.0f, 0, -2}, glm::vec3(0.8f), makeUnlit(kRed));
  return finished(std::move(scene));
}

Material makeRough(const char* name, bool hasProbe) {
  Material material = makeMirrorMaterial(name);
  material.constants.kind.x = shading::kSurfaceGlossy;
  material.constants.factors.y = 0.5f;
  material.isSpecularDominant = hasProbe;
  return material;
}

// A rough ball, whose map has filtered levels.
std::shared_ptr<const Scene> makeRoughBall() {
  Scene scene = makeBall(glm::vec3(0.5f), makeRough("rough", true));
  addBox(scene, {0, -1.2f, 0}, {4, 0.2f, 4}, makeDiffuseMaterial("floor", glm::vec3(0.7f, 0.5f, 0.2f)));
  addBox(scene, {1.0f, 0.4f, 1.5f}, glm::vec3(0.4f), makeUnlit(kBlue));
  return finished(std::move(scene));
}

// A mirror ball whose map is the only one, and so what surfaces without a probe show: something coated, and a mirror.
std::shared_ptr<const Scene> makeNeighboursWithoutProbe() {
  Scene scene = makeBall(glm::vec3(0.5f), makeMirrorMaterial("ball"));
  addBox(scene, {-1.5f, 0, 0}, glm::vec3(0.8f), makeRough("coated", false));
  addBox(scene, {1.5f, 0, 0}, glm::vec3(0.8f), makeMirrorMaterial("mirror"));
  scene.nodes.back().probe.emplace().enabled = false;
  addBox(scene, {0, -1.2f, 0}, {4, 0.2f, 4}, makeUnlit(kRed));
  return finished(std::move(scene));
}

// Of techniques that share the captures of a scene.
struct SharingCase {
  const char* scene;
  std::vector<int> frames;
  std::vector<Change> changes;
  std::shared_ptr<const Scene> (*make)() = nullptr;  // unless `scene` says which
};

const Change kNone = {"nothing", [](Technique&) {}};
const Change kBox = {"box-proxy", [](Technique& t) { t.lookup = parseSpec("box-proxy"); }};
const Change kSphere = {"sphere-proxy", [](Technique& t) { t.lookup = parseSpec("sphere-proxy"); }};
const Change kImpostor = {"distance-impostor", [](Technique& t) { t.lookup = parseSpec("distance-impostor"); }};
const Change kBounces = {"3 bounces", [](Technique& t) { t.bounces = 3; }};
const Change kBouncesImpostor = {"2 bounces, distance-impostor", [](Technique& t) {
                                   t.bounces = 2;
                                   t.lookup = parseSpec("distance-impostor");
                                 }};
const Change kSky = {"feedback = sky", [](Technique& t) { t.feedback = Feedback::sky; }};
const Change kSchlick = {"schlick", [](Technique& t) { t.fresnel = parseSpec("schlick"); }};
const Change kSlab = {"thick-slab", [](Technique& t) { t.refraction = Refraction::thickSlab; }};
const Change kNoDispersion = {"no dispersion", [](Technique& t) { t.dispersion = Dispersion::off; }};
const Change kStatic = {"static", [](Technique& t) { t.refresh = parseSpec("static"); }};
const Change kNoFilter = {"no filter", [](Technique& t) { t.filter = ProbeFilter::none; }};
// A single iteration repeats no lookups: captured as by brute force.
const Change kIncremental = {"incremental", [](Technique& t) { t.iterations = Iterations::incremental; }};
const Change kIncrementalBounces = {"incremental, 3 bounces", [](Technique& t) {
                                      t.iterations = Iterations::incremental;
                                      t.bounces = 3;
                                    }};
const Change kIncrementalBox = {"incremental, 3 bounces, box-proxy", [](Technique& t) {
                                  kIncrementalBounces.apply(t);
                                  t.lookup = parseSpec("box-proxy");
                                }};
void showNearest(Technique& t) { t.withoutProbe = WithoutProbe::nearestProbe; }
const Change kNearest = {"nearest probe", showNearest};
const Change kNearestBox = {"nearest probe, box-proxy", [](Technique& t) {
                              showNearest(t);
                              t.lookup = parseSpec("box-proxy");
                            }};
const Change kNearestBounces = {"nearest probe, 3 bounces", [](Technique& t) {
                                  showNearest(t);
                                  t.bounces = 3;
                                }};

const SharingCase kCases[] = {
    {"builtin:mirror-cube", {0, 1}, {kNone, kBox, kSphere, kImpostor, kBounces, kBouncesImpostor, kSky, kSchlick}},
    {"builtin:teapot", {0, 4}, {kNone, kImpostor, kBounces, kNoFilter}},
    {"a glass ball", {0}, {kNone, kSlab, kNoDispersion, kBouncesImpostor}, makeLoneGlass},
    {"builtin:mirrors?count=3", {0}, {kNone, kStatic}},
    {"builtin:mirror-cube", {0}, {kIncremental, kBounces}},
    {"builtin:mirror-cube", {0}, {kBounces, kIncremental}},
    {"builtin:mirror-cube", {0}, {kIncrementalBounces, kIncrementalBox}},
    {"a rough ball", {0, 1}, {kNone, kImpostor, kBounces, kBouncesImpostor, kIncremental}, makeRoughBall},
    {"coats", {0, 1}, {kNone, kBox, kBounces, kSky}, makeNeighboursWithoutProbe},
    {"mirrors without probe", {0, 1}, {kNearest, kNearestBox, kNearestBounces}, makeNeighboursWithoutProbe},
};

std::vector<Technique> techniquesOf(const SharingCase& c, const Technique& base) {
  std::vector<Technique> techniques;
  for (const Change& change : c.changes) change.apply(techniques.emplace_back(base));
  return techniques;
}

std::shared_ptr<const Scene> sceneOf(const SharingCase& c) { return c.make != nullptr ? c.make() : loadScene(c.scene); }

// Maps that are converted, averaged over frames, and filtered.
const Change kBases[] = {kNone,
                         {"octahedral", [](Technique& t) { t.storage = Storage::octahedral; }},
                         {"hysteresis", [](Technique& t) { t.hysteresis = 0.5f; }},
                         {"levels of smooth maps", [](Technique& t) { t.mips = true; }},
                         {"top half, simultaneous", [](Technique& t) {
                            t.faces = CapturedFaces::topHalf;
                            t.bounceOrder = BounceOrder::simultaneous;
                          }}};

void expectEqualStats(const FrameStats& shared, const FrameStats& own, const std::string& what) {
  EXPECT_EQ(shared.counters.facesCaptured, own.counters.facesCaptured) << what;
  EXPECT_EQ(shared.counters.draws, own.counters.draws) << what;
  EXPECT_EQ(shared.counters.triangles, own.counters.triangles) << what;
  EXPECT_EQ(shared.counters.fragments, own.counters.fragments) << what;
  EXPECT_EQ(shared.counters.probeBytes, own.counters.probeBytes) << what;
  EXPECT_EQ(shared.counters.texelsFiltered, own.counters.texelsFiltered) << what;
  EXPECT_EQ(shared.faceAgeFrames, own.faceAgeFrames) << what;
  EXPECT_EQ(shared.coats, own.coats) << what;
  EXPECT_EQ(shared.mirrors, own.mirrors) << what;
}

class SharedSequences : public RasterTest {
 protected:
  // Shared ones are shown every so many frames.
  void expectSameAsAlone(const SharingCase& c, const Change& base, std::size_t every = 1) {
    Technique technique = withResolution(16);
    base.apply(technique);
    const std::vector<Technique> techniques = techniquesOf(c, technique);
    SharedSequence shared(device(), techniques, kWidth, kHeight, 1);
    std::vector<std::unique_ptr<RasterSequence>> alone;
    for (const Technique& t : techniques)
      alone.push_back(std::make_unique<RasterSequence>(device(), t, kWidth, kHeight, 1));
    const std::shared_ptr<const Scene> scene = sceneOf(c);
    for (std::size_t n = 0; n < c.frames.size(); ++n) {
      const auto snapshot = makeSnapshot(scene, c.frames[n], "", 16.0 / 9.0);
      shared.capture(snapshot, true);
      for (std::size_t i = 0; i < techniques.size(); ++i) {
        const std::string what = std::string(c.scene) + ", " + base.what + ", " + c.changes[i].what;
        const FrameStats ofAlone = alone[i]->renderFrame(*snapshot, true);
        if (n % every != 0) continue;
        expectEqualStats(shared.show(i), ofAlone, what);
        EXPECT_TRUE(shared.readImage() == alone[i]->readImage()) << what << ", frame " << c.frames[n];
      }
    }
  }
};

TEST_P(SharedSequences, HavePicturesAndCountersOfSequencesAlone) {
  for (const SharingCase& c : kCases) expectSameAsAlone(c, kNone);
}

TEST_P(SharedSequences, OfMapsThatAreWorkedOn_HavePicturesAndCountersOfSequencesAlone) {
  for (const Change& base : kBases) expectSameAsAlone(kCases[0], base);
}

TEST_P(SharedSequences, OfFramesThatAreNotShown_GoOnAsSequencesAloneDo) {
  for (const Change& base : {kNone, kBases[2]})
    expectSameAsAlone({"builtin:teapot", {0, 4, 8}, {kNone, kImpostor, kBounces}}, base, 2);
}

// Whichever of them it is.
TEST_P(SharedSequences, RefuseSettingsThatASequenceRefuses) {
  const Change kBad[] = {{"no bounce", [](Technique& t) { t.bounces = 0; }},
                         {"fresnel", [](Technique& t) { t.fresnel = parseSpec("nonsense"); }},
                         {"refresh", [](Technique& t) { t.refresh = parseSpec("sometimes"); }},
                         {"lookup", [](Technique& t) { t.lookup = parseSpec("box-proxy?nonsense=1"); }}};
  for (const Change& change : kBad) {
    Technique bad = withResolution(8);
    change.apply(bad);
    EXPECT_THROW(SharedSequence(device(), {withResolution(8), bad}, 16, 16, 1), Error) << change.what;
    EXPECT_THROW(SharedSequence(device(), {bad, withResolution(8)}, 16, 16, 1), Error) << change.what;
  }
}

// What these tests show must be what runs do.
TEST(SharedSequence, TestsAreOfTechniquesWithEqualCaptures) {
  for (const SharingCase& c : kCases) {
    std::vector<CaptureKey> keys;
    const std::shared_ptr<const Scene> scene = sceneOf(c);
    for (const Technique& technique : techniquesOf(c, withResolution(16))) {
      EXPECT_TRUE(mayShareCaptures(technique, *scene)) << c.scene;
      CaptureKeyMaker maker(technique, kHeight);
      for (const int frame : c.frames) maker.advance(*makeSnapshot(scene, frame, "", 16.0 / 9.0));
      keys.push_back(maker.key());
    }
    for (std::size_t i = 0; i < keys.size(); ++i)
      EXPECT_TRUE(keys[i] == keys.front()) << c.scene << ", " << c.changes[i].what;
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, SharedSequences, kBackends, nameOfBackend);

}  // namespace
}  // namespace pb
