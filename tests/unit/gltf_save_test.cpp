// Scenes written as .glb and loaded again.
#include "scenes/gltf_save.h"

#include <gmock/gmock.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "bench/json_document.h"
#include "scenes/describe.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/gltf_load.h"
#include "scenes/snapshot.h"
#include "tests/temporary_folder.h"

namespace pb {
namespace {

using ::testing::HasSubstr;

template <class T>
bool sameBytes(const T& a, const T& b) {
  static_assert(std::is_standard_layout_v<T>);
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

float largestDifference(const ImageRgba& a, const ImageRgba& b) {
  float largest = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 4; ++c) largest = std::max(largest, std::abs(a[i][c] - b[i][c]));
  return largest;
}

std::shared_ptr<const Scene> savedAndLoaded(const Scene& scene) {
  const TemporaryFolder folder;
  saveGlb(scene, folder.file("scene.glb"));
  return std::make_shared<const Scene>(loadGltf(folder.file("scene.glb")));
}

class BuiltinExport : public ::testing::TestWithParam<const char*> {
 protected:
  std::shared_ptr<const Scene> original_ = loadScene(GetParam());
  std::shared_ptr<const Scene> loaded_ = savedAndLoaded(*original_);
};

TEST_P(BuiltinExport, KeepsGeometryAndTransformsBitByBit) {
  for (const int frame : {0, 7}) {
    const auto a = makeSnapshot(original_, frame, "", 1.5), b = makeSnapshot(loaded_, frame, "", 1.5);
    ASSERT_EQ(a->instances.size(), b->instances.size());
    for (std::size_t i = 0; i < a->instances.size(); ++i) {
      EXPECT_EQ(a->instances[i].mesh->contentHash, b->instances[i].mesh->contentHash) << i;
      EXPECT_EQ(a->instances[i].worldFromObject, b->instances[i].worldFromObject) << i;
      EXPECT_EQ(a->instances[i].probe, b->instances[i].probe) << i;
    }
    EXPECT_TRUE(sameBytes(a->camera, b->camera));
  }
}

TEST_P(BuiltinExport, KeepsMaterialsLightsAndSky) {
  ASSERT_EQ(original_->materials.size(), loaded_->materials.size());
  for (std::size_t m = 0; m < original_->materials.size(); ++m) {
    EXPECT_TRUE(sameBytes(original_->materials[m].constants, loaded_->materials[m].constants))
        << original_->materials[m].name;
    EXPECT_EQ(original_->materials[m].doubleSided, loaded_->materials[m].doubleSided);
  }
  ASSERT_EQ(original_->lights.size(), loaded_->lights.size());
  for (std::size_t l = 0; l < original_->lights.size(); ++l)
    EXPECT_EQ(original_->lights[l].intensity, loaded_->lights[l].intensity);
  EXPECT_TRUE(sameBytes(original_->environment.sky, loaded_->environment.sky));
  EXPECT_TRUE(sameBytes(original_->environment.ambient, loaded_->environment.ambient));
  EXPECT_EQ(original_->probeNear, loaded_->probeNear);
  EXPECT_EQ(original_->framesPerSecond, loaded_->framesPerSecond);
  EXPECT_EQ(original_->durationSeconds, loaded_->durationSeconds);
}

TEST_P(BuiltinExport, KeepsTexturesToSixteenBits) {
  // Textures in several roles are written in the order of the materials, so they are compared through these. Half a
  // step of 16 bits, times the largest slope of the sRGB decoding, 2.28.
  const float tolerance = 2.28f * 0.5f / 65535.0f + 1e-7f;
  const auto level0 = [](const Scene& scene, int texture) {
    return scene.textures[static_cast<std::size_t>(texture)].levels[0];
  };
  for (std::size_t m = 0; m < original_->materials.size(); ++m)
    for (const auto slot : {&Material::baseColorTexture, &Material::metallicRoughnessTexture, &Material::normalTexture,
                            &Material::emissionTexture, &Material::occlusionTexture}) {
      const int a = original_->materials[m].*slot, b = loaded_->materials[m].*slot;
      ASSERT_EQ(a < 0, b < 0);
      if (a < 0) continue;
      EXPECT_LT(largestDifference(level0(*original_, a), level0(*loaded_, b)), tolerance);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, BuiltinExport,
                         ::testing::Values("builtin:mirrors?count=3", "builtin:control", "builtin:teapot"),
                         [](const auto& test) { return std::string(test.param).substr(8, 6); });

TEST(SaveGlb, OfTexturesOfBytes_LosesNothing) {
  const auto scene = loadScene("builtin:mirrors?count=1");  // its ground is a checker of two bytes
  const auto loaded = savedAndLoaded(*scene);
  EXPECT_EQ(contentHash(*makeSnapshot(scene, 0, "", 1.0)), contentHash(*makeSnapshot(loaded, 0, "", 1.0)));
}

Scene makeOddScene() {
  Scene scene = *loadScene("builtin:mirrors?count=1");
  Material glass = makeDiffuseMaterial("glass", glm::vec3(0.9f));
  glass.constants.kind = {shading::kSurfaceGlass, 1.33f, 0.5f, 0.1f};
  glass.constants.factors = {0.0f, 0.0f, 1.0f, 0.9f};
  glass.constants.specular.w = 0.5f;
  setAttenuation(glass, {0.5f, 1.0f, 0.25f}, 2.0f);
  Material screen = makeDiffuseMaterial("screen", glm::vec3(0.5f));
  screen.constants.emission = {100.0f, 3.0f, 0.1f, 1.0f};
  shading::TextureSlot& slot = screen.constants.baseColorSlot;
  slot.offset = {0.25f, 0.5f, 1.0f, 1.0f};
  slot.matrix = {0.6f, -0.8f, -1.6f, -1.2f};  // turned and mirrored
  slot.sampler_ = {shading::kWrapMirror, shading::kWrapClamp, shading::kFilterLinear, shading::kFilterNearestMipLinear};
  screen.baseColorTexture = 0;
  Material lamp = makeDiffuseMaterial("lamp", glm::vec3(1.0f));
  lamp.constants.kind.x = shading::kSurfaceUnlit;
  scene.materials = {glass, screen, lamp};
  for (std::size_t i = 0; i < scene.instances.size(); ++i) scene.instances[i].material = static_cast<int>(i % 3);
  scene.nodes[0].probe = ProbeSettings{.enabled = false, .position = glm::vec3(1, 2, 3)};
  scene.cameras.push_back(scene.cameras[0]);
  scene.cameras.back().name = "second";
  scene.lights.push_back(scene.lights[0]);
  return scene;
}

TEST(SaveGlb, OfEveryMaterialFeature_LoadsThemBack) {
  const Scene scene = makeOddScene();
  const auto loaded = savedAndLoaded(scene);
  const Material& glass = loaded->materials.at(0);
  EXPECT_TRUE(sameBytes(glass.constants, scene.materials[0].constants));
  EXPECT_EQ(glass.constants.kind.z, 0.5f);
  EXPECT_EQ(glass.attenuationDistance, 2.0f);
  EXPECT_EQ(glass.attenuationColor, scene.materials[0].attenuationColor);
  EXPECT_EQ(glass.constants.kind.w, 0.1f);
  EXPECT_EQ(glass.constants.specular.w, 0.5f);
  const shading::MaterialConstants& screen = loaded->materials.at(1).constants;
  EXPECT_EQ(screen.emission, scene.materials[1].constants.emission);
  EXPECT_EQ(screen.baseColorSlot.offset, scene.materials[1].constants.baseColorSlot.offset);
  EXPECT_EQ(screen.baseColorSlot.sampler_, scene.materials[1].constants.baseColorSlot.sampler_);
  // Rotation and scale are taken apart and put together again.
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(screen.baseColorSlot.matrix[i], scene.materials[1].constants.baseColorSlot.matrix[i], 1e-6);
  EXPECT_EQ(loaded->materials.at(2).constants.kind.x, shading::kSurfaceUnlit);
}

TEST(SaveGlb, OfProbesAndSeveralCamerasAtANode_LoadsThemBack) {
  const Scene scene = makeOddScene();
  const auto loaded = savedAndLoaded(scene);
  ASSERT_TRUE(loaded->nodes.at(0).probe.has_value());
  EXPECT_FALSE(loaded->nodes[0].probe->enabled);
  EXPECT_EQ(loaded->nodes[0].probe->position, glm::vec3(1, 2, 3));
  EXPECT_EQ(loaded->cameras.size(), scene.cameras.size());
  EXPECT_EQ(loaded->lights.size(), scene.lights.size());
}

TEST(SaveGlb, OfACubeMapEnvironment_KeepsItsFacesBitByBit) {
  Scene scene = *loadScene("builtin:mirrors?count=1");
  std::vector<ImageRgba> faces;
  for (int f = 0; f < 6; ++f) faces.emplace_back(4, 4, glm::vec4(0.1f * static_cast<float>(f), 1234.5f, 1e-5f, 1.0f));
  scene.environment = makeCubeEnvironment("room", faces);
  const auto loaded = savedAndLoaded(scene);
  EXPECT_EQ(loaded->environment.name, "room");
  EXPECT_EQ(loaded->environment.faces, faces);
  EXPECT_TRUE(sameBytes(loaded->environment.ambient, scene.environment.ambient));
}

// The JSON of a .glb: its first chunk, after 20 bytes of headers.
nlohmann::json jsonOf(const std::string& glb) {
  std::uint32_t length = 0;
  std::memcpy(&length, &glb[12], sizeof length);
  return nlohmann::json::parse(glb.substr(20, length));
}

TEST(SaveGlb, WritesExtrasThatMatchTheirSchema) {
  const TemporaryFolder folder;
  const std::string schema = readFile(PROBEBENCH_SOURCE_DIR "/results/schema/scene-extras.schema.json");
  Scene cube = *loadScene("builtin:mirrors?count=1");
  cube.environment = makeCubeEnvironment("room", std::vector<ImageRgba>(6, ImageRgba(1, 1)));
  for (const Scene& scene : {*loadScene("builtin:teapot"), cube}) {
    saveGlb(scene, folder.file("scene.glb"));
    nlohmann::json extras = jsonOf(readFile(folder.file("scene.glb")))["scenes"][0]["extras"]["probebench"];
    EXPECT_NO_THROW(parsePart(extras.dump(), "extras", schema));
    extras["environment"]["ambient"].erase(0);
    EXPECT_THROW(parsePart(extras.dump(), "extras", schema), Error);
  }
}

TEST(SaveGlb, WhereItCannotWrite_IsAnEnvironmentError) {
  const auto scene = loadScene("builtin:mirrors?count=1");
  try {
    saveGlb(*scene, "/nonexistent/scene.glb");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Failure::environment);
  }
}

TEST(Describe, SaysWhatIsReflectiveAndWhatIsNot) {
  const std::string mirrors = describe(*loadScene("builtin:mirrors?count=2"));
  EXPECT_THAT(mirrors, HasSubstr("reflective 'Mirror_1'"));
  EXPECT_THAT(mirrors, HasSubstr("instances  15 with"));
  EXPECT_THAT(describe(*loadScene("builtin:control")), HasSubstr("reflective nothing"));
  EXPECT_THAT(describe(*loadScene("builtin:teapot")), HasSubstr("duration   2 s"));
}

}  // namespace
}  // namespace pb
