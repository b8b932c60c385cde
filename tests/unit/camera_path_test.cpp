// Orbits, eased transitions, cameras that nodes move, environments that follow each other and frame rates.
#include "scenes/camera_path.h"

#include <gmock/gmock.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/gltf_save.h"
#include "scenes/snapshot.h"
#include "tests/unit/gltf_file.h"

namespace pb {
namespace {

using glm::vec3;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::shared_ptr<const Scene> shared(Scene scene) { return std::make_shared<const Scene>(std::move(scene)); }

void expectNear(const vec3& a, const vec3& b, float tolerance) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " for " << b.x << " " << b.y << " " << b.z;
}

TEST(Orbit, OfACamera_CirclesItsTargetCounterClockwiseAndLooksAtIt) {
  const auto scene = loadScene("builtin:mirrors?count=1");  // stands still: only the camera moves
  const std::string camera = "orbit?target=1;2;3&radius=4&height=3&period=2";
  const vec3 target(1, 2, 3);
  const auto start = makeSnapshot(scene, 0, camera, 1.0), quarter = makeSnapshot(scene, 15, camera, 1.0);
  expectNear(vec3(start->camera.origin), target + vec3(0, 3, 4), 1e-5f);
  expectNear(vec3(quarter->camera.origin), target + vec3(4, 3, 0), 1e-5f);
  expectNear(vec3(quarter->camera.forward), glm::normalize(vec3(-4, -3, 0)), 1e-6f);
  EXPECT_EQ(contentHash(*start), contentHash(*makeSnapshot(scene, 60, camera, 1.0)));
  EXPECT_NE(contentHash(*start), contentHash(*quarter));
}

TEST(Orbit, GoesOnWhileTheSceneLoops) {
  const auto scene = loadScene("builtin:teapot");  // loops after 60 frames
  const std::string camera = "orbit?period=8";
  const auto first = makeSnapshot(scene, 10, camera, 1.0), second = makeSnapshot(scene, 70, camera, 1.0);
  EXPECT_EQ(first->instances.back().worldFromObject, second->instances.back().worldFromObject);
  EXPECT_NE(first->camera.origin, second->camera.origin);
}

// The bounding sphere fits the field of view: its distance is at least radius / sin(fov / 2).
TEST(Orbit, WithoutParameters_FramesTheScene) {
  const auto snapshot = makeSnapshot(loadScene("builtin:mirrors?count=3"), 7, "orbit", 1.0);
  Bounds bounds;
  for (const SnapshotInstance& instance : snapshot->instances) bounds.include(instance.worldBounds);
  const float distance = glm::distance(vec3(snapshot->camera.origin), bounds.centre());
  const float tangent = glm::length(vec3(snapshot->camera.down));
  EXPECT_NEAR(distance * std::sin(std::atan(tangent)), 0.5f * glm::length(bounds.extent()), 1e-3f * distance);
}

TEST(Orbit, BadParameters_AreRefused) {
  const auto scene = loadScene("builtin:teapot");
  const auto refuses = [&](const char* camera, const char* message) {
    EXPECT_THAT([&] { makeSnapshot(scene, 0, camera, 1.0); }, ThrowsMessage<Error>(HasSubstr(message))) << camera;
  };
  refuses("orbit?radius=0", "radius");
  refuses("orbit?target=1;2", "target wants x;y;z");
  refuses("orbit?target=1;2;3;4", "target wants x;y;z");
  refuses("orbit?target=a;2;3", "target wants x;y;z");
  refuses("orbit?raduis=3", "nearest is 'radius'");
  refuses("orbti", "nearest is 'orbit'");
}

// Of a turn by 90 degrees and 10 m: smoothstep(1/4) = 3/16 - 2/64 = 5/32 of both, on the great circle.
TEST(EasedBetween, FollowsSmoothstep) {
  const CameraPose a{vec3(0), glm::angleAxis(0.0f, vec3(0, 1, 0))};
  const CameraPose b{vec3(10, 0, 0), glm::angleAxis(glm::half_pi<float>(), vec3(0, 1, 0))};
  const CameraPose quarter = easedBetween(a, b, 0.25f);
  expectNear(quarter.eye, vec3(10.0f * 5 / 32, 0, 0), 1e-5f);
  EXPECT_NEAR(glm::angle(quarter.rotation), glm::half_pi<float>() * 5 / 32, 1e-5f);
  EXPECT_EQ(easedBetween(a, b, -1.0f).eye, a.eye);
  EXPECT_EQ(easedBetween(a, b, 2.0f).eye, b.eye);
}

TEST(CameraPath, IsPlayedThroughTheTracksOfItsNode_AlsoFromAFile) {
  Scene scene;
  scene.environment = makeProceduralSky();
  addInstance(scene, "box", finishMesh(makeBoxMesh(vec3(1.0f))),
              addMaterial(scene, makeDiffuseMaterial("matte", vec3(0.5f))));
  const CameraPose a = lookAt(vec3(0, 0, 5), vec3(0)), b = lookAt(vec3(5, 1, 0), vec3(0));
  addCameraPath(scene, "path", 2.0, 0.7f, 0.1f,
                [&](double t) { return easedBetween(a, b, static_cast<float>(t / 2)); });
  finishScene(scene);
  const TemporaryFolder folder;
  saveGlb(scene, folder.file("path.glb"));
  const auto loaded = shared(loadGltf(folder.file("path.glb")));
  const auto original = shared(std::move(scene));
  for (const int frame : {0, 13, 30, 59}) {
    const auto snapshot = makeSnapshot(original, frame, "path", 1.5);
    // Between samples, 1/30 s apart, frames are on them: only rounding is left.
    expectNear(vec3(snapshot->camera.origin), easedBetween(a, b, static_cast<float>(frame) / 60.0f).eye, 1e-4f);
    EXPECT_EQ(snapshot->camera.origin, makeSnapshot(loaded, frame, "path", 1.5)->camera.origin);
    EXPECT_EQ(snapshot->camera.right, makeSnapshot(loaded, frame, "path", 1.5)->camera.right);
  }
}

TEST(CameraPath, OfCrtHeap_StartsOnAnOrbitAndStopsBeforeScreens) {
  const auto scene = loadScene("builtin:crt-heap");
  EXPECT_EQ(scene->cameras.front().name, "Camera");
  EXPECT_EQ(scene->durationSeconds, 12.0);
  const auto at = [&](double seconds) {
    return vec3(makeSnapshot(scene, static_cast<int>(std::lround(30 * seconds)), "Tour", 1.5)->camera.origin);
  };
  const auto toAxis = [&](double seconds) { return glm::length(glm::vec2(at(seconds).x, at(seconds).z)); };
  EXPECT_NEAR(toAxis(0), 5.2f, 1e-3f);
  EXPECT_NEAR(toAxis(3), 5.2f, 1e-3f);
  expectNear(at(6.0), at(6.5), 1e-4f);  // before the first screen
  expectNear(at(8.7), at(9.3), 1e-4f);  // before the second one
  EXPECT_GT(glm::distance(at(6.0), at(9.0)), 0.5f);
}

// A camera below a turning node: what glTF files do.
TEST(Camera, OfANodeWhoseParentTurns_MovesWithIt) {
  GltfFile file;
  const float h = std::sqrt(0.5f);
  const int times = file.add<float>({0, 1}, "SCALAR", 5126);
  const int turns = file.add<float>({0, 0, 0, 1, 0, h, 0, h}, "VEC4", 5126);
  file.json["nodes"].push_back({{"name", "arm"}, {"children", {2}}});
  file.json["nodes"].push_back({{"name", "eye"}, {"camera", 0}, {"translation", {0, 0, 4}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
  file.json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}},
                              {"samplers", {{{"input", times}, {"output", turns}}}}}};
  const auto scene = shared(file.load());
  expectNear(vec3(makeSnapshot(scene, 0, "eye", 1.0)->camera.origin), vec3(0, 0, 4), 1e-6f);
  const auto half = makeSnapshot(scene, 15, "eye", 1.0);
  expectNear(vec3(half->camera.origin), 4.0f * vec3(h, 0, h), 1e-5f);
  expectNear(vec3(half->camera.forward), -vec3(h, 0, h), 1e-6f);
}

