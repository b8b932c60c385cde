// Small maps that are drawn apart from where lookups read them (ProbeMaps): the same in every bit as those drawn there.
#include <gtest/gtest.h>

#include <set>

#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

class RasterApart : public RasterTest {
 protected:
  static constexpr int kWidthPx = 48;

  struct Frame {
    Image image;
    std::vector<std::array<Image, 6>> maps;
    FrameCounters counters;
  };

  std::vector<Frame> framesOf(const std::string& scene, const Technique& technique, bool isApart, int heightPx) {
    device().impl().capturesApart = isApart;
    RasterSequence sequence(device(), technique, kWidthPx, heightPx, 1);
    const auto shared = std::make_shared<const Scene>(makeBuiltinScene(parseSpec(scene)));
    std::vector<Frame> frames;
    for (int i = 0; i < 3; ++i) {
      const FrameStats stats =
          sequence.renderFrame(*makeSnapshot(shared, 2 * i, "", double{kWidthPx} / heightPx), true);
      Frame& frame = frames.emplace_back(Frame{sequence.readImage(), {}, stats.counters});
      for (std::size_t probe = 0; probe < stats.faceAgeFrames.size(); ++probe)
        frame.maps.push_back(sequence.readProbe(static_cast<int>(probe)));
    }
    device().impl().capturesApart = device().info().software;
    return frames;
  }

  void expectSame(const std::string& scene, const Technique& technique, int heightPx = 27) {
    const std::vector<Frame> apart = framesOf(scene, technique, true, heightPx);
    const std::vector<Frame> inPlace = framesOf(scene, technique, false, heightPx);
    for (std::size_t i = 0; i < inPlace.size(); ++i) {
      EXPECT_EQ(apart[i].image, inPlace[i].image) << "frame " << i;
      EXPECT_FALSE(inPlace[i].maps.empty());
      EXPECT_TRUE(apart[i].maps == inPlace[i].maps) << "frame " << i;
      EXPECT_EQ(apart[i].counters, inPlace[i].counters) << "frame " << i;
    }
  }

  // Of a technique of small maps with one setting more.
  template <class Value>
  void expectSameFor(Value Technique::*setting, const std::vector<Value>& values, int bounces = 1,
                     const std::string& scene = "mirrors?count=3") {
    for (std::size_t i = 0; i < values.size(); ++i) {
      SCOPED_TRACE(testing::Message() << scene << ", value " << i);
      Technique technique = withResolution(32);
      technique.bounces = bounces;
      technique.*setting = values[i];
      expectSame(scene, technique);
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Gl, RasterApart, kBackends, nameOfBackend);

TEST_P(RasterApart, MapsAreTheSameInEachOrderOfBothKindsOfIterations) {
  for (const Iterations iterations : {Iterations::bruteForce, Iterations::incremental})
    for (const BounceOrder order : {BounceOrder::sequential, BounceOrder::simultaneous})
      for (const Feedback feedback : {Feedback::previousFrame, Feedback::sky}) {
        Technique technique = withResolution(32);
        technique.bounces = 3;
        technique.iterations = iterations;
        technique.bounceOrder = order;
        technique.feedback = feedback;
        expectSame("mirrors?count=3", technique);
        if (feedback == Feedback::previousFrame) expectSame("glass", technique);
      }
}

TEST_P(RasterApart, MapsOfWhichSomeFacesAreCapturedAreTheSame) {
  std::vector<Spec> policies;
  for (const char* policy : {"every-n?n=2", "faces?k=2", "on-change", "static", "budget?faces=5", "camera-visible"})
    policies.push_back(parseSpec(policy));
  for (const char* scene : {"mirrors?count=3", "teapot"}) expectSameFor(&Technique::refresh, policies, 2, scene);
  expectSameFor(&Technique::faces, {CapturedFaces::noTopBottom, CapturedFaces::topHalf});
}

TEST_P(RasterApart, MapsOfEachFormatAndStorageAreTheSame) {
  expectSameFor(&Technique::format, {ProbeFormat::r11fG11fB10f, ProbeFormat::rgb9e5, ProbeFormat::rgba8Srgb});
  expectSameFor(&Technique::storage, {Storage::dualParaboloid, Storage::octahedral});
}

TEST_P(RasterApart, MapsOfEachLookupAreTheSame) {
  std::vector<Spec> lookups;
  for (const char* lookup : {"sphere-proxy", "box-proxy", "distance-impostor", "single-view"})
    lookups.push_back(parseSpec(lookup));
  expectSameFor(&Technique::lookup, lookups);
  expectSameFor(&Technique::filter, {ProbeFilter::none, ProbeFilter::boxMips}, 1, "metals?grid=2");
  expectSameFor(&Technique::coats, {Coats::blendedProbes}, 2, "mirrors?count=3&varnished=1");
}

TEST_P(RasterApart, AveragedMapsAreTheSame) {
  for (const int bounces : {1, 2}) expectSameFor(&Technique::hysteresis, {0.5f}, bounces);
}

// Of maps on both sides of the size up to which they are drawn apart, and of small ones only.
TEST_P(RasterApart, MapsOfDifferentSizesAreTheSame) {
  constexpr int kHeightPx = 300;
  for (const Iterations iterations : {Iterations::bruteForce, Iterations::incremental}) {
    Technique technique = withResolution(256);
    technique.resolutionScale = ResolutionScale::distance;
    technique.bounces = 2;
    technique.iterations = iterations;
    std::set<int> sizes;
    const std::vector<Frame> frames = framesOf("mirrors?count=5", technique, true, kHeightPx);
    for (const auto& map : frames.front().maps) sizes.insert(map.front().width());
    EXPECT_EQ(sizes, (std::set<int>{128, 256}));
    expectSame("mirrors?count=5", technique, kHeightPx);
    technique.resolution = 16;
    for (const char* scene : {"mirrors?count=5", "street"}) expectSame(scene, technique);
  }
}

TEST_P(RasterApart, MapsOfJoinedAndSplitProbesAreTheSame) {
  expectSameFor(&Technique::sharing, {parseSpec("count?probes=2"), parseSpec("distance?metres=3")}, 2);
  expectSameFor(&Technique::selfReflection, {SelfReflection::splitParts});
}

}  // namespace
}  // namespace pb
