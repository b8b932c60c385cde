// What is dropped of a draw's triangles on the CPU changes no pixel, on any frame of a sequence.
#include <gtest/gtest.h>

#include "raster/triangle_lists.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

class RasterTriangles : public RasterTest {
 protected:
  struct Frame {
    Image image;
    std::array<Image, 6> faces;
    FrameCounters counters;
  };

  std::vector<Frame> framesOf(const std::string& scene, const Technique& technique, bool dropsUnseen) {
    device().impl().dropsUnseenTriangles = dropsUnseen;
    RasterSequence sequence(device(), technique, 96, 54, 1);
    std::vector<Frame> frames;
    const auto shared =
        std::make_shared<const Scene>(makeBuiltinScene(parseSpec(scene)));  // what is kept is used again
    for (int i = 0; i < 3; ++i) {
      const auto snapshot = makeSnapshot(shared, i, "", 96.0 / 54.0);
      const FrameCounters counters = sequence.renderFrame(*snapshot, true).counters;
      frames.push_back({sequence.readImage(), sequence.readProbe(0), counters});
    }
    device().impl().dropsUnseenTriangles = device().info().software;
    return frames;
  }

  void expectSame(const std::string& scene, const Technique& technique) {
    SCOPED_TRACE(scene);
    const std::vector<Frame> dropped = framesOf(scene, technique, true), whole = framesOf(scene, technique, false);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      EXPECT_EQ(largestDifference(dropped[i].image, whole[i].image), 0.0f) << "frame " << i;
      for (std::size_t f = 0; f < 6; ++f)
        EXPECT_EQ(largestDifference(dropped[i].faces[f], whole[i].faces[f]), 0.0f) << "frame " << i << " face " << f;
      EXPECT_EQ(dropped[i].counters, whole[i].counters) << "frame " << i;
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Gl, RasterTriangles, kBackends, nameOfBackend);

TEST_P(RasterTriangles, UnseenOnesChangeNoPixelOfWhatMoves) {
  for (const char* scene : {"teapot", "flag-and-horse", "mirrors?count=3"}) {
    Technique technique = withResolution(64);
    technique.bounces = 2;
    expectSame(scene, technique);
    technique.captureLod = 0.3f;
    technique.iterations = Iterations::incremental;
    expectSame(scene, technique);
  }
}

TEST_P(RasterTriangles, UnseenOnesChangeNoPixelOfGlassAndLayers) {
  Technique technique = withResolution(64);
  for (const Refraction refraction : {Refraction::twoInterface, Refraction::cubemapBackface}) {
    technique.refraction = refraction;
    expectSame("glass", technique);
  }
  technique.captureFar = 5.0f;
  expectSame("glass", technique);
}

}  // namespace
}  // namespace pb
