#include "bench/material_errors.h"

#include <gmock/gmock.h>

#include "scenes/builtin/shapes.h"

namespace pb {
namespace {

// Two instances, the second with material 1.
Snapshot makeTwoMaterials() {
  Scene scene;
  scene.materials = {makeDiffuseMaterial("matte", glm::vec3(0.5f)), makeMirrorMaterial("mirror")};
  Snapshot snapshot;
  snapshot.scene = std::make_shared<const Scene>(scene);
  snapshot.instances.resize(2);
  snapshot.instances[1].material = 1;
  return snapshot;
}

TEST(MaterialMap, TakesWhatMostSamplesShow_TheFirstOfSeveral) {
  Grid<SampleId> ids(6, 2);
  const std::uint32_t rows[2][6] = {{1, 2, 2, 0, 0, 1}, {2, 2, 1, 0, 1, 0}};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 6; ++x) ids(x, y).instance = rows[y][x];
  const Grid<int> map = materialMap(makeTwoMaterials(), ids, 2);
  EXPECT_EQ(map(0, 0), 1);   // three of four
  EXPECT_EQ(map(1, 0), -1);  // two of four environment, one each of the others
  EXPECT_EQ(map(2, 0), -1);  // a tie: the first sample decides
}

// Errors by hand: the reference is 1 everywhere; matte pixels are off by 0.1 and -0.3, the environment by 0.2.
TEST(MaterialErrors, AreMeansOverTheMaterialsPixels_SharesAddUpToOne) {
  const Snapshot snapshot = makeTwoMaterials();
  Grid<int> map(3, 1);
  map[0] = map[1] = 0;
  map[2] = -1;
  const Image reference(3, 1, glm::vec3(1.0f));
  Image test(3, 1, glm::vec3(1.0f));
  test[0] += 0.1f;
  test[1] -= 0.3f;
  test[2] += 0.2f;
  Plane flip(3, 1);
  flip[0] = 0.25f;
  flip[1] = 0.75f;
  const std::vector<MaterialError> errors = computeMaterialErrors(*snapshot.scene, map, reference, test, flip);
  ASSERT_EQ(errors.size(), 2U);  // the mirror is not in sight
  constexpr double kRounding = 1e-6;
  EXPECT_EQ(errors[0].material, "matte");
  EXPECT_EQ(errors[0].pixels, 2);
  EXPECT_NEAR(errors[0].mse, (0.01 + 0.09) / 2, kRounding);
  EXPECT_NEAR(errors[0].relmse, (0.01 + 0.09) / 2 / 1.01, kRounding);
  EXPECT_NEAR(errors[0].bias, -0.1, kRounding);
  EXPECT_NEAR(errors[0].flipHdr, 0.5, kRounding);
  EXPECT_NEAR(errors[0].share, 0.1 / 0.14, kRounding);
  EXPECT_EQ(errors[1].material, "environment");
  EXPECT_NEAR(errors[0].share + errors[1].share, 1.0, kRounding);
}

TEST(MaterialErrors, OfEqualImages_HaveNoShare) {
  const Snapshot snapshot = makeTwoMaterials();
  const Image image(2, 2, glm::vec3(0.5f));
  const auto errors = computeMaterialErrors(*snapshot.scene, Grid<int>(2, 2), image, image, Plane(2, 2));
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].share, 0.0);
  EXPECT_EQ(errors[0].mse, 0.0);
}

}  // namespace
}  // namespace pb