TEST(Environments, FollowEachOtherInTime) {
  const auto scene = loadScene("builtin:mirrors?count=1&environment=black;white@2;sky@3");
  EXPECT_EQ(scene->durationSeconds, 4.0) << "the last one is there as long as the one before";
  const auto radiance = [&](int frame) {
    return environmentRadiance(makeSnapshot(scene, frame, "", 1.0)->environment(), vec3(0, 1, 0)).x;
  };
  EXPECT_EQ(radiance(0), 0.0f);
  EXPECT_EQ(radiance(59), 0.0f);
  EXPECT_EQ(radiance(60), 1.0f);
  EXPECT_EQ(makeSnapshot(scene, 90, "", 1.0)->environment().name, "sky");
  EXPECT_EQ(radiance(120), 0.0f) << "the loop begins anew";
  EXPECT_EQ(contentHash(*makeSnapshot(scene, 10, "", 1.0)), contentHash(*makeSnapshot(scene, 20, "", 1.0)));
  EXPECT_NE(contentHash(*makeSnapshot(scene, 10, "", 1.0)), contentHash(*makeSnapshot(scene, 70, "", 1.0)));
}

TEST(Environments, WithParameters_StandInParentheses) {
  const auto scene = loadScene("builtin:teapot?environment=(black;constant?r=1&g=2&b=3@1)&fps=2");
  EXPECT_EQ(environmentRadiance(makeSnapshot(scene, 2, "", 1.0)->environment(), vec3(0, 1, 0)), vec3(1, 2, 3));
}

