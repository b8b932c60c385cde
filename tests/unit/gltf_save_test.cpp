// Scenes written as .glb and loaded again.
#include "scenes/gltf_save.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "bench/json_document.h"
#include "scenes/builtin.h"
#include "scenes/describe.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/gltf_load.h"
#include "scenes/screen.h"
#include "scenes/snapshot.h"
#include "tests/unit/gltf_file.h"

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

// Every member of a material but its textures, which are renumbered.
void expectSame(const Material& a, const Material& b) {
  EXPECT_TRUE(sameBytes(a.constants, b.constants)) << a.name;
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.screen, b.screen) << a.name;
  EXPECT_EQ(a.doubleSided, b.doubleSided) << a.name;
  EXPECT_EQ(a.isSpecularDominant, b.isSpecularDominant) << a.name;
  EXPECT_EQ(a.attenuationDistance, b.attenuationDistance) << a.name;
  EXPECT_EQ(a.attenuationColor, b.attenuationColor) << a.name;
}

void expectSame(const PunctualLight& a, const PunctualLight& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.range, b.range);
  if (a.kind != shading::kLightSpot) return;
  EXPECT_EQ(a.innerConeAngle, b.innerConeAngle);
  EXPECT_EQ(a.outerConeAngle, b.outerConeAngle);
}

void expectSame(const Screen& a, const Screen& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.program, b.program) << a.name;
  EXPECT_EQ(a.widthPx, b.widthPx) << a.name;
  EXPECT_EQ(a.heightPx, b.heightPx) << a.name;
  EXPECT_EQ(a.periodSeconds, b.periodSeconds) << a.name;
  EXPECT_EQ(a.phase, b.phase) << a.name;
}

template <class T>
void expectSame(const std::vector<T>& a, const std::vector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) expectSame(a[i], b[i]);
}

