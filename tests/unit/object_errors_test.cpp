#include "bench/object_errors.h"

#include <gmock/gmock.h>

#include "scenes/builtin/shapes.h"

namespace pb {
namespace {

// Instances of the nodes "ball", "wall" and, with the same name and material as the first, "ball"; the balls own
// probes.
Snapshot makeThreeObjects() {
  Scene scene;
  scene.materials = {makeMirrorMaterial("mirror"), makeDiffuseMaterial("matte", glm::vec3(0.5f))};
  scene.materials[0].constants.factors.y = 0.25f;
  for (const char* name : {"ball", "wall", "ball"}) scene.instances.emplace_back().name = name;
  Snapshot snapshot;
  snapshot.scene = std::make_shared<const Scene>(scene);
  snapshot.instances.resize(3);
  for (int i = 0; i < 3; ++i) snapshot.instances[static_cast<std::size_t>(i)].source = i;
  snapshot.instances[1].material = 1;
  snapshot.instances[0].probe = 0;
  snapshot.instances[2].probe = 1;
  snapshot.probes = {{{0, 0, 0}, {0}, 0.01f}, {{0, 0, 5}, {2}, 0.01f}};
  return snapshot;
}

template <class T>
Grid<T> gridOf(std::initializer_list<T> values) {
  Grid<T> grid(static_cast<int>(values.size()), 1);
  std::ranges::copy(values, grid.begin());
  return grid;
}

// Pixels: ball, ball, wall in the reference and ball in the raster, environment.
ObjectMap makeMap() {
  return {.inReference = gridOf({0, 0, 1, -1}),
          .inRaster = gridOf({0, 0, 0, -1}),
          .atCentre = gridOf({0, 0, 1, -1}),
          .positions = gridOf<glm::vec3>({{1, 0, 0}, {0, 2, 0}, {9, 9, 9}, {}})};
}

TEST(ObjectNames, NumberThoseThatNothingTellsApart) {
  EXPECT_THAT(objectNames(makeThreeObjects()), testing::ElementsAre("ball", "wall", "ball (2)"));
  Snapshot snapshot = makeThreeObjects();
  snapshot.instances[2].material = 1;
  EXPECT_THAT(objectNames(snapshot), testing::ElementsAre("ball", "wall", "ball"));
}

// Errors by hand: the reference is 1 everywhere; test - reference is 0.1, 0.3, 0.2, 0 in every channel.
TEST(ObjectErrors, CountAPixelForWhatEitherRendererShows) {
  const Snapshot snapshot = makeThreeObjects();
  const Image reference(4, 1, glm::vec3(1.0f));
  Image test = reference;
  test[0] += 0.1f;
  test[1] += 0.3f;
  test[2] += 0.2f;
  const std::vector<ObjectError> objects =
      computeObjectErrors(snapshot, snapshot, makeMap(), reference, test, gridOf({0.1f, 0.3f, 0.2f, 0.0f}));
  ASSERT_EQ(objects.size(), 3u);  // the second ball is not in sight
  constexpr double kRounding = 1e-6;
  EXPECT_EQ(objects[0].object, "ball");
  EXPECT_EQ(objects[0].material, "mirror");
  EXPECT_EQ(objects[0].pixels, 3);
  EXPECT_NEAR(objects[0].mse, 0.14 / 3, kRounding);
  EXPECT_NEAR(objects[0].bias, 0.2, kRounding);
  EXPECT_NEAR(objects[0].flipHdr, 0.2, kRounding);
  EXPECT_NEAR(objects[0].share, 1.0, kRounding);
  EXPECT_EQ(objects[0].roughness, 0.25);
  EXPECT_EQ(objects[1].object, "wall");
  EXPECT_EQ(objects[1].pixels, 1);
  EXPECT_NEAR(objects[1].share, 0.04 / 0.14, kRounding);
  EXPECT_EQ(objects[2].object, "environment");
  EXPECT_EQ(objects[2].material, "");
  EXPECT_EQ(objects[2].share, 0.0);
}

TEST(ObjectErrors, ProbeDistance_IsTheMeanFromTheSeenSurface) {
  const Snapshot snapshot = makeThreeObjects();
  const Image image(4, 1, glm::vec3(1.0f));
  const auto objects = computeObjectErrors(snapshot, snapshot, makeMap(), image, image, Plane(4, 1));
  EXPECT_EQ(objects[0].probe, 0);
  EXPECT_DOUBLE_EQ(objects[0].probeDistance.value(), 1.5);
  EXPECT_FALSE(objects[1].probe || objects[1].probeDistance || objects[2].probe);
}

// The ball is cut in two, with probes at x = 0 and x = 10: (1, 0, 0) is 1 m from the nearer one.
TEST(ObjectErrors, OfAnObjectInParts_TakeTheNearestOfItsProbes) {
  const Snapshot snapshot = makeThreeObjects();
  Snapshot laidOut = snapshot;
  laidOut.instances.insert(laidOut.instances.begin() + 1, laidOut.instances[0]);
  laidOut.instances[1].probe = 2;
  laidOut.probes.push_back({{10, 0, 0}, {1}, 0.01f});
  ObjectMap map = makeMap();
  map.positions[1] = {8, 0, 0};
  const Image image(4, 1, glm::vec3(1.0f));
  const auto objects = computeObjectErrors(snapshot, laidOut, map, image, image, Plane(4, 1));
  EXPECT_EQ(objects[0].probe, 0);
  EXPECT_DOUBLE_EQ(objects[0].probeDistance.value(), (1.0 + 2.0) / 2);
}

}  // namespace
}  // namespace pb
