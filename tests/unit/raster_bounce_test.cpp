// How many reflections probes gain from bounce iterations and from feedback.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "scenes/builtin/shapes.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec3;

class RasterBounce : public RasterTest {};

INSTANTIATE_TEST_SUITE_P(Gl, RasterBounce, kBackends, nameOfBackend);

constexpr float kReflectance = 0.5f;

// Two mirrors that face each other and emit 1: along their common axis a probe shows the sum of kReflectance^k over k
// = 0 .. n - 1 after n captures in turn, and the black environment adds nothing. Sums of few terms are exact in half
// floats; lookups hit the middle of the middle texel but for rounding.
std::shared_ptr<const Snapshot> facingMirrors() {
  Scene scene = makeEmptyScene(kBlack);
  Material mirror = makeMirrorMaterial("mirror", vec3(kReflectance));
  mirror.constants.emission = {1.0f, 1.0f, 1.0f, 1.0f};
  const int material = addMaterial(scene, mirror);
  addInstance(scene, "left", finishMesh(makeQuadMesh(vec3(-1, -1, 1), vec3(0, 0, -2), vec3(0, 2, 0))), material);
  addInstance(scene, "right", finishMesh(makeQuadMesh(vec3(1, -1, -1), vec3(0, 0, 2), vec3(0, 2, 0))), material);
  return snapshotOf(std::move(scene));
}

float partialSum(int terms) {
  return (1.0f - std::pow(kReflectance, static_cast<float>(terms))) / (1.0f - kReflectance);
}

// Terms of the series that the left and the right probe have after rendering `frames` frames.
void expectTerms(RasterDevice& device, const Technique& technique, int frames, int left, int right) {
  const auto snapshot = facingMirrors();
  RasterSequence sequence(device, technique, 16, 16, 1);
  for (int f = 0; f < frames; ++f) sequence.renderFrame(*snapshot);
  constexpr float kTolerance = 1e-3f;  // below half of the smallest difference tested, 0.5^7 / 2
  EXPECT_NEAR(centreOf(sequence.readProbe(0)[0]).x, partialSum(left), kTolerance);   // looks along +X
  EXPECT_NEAR(centreOf(sequence.readProbe(1)[1]).x, partialSum(right), kTolerance);  // looks along -X
}

// An odd number of texels has one in the middle.
Technique withBounces(int bounces, BounceOrder order, Feedback feedback = Feedback::previousFrame) {
  Technique technique = withResolution(33);
  technique.bounces = bounces;
  technique.bounceOrder = order;
  technique.feedback = feedback;
  return technique;
}

TEST_P(RasterBounce, SequentialBouncesGainTwoTermsAnIteration) {
  for (int b = 1; b <= 3; ++b) expectTerms(device(), withBounces(b, BounceOrder::sequential), 1, 2 * b - 1, 2 * b);
}

TEST_P(RasterBounce, SimultaneousBouncesGainOneTermAnIteration) {
  for (int b = 1; b <= 3; ++b) expectTerms(device(), withBounces(b, BounceOrder::simultaneous), 1, b, b);
}

TEST_P(RasterBounce, PreviousFrameFeedbackGoesOnWhereTheLastFrameStopped) {
  expectTerms(device(), withBounces(1, BounceOrder::sequential), 3, 5, 6);
  expectTerms(device(), withBounces(1, BounceOrder::simultaneous), 3, 3, 3);
}

TEST_P(RasterBounce, SkyFeedbackStartsAnewInEveryFrame) {
  expectTerms(device(), withBounces(2, BounceOrder::sequential, Feedback::sky), 3, 3, 4);
  expectTerms(device(), withBounces(2, BounceOrder::simultaneous, Feedback::sky), 3, 2, 2);
}

TEST_P(RasterBounce, SkyFeedbackLeavesProbesAloneThatAreNotDue) {
  // One face a frame: frame 1 captures the left probe's +X face, which sees the right probe's first capture.
  Technique technique = withBounces(1, BounceOrder::sequential, Feedback::sky);
  technique.refresh = parseSpec("faces?k=1");
  expectTerms(device(), technique, 2, 3, 2);
}

}  // namespace
}  // namespace pb