class BuiltinExport : public ::testing::TestWithParam<std::string> {
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
  expectSame(original_->materials, loaded_->materials);
  expectSame(original_->lights, loaded_->lights);
  expectSame(original_->screens, loaded_->screens);
  EXPECT_EQ(original_->castsShadows, loaded_->castsShadows);
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

std::vector<std::string> builtinReferences() {
  std::vector<std::string> references;
  for (const BuiltinScene& scene : builtinScenes()) references.push_back(fmt::format("builtin:{}", scene.name));
  return references;
}

INSTANTIATE_TEST_SUITE_P(Scenes, BuiltinExport, ::testing::ValuesIn(builtinReferences()), [](const auto& test) {
  std::string name = test.param.substr(8);
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(SaveGlb, OfTexturesOfBytes_LosesNothing) {
  const auto scene = loadScene("builtin:mirrors?count=1");  // its ground is a checker of two bytes
  const auto loaded = savedAndLoaded(*scene);
  EXPECT_EQ(contentHash(*makeSnapshot(scene, 0, "", 1.0)), contentHash(*makeSnapshot(loaded, 0, "", 1.0)));
}

Material makeLeaf() {
  Material leaf = makeDiffuseMaterial("leaf", {0.1f, 0.6f, 0.2f});
  leaf.constants.baseColor.w = 0.75f;
  leaf.constants.alpha = {shading::kAlphaMask, 0.375f, 0.0f, 0.0f};
  leaf.doubleSided = true;
  return leaf;
}

// Johnson and Christy, "Optical Constants of the Noble Metals" (1972), about 630, 530 and 465 nm.
Material makeGold(float roughness) {
  Material gold = makeMetalMaterial("gold", {0.18f, 0.54f, 1.34f}, {3.1f, 2.2f, 1.9f}, roughness);
  gold.constants.alpha.x = shading::kAlphaBlend;
  return gold;
}

Scene makeOddScene() {
  Scene scene = *loadScene("builtin:mirrors?count=1");
  Material glass = makeDiffuseMaterial("glass", glm::vec3(0.9f));
  glass.constants.kind = {shading::kSurfaceGlass, 1.33f, 0.5f, 0.1f};
  glass.constants.factors = {0.0f, 0.0f, 1.0f, 0.9f};
  glass.constants.specular = {1.0f, 0.75f, 0.5f, 0.5f};
  glass.isSpecularDominant = true;
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
  scene.materials = {glass, screen, lamp, makeLeaf(), makeGold(0.0f), makeGold(0.5f)};
  for (std::size_t program = 0; program < 4; ++program) {
    scene.screens.push_back({fmt::format("screen {}", program), static_cast<float>(program), 32, 24, 2.5f, 0.25f});
    scene.materials.push_back(makeDiffuseMaterial("shows a screen", glm::vec3(0.0f)));
    showScreen(scene.materials.back(), static_cast<int>(program), {2.0f, 0.5f, 1.0f});
  }
  scene.castsShadows = true;
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    scene.instances[i].material = static_cast<int>(i % scene.materials.size());
  scene.nodes[0].probe =
      ProbeSettings{.enabled = false, .position = glm::vec3(1, 2, 3), .box = Bounds{{-1, 0, 1}, {2, 3, 4}}};
  scene.room = Bounds{{-10, 0, -10}, {10, 5, 10}};
  scene.cameras.push_back(scene.cameras[0]);
  scene.cameras.back().name = "second";
  scene.lights.push_back(scene.lights[0]);
  return scene;
}

TEST(SaveGlb, OfEveryMaterialFeature_LoadsThemBack) {
  const Scene scene = makeOddScene();
  const auto loaded = savedAndLoaded(scene);
  ASSERT_EQ(loaded->materials.size(), scene.materials.size());
  for (std::size_t m = 0; m < scene.materials.size(); ++m)
    if (m != 1) expectSame(scene.materials[m], loaded->materials[m]);
  const shading::MaterialConstants& screen = loaded->materials.at(1).constants;
  EXPECT_EQ(screen.emission, scene.materials[1].constants.emission);
  EXPECT_EQ(screen.baseColorSlot.offset, scene.materials[1].constants.baseColorSlot.offset);
  EXPECT_EQ(screen.baseColorSlot.sampler_, scene.materials[1].constants.baseColorSlot.sampler_);
  // Rotation and scale are taken apart and put together again.
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(screen.baseColorSlot.matrix[i], scene.materials[1].constants.baseColorSlot.matrix[i], 1e-6);
}

TEST(SaveGlb, OfScreensAndShadows_LoadsThemBack) {
  const Scene scene = makeOddScene();
  const auto loaded = savedAndLoaded(scene);
  expectSame(scene.screens, loaded->screens);
  EXPECT_TRUE(loaded->castsShadows);
}

TEST(LoadGlb, WithAMaterialThatShowsAMissingScreen_IsRefused) {
  Scene scene = makeOddScene();
  scene.screens.pop_back();
  EXPECT_THAT([&] { savedAndLoaded(scene); }, ::testing::ThrowsMessage<Error>(HasSubstr("wants screen 3")));
}

TEST(SaveGlb, OfProbesAndSeveralCamerasAtANode_LoadsThemBack) {
  const Scene scene = makeOddScene();
  const auto loaded = savedAndLoaded(scene);
  ASSERT_TRUE(loaded->nodes.at(0).probe.has_value());
  EXPECT_FALSE(loaded->nodes[0].probe->enabled);
  EXPECT_EQ(loaded->nodes[0].probe->position, glm::vec3(1, 2, 3));
  ASSERT_TRUE(loaded->nodes[0].probe->box && loaded->room);
  EXPECT_TRUE(sameBytes(*loaded->nodes[0].probe->box, *scene.nodes[0].probe->box));
  EXPECT_TRUE(sameBytes(*loaded->room, *scene.room));
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

// The schema of the scene's extras, or of one of its definitions.
std::string schemaOf(const std::string& definition = "") {
  nlohmann::json schema =
      nlohmann::json::parse(readFile(PROBEBENCH_SOURCE_DIR "/results/schema/scene-extras.schema.json"));
  if (definition.empty()) return schema.dump();
  return nlohmann::json{{"$ref", "#/definitions/" + definition}, {"definitions", schema["definitions"]}}.dump();
}

nlohmann::json savedJson(const Scene& scene) {
  const TemporaryFolder folder;
  saveGlb(scene, folder.file("scene.glb"));
  return jsonOf(readFile(folder.file("scene.glb")));
}

TEST(SaveGlb, WritesExtrasThatMatchTheirSchema) {
  Scene cube = *loadScene("builtin:mirrors?count=1");
  cube.environment = makeCubeEnvironment("room", std::vector<ImageRgba>(6, ImageRgba(1, 1)));
  for (const Scene& scene : {*loadScene("builtin:teapot"), makeOddScene(), cube}) {
    nlohmann::json extras = savedJson(scene)["scenes"][0]["extras"]["probebench"];
    EXPECT_NO_THROW(parsePart(extras.dump(), "extras", schemaOf()));
    extras["environment"]["ambient"].erase(0);
    EXPECT_THROW(parsePart(extras.dump(), "extras", schemaOf()), Error);
  }
}

TEST(SaveGlb, WritesExtrasOfMaterialsAndNodesThatMatchTheirSchema) {
  const nlohmann::json file = savedJson(makeOddScene());
  EXPECT_NO_THROW(parsePart(file["nodes"][0]["extras"]["probe"].dump(), "extras", schemaOf("probe")));
  int withExtras = 0;
  for (const nlohmann::json& material : file["materials"]) {
    if (!material.contains("extras")) continue;
    nlohmann::json extras = material["extras"]["probebench"];
    EXPECT_NO_THROW(parsePart(extras.dump(), "extras", schemaOf("material")));
    extras["eta"] = {1, 2};
    EXPECT_THROW(parsePart(extras.dump(), "extras", schemaOf("material")), Error);
    ++withExtras;
  }
  EXPECT_EQ(withExtras, 6);  // two metals, four screens
}

TEST(SaveGlb, WritesWavesAndEnvironmentChangesThatMatchTheirSchema) {
  const nlohmann::json file = savedJson(*loadScene("builtin:flag-and-horse?environment=sky;black@2"));
  EXPECT_NO_THROW(parsePart(file["scenes"][0]["extras"]["probebench"].dump(), "extras", schemaOf()));
  int waves = 0;
  for (const nlohmann::json& node : file["nodes"]) {
    if (!node.contains("extras")) continue;
    nlohmann::json extras = node["extras"]["probebench"];
    EXPECT_NO_THROW(parsePart(extras.dump(), "extras", schemaOf("node")));
    extras["wave"]["length"] = 0;
    EXPECT_THROW(parsePart(extras.dump(), "extras", schemaOf("node")), Error);
    ++waves;
  }
  EXPECT_EQ(waves, 1);
}

// Written by hand: what the loader takes is what the schema allows.
TEST(SceneExtras, BySchemaAndLoader_AreJudgedAlike) {
  const char* const accepted[] = {
      R"({"schema": 1})",
      R"({"schema": 1, "environment": {"constant": 0.5}, "shadows": "traced"})",
      R"({"schema": 1, "room": {"lower": [-1, 0, -1], "upper": [1, 2, 1]}})",
      R"({"schema": 1, "environment": {"sky": {"horizon": 1, "zenith": [0, 0, 1], "below": 0}}})",
      R"({"schema": 1, "environmentChanges": [{"fromSeconds": 2, "environment": {"constant": 0.5}}]})",
      R"({"schema": 1, "screens": [{"program": "rings"}, {"program": "melt", "size": [8, 8], "phase": -0.5}]})",
  };
  const char* const refused[] = {
      R"({"schema": 2})",
      R"({"schema": 1, "shadows": true})",
      R"({"schema": 1, "environment": {}})",
      R"({"schema": 1, "environment": {"constant": 1, "sky": {"horizon": 1, "zenith": 1, "below": 1}}})",
      R"({"schema": 1, "environment": {"constant": [1, 2]}})",
      R"({"schema": 1, "environment": {"sky": {"horizon": 1, "zenith": 1, "below": 1, "glow": 1}}})",
      R"({"schema": 1, "environmentChanges": [{"fromSeconds": 0, "environment": {"constant": 0.5}}]})",
      R"({"schema": 1, "environmentChanges": [{"fromSeconds": 2}]})",
      R"({"schema": 1, "environmentChanges": {"fromSeconds": 2, "environment": {"constant": 0.5}}})",
      R"({"schema": 1, "screens": [{"program": "snow"}]})",
      R"({"schema": 1, "screens": [{"program": "melt", "size": [0, 8]}]})",
      R"({"schema": 1, "probeNear": 0})",
      R"({"schema": 1, "room": {"lower": [-1, 0, -1]}})",
      R"({"schema": 1, "room": {"lower": [-1, 0], "upper": [1, 2]}})",
  };
  const auto loadWith = [](const char* extras) {
    GltfFile file;
    file.json["scenes"][0]["extras"]["probebench"] = nlohmann::json::parse(extras);
    file.load();
  };
  for (const char* extras : accepted) {
    EXPECT_NO_THROW(parsePart(extras, "extras", schemaOf())) << extras;
    EXPECT_NO_THROW(loadWith(extras)) << extras;
  }
  for (const char* extras : refused) {
    EXPECT_THROW(parsePart(extras, "extras", schemaOf()), Error) << extras;
    EXPECT_THROW(loadWith(extras), Error) << extras;
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
