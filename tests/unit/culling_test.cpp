// Culling may never drop what is seen.
#include "raster/culling.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "scenes/snapshot.h"

namespace pb {
namespace {

const shading::View kView = cubeFaceView(glm::vec3(1.0f, 2.0f, 3.0f), 4, 0.1f);  // looks along +Z, 90 degrees

Bounds boxAround(glm::vec3 centre, float radius) { return {centre - glm::vec3(radius), centre + glm::vec3(radius)}; }

TEST(Culling, KeepsABoxAroundEveryPointThatIsSeen) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> coordinate(-20.0f, 20.0f), size(0.0f, 3.0f);
  int seen = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 point(coordinate(random), coordinate(random), coordinate(random));
    const glm::vec4 clip = shading::clipFromWorldPosition(kView, point);
    if (clip.w < 0.1f || std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w) continue;
    ++seen;
    Bounds box = boxAround(point, 0.0f);
    box.include(point + glm::vec3(size(random), -size(random), size(random)));
    EXPECT_FALSE(isOutsideFrustum(box, kView));
  }
  EXPECT_GT(seen, 1000) << "too few points to say anything";
}

TEST(Culling, DropsBoxesBeyondEachPlane) {
  const glm::vec3 eye(kView.origin);
  for (const glm::vec3& direction : {glm::vec3(0, 0, -1), glm::vec3(1, 0, 0.5f), glm::vec3(-1, 0, 0.5f),
                                     glm::vec3(0, 1, 0.5f), glm::vec3(0, -1, 0.5f)})
    EXPECT_TRUE(isOutsideFrustum(boxAround(eye + 10.0f * direction, 1.0f), kView));
}

TEST(Culling, DropsWhatIsNearerThanTheNearPlane) {
  const glm::vec3 eye(kView.origin);
  EXPECT_TRUE(isOutsideFrustum(boxAround(eye + glm::vec3(0, 0, 0.05f), 0.01f), kView));
  EXPECT_FALSE(isOutsideFrustum(boxAround(eye + glm::vec3(0, 0, 0.15f), 0.01f), kView));
}

TEST(Culling, KeepsABoxThatTouchesAPlaneAndABoxAroundTheEye) {
  const glm::vec3 eye(kView.origin);
  Bounds touching;
  touching.include(eye + glm::vec3(5, 0, 5));
  touching.include(eye + glm::vec3(9, 1, 5));
  EXPECT_FALSE(isOutsideFrustum(touching, kView));
  EXPECT_FALSE(isOutsideFrustum(boxAround(eye, 100.0f), kView));
}

}  // namespace
}  // namespace pb
