// Whole glTF files: lights, cameras, animation, where data lies, options of the reference, real files.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>

#include "scenes/environment.h"
#include "scenes/snapshot.h"
#include "tests/unit/gltf_file.h"

namespace pb {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr float kPi = 3.14159265f;

TEST(GltfLights, AreRadiometric_AndShineAlongMinusZ) {
  GltfFile file;
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = json::parse(R"([
    {"type": "directional", "color": [1, 0.5, 0.25], "intensity": 4},
    {"type": "spot", "intensity": 2, "range": 7, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.4}},
    {"type": "point"}])");
  for (int i = 0; i < 3; ++i) {
    file.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    file.json["scenes"][0]["nodes"].push_back(i + 1);
  }
  const Scene scene = file.load();
  ASSERT_EQ(scene.lights.size(), 3U);
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(4, 2, 1));
  EXPECT_EQ(scene.lights[1].kind, shading::kLightSpot);
  EXPECT_EQ(scene.lights[1].range, 7.0f);
  EXPECT_EQ(scene.lights[1].innerConeAngle, 0.2f);
  EXPECT_EQ(scene.lights[2].kind, shading::kLightPoint);
  EXPECT_EQ(scene.lights[2].intensity, glm::vec3(1.0f));
  // Lights without surroundings: nothing else shines.
  EXPECT_EQ(environmentRadiance(scene.environment, {0, 1, 0}), glm::vec3(0.0f));
  EXPECT_THAT(scene.notes, Contains(HasSubstr("black")));
}

TEST(GltfScene, WithoutLightAndCamera_GetsTheSkyAndAFramingCamera) {
  const Scene scene = GltfFile().load();
  EXPECT_EQ(scene.environment.name, makeProceduralSky().name);
  ASSERT_EQ(scene.cameras.size(), 1U);
  EXPECT_THAT(scene.notes, Contains(HasSubstr("procedural sky")));
  EXPECT_THAT(scene.notes, Contains(HasSubstr("camera")));
}

TEST(GltfScene, GivenAnEnvironment_UsesItInsteadOfItsOwn) {
  const Environment white = makeConstantEnvironment(glm::vec3(1.0f));
  GltfFile file;
  file.json["scenes"][0]["extras"]["skyRadiance"] = 0.25;
  EXPECT_EQ(environmentRadiance(file.load().environment, {0, 1, 0}), glm::vec3(0.25f));
  EXPECT_EQ(environmentRadiance(loadGltf(file.folder().file("test.glb"), white).environment, {0, 1, 0}),
            glm::vec3(1.0f));
}

TEST(GltfCameras, Perspective_IsRead) {
  GltfFile file;
  file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}}};
  file.json["nodes"].push_back({{"name", "eye"}, {"camera", 0}, {"translation", {0, 0, 5}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = file.load();
  ASSERT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(scene.cameras[0].name, "eye");
  EXPECT_EQ(scene.cameras[0].verticalFov, 0.5f);
  EXPECT_EQ(scene.cameras[0].zNear, 0.25f);
}

// An animation of the triangle with keys at 0 and 2 seconds.
Track loadTrack(const std::string& path, const std::string& interpolation, const std::vector<float>& values) {
  GltfFile file;
  const int times = file.add<float>({0, 2}, "SCALAR", 5126);
  const int output = file.add(values, path == "rotation" ? "VEC4" : "VEC3", 5126);
  file.json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}},
       {"samplers", {{{"input", times}, {"output", output}, {"interpolation", interpolation}}}}}};
  const Scene scene = file.load();
  EXPECT_EQ(scene.durationSeconds, 2.0);
  return scene.tracks.at(0);
}

TEST(GltfAnimation, OfEachInterpolation_IsSampledAsSpecified) {
  const Track step = loadTrack("translation", "STEP", {0, 0, 0, 1, 2, 3});
  EXPECT_EQ(glm::vec3(sampleTrack(step, 1.9)), glm::vec3(0.0f));
  const Track linear = loadTrack("scale", "LINEAR", {1, 1, 1, 3, 5, 7});
  EXPECT_EQ(linear.target, TrackTarget::scale);
  EXPECT_EQ(glm::vec3(sampleTrack(linear, 0.5)), glm::vec3(1.5f, 2.0f, 2.5f));
  const float h = std::sqrt(0.5f);
  const Track slerp = loadTrack("rotation", "LINEAR", {0, 0, 0, 1, 0, 0, h, h});
  const glm::vec4 quarterWay = sampleTrack(slerp, 1.0);  // half of 90 degrees: 45, so half-angle 22.5
  EXPECT_NEAR(quarterWay.z, std::sin(kPi / 8), 1e-6);
  EXPECT_NEAR(quarterWay.w, std::cos(kPi / 8), 1e-6);
  // Hermite: value 0 with slope 1 to value 0 with slope 0 over 2 s; at the middle t^3 - 2 t^2 + t = 1/8, times 2 s.
  const Track spline = loadTrack("translation", "CUBICSPLINE", {0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_NEAR(sampleTrack(spline, 1.0).x, 0.25f, 1e-6);
}

TEST(GltfAnimation, OfTheSamePropertyTwice_KeepsTheFirstAndSaysSo) {
  GltfFile file;
  const int times = file.add<float>({0, 1}, "SCALAR", 5126);
  const int values = file.add<float>({0, 0, 0, 1, 0, 0}, "VEC3", 5126);
  const json animation = {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
                          {"samplers", {{{"input", times}, {"output", values}}}}};
  file.json["animations"] = {animation, animation};
  const Scene scene = file.load();
  EXPECT_EQ(scene.tracks.size(), 1U);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("twice")));
}

