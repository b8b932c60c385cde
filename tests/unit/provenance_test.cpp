#include "bench/provenance.h"

#include <gtest/gtest.h>

namespace pb {
namespace {

Suite suiteOf(std::vector<int> frames) {
  Suite suite;
  suite.name = "one";
  suite.scenes.resize(1);
  suite.scenes[0].name = "scene";
  suite.scenes[0].frames = std::move(frames);
  return suite;
}

// One triangle that stands where the track's keys, half a second apart, put it along x.
std::shared_ptr<const Scene> movingTriangle(const std::vector<float>& xs) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2};
  Scene scene;
  scene.materials.push_back(makeDiffuseMaterial("white", glm::vec3(1.0f)));
  scene.nodes.resize(2);
  scene.instances.push_back({"triangle", 0, finishMesh(std::move(mesh)), 0});
  scene.nodes[1].translation = {0, 0, 5};
  scene.cameras.push_back({"main", 1});
  if (!xs.empty()) {
    Track track;
    for (std::size_t i = 0; i < xs.size(); ++i) {
      track.timesSeconds.push_back(0.5f * static_cast<float>(i));
      track.values.emplace_back(xs[i], 0.0f, 0.0f, 0.0f);
    }
    scene.tracks.push_back(std::move(track));
  }
  scene.framesPerSecond = 2.0;
  finishScene(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

std::string fingerprintOf(Suite suite, const std::shared_ptr<const Scene>& scene) {
  suite.scenes[0].camera = scene->cameras.front().name;
  return fingerprint(makeProvenance(suite, {scene}, {}, 1), makePlan(suite), suite);
}

TEST(Fingerprint, SeesEveryRenderedFrame) {
  const auto original = movingTriangle({0, 1, 2, 3, 4});
  const auto editedBetween = movingTriangle({0, 1, 2.5f, 3, 4});
  const auto editedAtTheEnd = movingTriangle({0, 1, 2, 3.5f, 4});
  const Suite suite = suiteOf({1, 3});
  EXPECT_EQ(fingerprintOf(suite, original), fingerprintOf(suite, movingTriangle({0, 1, 2, 3, 4})));
  EXPECT_NE(fingerprintOf(suite, original), fingerprintOf(suite, editedBetween));
  EXPECT_NE(fingerprintOf(suite, original), fingerprintOf(suite, editedAtTheEnd));
  EXPECT_EQ(fingerprintOf(suiteOf({1}), original), fingerprintOf(suiteOf({1}), editedBetween));
}

TEST(Fingerprint, OfWarmup_SeesItsFramesFromZeroOn) {
  Suite suite = suiteOf({2});
  suite.scenes[0].warmup = 1;
  EXPECT_NE(fingerprintOf(suite, movingTriangle({0, 1, 2, 3})), fingerprintOf(suite, movingTriangle({0, 5, 2, 3})));
  EXPECT_EQ(fingerprintOf(suite, movingTriangle({0, 1, 2, 3})), fingerprintOf(suite, movingTriangle({5, 1, 2, 3})));
}

}  // namespace
}  // namespace pb