TEST(Environments, SavedAndLoaded_AreTheSame) {
  Scene scene = *loadScene("builtin:mirrors?count=1&environment=sky;white@1.5");
  std::vector<ImageRgba> faces;
  for (int f = 0; f < 6; ++f) faces.emplace_back(4, 4, glm::vec4(0.1f * static_cast<float>(f), 12.5f, 1e-5f, 1.0f));
  scene.environmentChanges.push_back({2.5, makeCubeEnvironment("room", faces)});
  const TemporaryFolder folder;
  saveGlb(scene, folder.file("scene.glb"));
  const auto loaded = shared(loadGltf(folder.file("scene.glb")));
  ASSERT_EQ(loaded->environmentChanges.size(), 2U);
  EXPECT_EQ(loaded->environmentChanges[1].timeSeconds, 2.5);
  EXPECT_EQ(loaded->environmentChanges[1].environment.faces, faces);
  EXPECT_EQ(loaded->durationSeconds, 3.5);
  finishScene(scene);
  const auto original = shared(std::move(scene));
  for (const int frame : {0, 50, 80})
    EXPECT_EQ(contentHash(*makeSnapshot(original, frame, "", 1.0)), contentHash(*makeSnapshot(loaded, frame, "", 1.0)));
}

TEST(Environments, WithoutTheirTimeOrOutOfOrder_AreRefused) {
  const auto refuses = [](const std::string& environments, const char* message) {
    EXPECT_THAT([&] { loadScene("builtin:teapot?environment=" + environments); },
                ThrowsMessage<Error>(HasSubstr(message)))
        << environments;
  };
  refuses("sky;black", "want their time");
  refuses("sky;black@x", "want their time");
  refuses("sky;black@2;white@1", "want increasing times above 0, 'constant' has 1 s after 2 s");
  refuses("sky;black@0", "want increasing times");
  refuses("sky;nosuch.exr@1", "nosuch.exr");
}

TEST(LoadScene, WithFramesPerSecondOrTimeStep_SetsTheTimeOfFrames) {
  EXPECT_EQ(loadScene("builtin:teapot?fps=12")->framesPerSecond, 12.0);
  EXPECT_EQ(makeSnapshot(loadScene("builtin:teapot?time_step=0.25"), 3, "", 1.0)->timeSeconds, 0.75);
  EXPECT_THAT([] { loadScene("builtin:teapot?fps=12&time_step=1"); }, ThrowsMessage<Error>(HasSubstr("say the same")));
  EXPECT_THAT([] { loadScene("builtin:teapot?fps=0"); }, ThrowsMessage<Error>(HasSubstr("fps wants a number")));
}

}  // namespace
}  // namespace pb