TEST(GltfFiles, WithEmbeddedOrExternalData_AreTheSame) {
  GltfFile file;
  file.material()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", file.addTexture(grayPng(0.5f))}};
  const Scene embedded = file.load();
  json document = file.json;
  document["buffers"][0]["uri"] = "some%20data.bin";
  document["images"][0] = {{"uri", "image.png"}};
  writeFileAtomically(file.folder().file("some data.bin"), file.data());
  writeFileAtomically(file.folder().file("image.png"), grayPng(0.5f));
  writeFileAtomically(file.folder().file("scene.gltf"), document.dump());
  const Scene external = loadGltf(file.folder().file("scene.gltf"));
  EXPECT_EQ(onlyMesh(external).contentHash, onlyMesh(embedded).contentHash);
  EXPECT_EQ(external.textures.at(0).levels, embedded.textures.at(0).levels);
}

// --- Mirrors by reference

TEST(LoadScene, WithMirrorOption_ReplacesTheMaterialsBelowTheNode) {
  GltfFile file;
  file.material()["doubleSided"] = true;
  file.json["nodes"] = json::parse(R"([{"name": "plain", "mesh": 0}, {"name": "group", "children": [2]},
                                       {"name": "leaf", "mesh": 0}])");
  file.json["scenes"][0]["nodes"] = {0, 1};
  file.load();
  const auto scene = loadScene(file.folder().file("test.glb") + "?mirror=group&environment=white");
  const auto materialOf = [&](std::size_t instance) {
    return scene->materials[static_cast<std::size_t>(scene->instances.at(instance).material)];
  };
  EXPECT_FALSE(materialOf(0).isSpecularDominant);
  EXPECT_TRUE(materialOf(1).isSpecularDominant);
  EXPECT_TRUE(materialOf(1).doubleSided);
  EXPECT_EQ(environmentRadiance(scene->environment, {1, 0, 0}), glm::vec3(1.0f));
  const auto all = loadScene(file.folder().file("test.glb") + "?mirror=all");
  EXPECT_EQ(makeSnapshot(all, 0, "", 1.0)->probes.size(), 2U);
}

TEST(LoadScene, OfABuiltinScene_TakesAnEnvironment) {
  const auto scene = loadScene("builtin:mirrors?count=2&environment=black");
  EXPECT_EQ(makeSnapshot(scene, 0, "", 1.0)->probes.size(), 2U);
  EXPECT_EQ(environmentRadiance(scene->environment, {1, 0, 0}), glm::vec3(0.0f));
}

// --- Real files, where they are there

std::string realAsset(const std::string& name) { return PROBEBENCH_SOURCE_DIR "/../shared/" + name; }

#define SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not on this machine"

TEST(RealAssets, Draco_IsDecoded) {
  const std::string path = realAsset("assets/gltf/suzi.glb");
  SKIP_WITHOUT(path);
  const Scene scene = loadGltf(path);
  // The file declares 44526 indices and the bounds below.
  EXPECT_EQ(onlyMesh(scene).triangleCount(), 44526U / 3);
  EXPECT_NEAR(onlyMesh(scene).bounds.upper.x, 0.92973f, 1e-4f);
  EXPECT_NEAR(onlyMesh(scene).bounds.lower.y, -0.66979f, 1e-4f);
}

TEST(RealAssets, FlightHelmet_HasItsTexturesAndUnderTheOptionItsMirrors) {
  const std::string path = realAsset("assets/gltf/FlightHelmet/FlightHelmet.gltf");
  SKIP_WITHOUT(path);
  const auto scene = loadScene(path + "?mirror=all&environment=" + realAsset("assets/hdri/lobby.exr"));
  EXPECT_EQ(scene->instances.size(), 6U);
  EXPECT_EQ(scene->textures.size(), 15U);
  EXPECT_EQ(makeSnapshot(scene, 0, "", 1.0)->probes.size(), 6U);
}

TEST(RealAssets, CubeCameraBenchmark_IsTheBuiltinScene) {
  const std::string path = realAsset("peers/three-cubecamera/scene-mirrors8.glb");
  SKIP_WITHOUT(path);
  const auto file = loadScene(path), builtin = loadScene("builtin:mirrors?count=8");
  const auto a = makeSnapshot(file, 0, "", 1.0), b = makeSnapshot(builtin, 0, "", 1.0);
  ASSERT_EQ(a->instances.size(), b->instances.size());
  for (std::size_t i = 0; i < a->instances.size(); ++i) {
    EXPECT_EQ(a->instances[i].mesh->triangleCount(), b->instances[i].mesh->triangleCount());
    // Float rounding of positions up to 10 m.
    EXPECT_LT(glm::distance(a->instances[i].worldBounds.lower, b->instances[i].worldBounds.lower), 2e-6f) << i;
    EXPECT_LT(glm::distance(a->instances[i].worldBounds.upper, b->instances[i].worldBounds.upper), 2e-6f) << i;
    const shading::MaterialConstants &m = a->materialOf(a->instances[i]).constants,
                                     &n = b->materialOf(b->instances[i]).constants;
    EXPECT_EQ(m.kind.x, n.kind.x) << i;
    EXPECT_LT(glm::distance(m.baseColor, n.baseColor), 1e-6f) << i;
    if (m.kind.x == shading::kSurfaceDiffuse) {
      EXPECT_EQ(m.specular.w, 0.0f) << i;
    }
  }
  EXPECT_EQ(a->probes.size(), 8U);
  const glm::vec3 d = glm::normalize(glm::vec3(0.3f, 0.4f, -0.5f));
  EXPECT_LT(glm::distance(environmentRadiance(file->environment, d), environmentRadiance(builtin->environment, d)),
            1e-6f);
}

}  // namespace
}  // namespace pb
