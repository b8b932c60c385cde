// The glTF loader: what a file says is what the scene holds.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>

#include "scenes/describe.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/image_io.h"
#include "scenes/snapshot.h"
#include "tests/unit/gltf_file.h"

namespace pb {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr float kPi = 3.14159265f;

const Mesh& onlyMesh(const Scene& scene) { return *scene.instances.at(0).mesh; }

shading::MaterialConstants constantsOf(GltfFile& file) { return file.load().materials.at(0).constants; }

std::string grayPng(float value) { return encodePng(ImageRgba(2, 2, {value, value, value, 1.0f}), 8); }

// --- Geometry

TEST(GltfGeometry, WithoutIndicesAndNormals_IsFlat) {
  const Scene scene = GltfFile().load();
  EXPECT_THAT(onlyMesh(scene).positions, ElementsAre(glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  EXPECT_THAT(onlyMesh(scene).normals, ::testing::Each(glm::vec3(0, 0, 1)));
}

TEST(GltfGeometry, IndicesOfEverySize_AreRead) {
  GltfFile bytes, shorts, ints;
  bytes.primitive()["indices"] = bytes.add<std::uint8_t>({2, 0, 1}, "SCALAR", 5121);
  shorts.primitive()["indices"] = shorts.add<std::uint16_t>({2, 0, 1}, "SCALAR", 5123);
  ints.primitive()["indices"] = ints.add<std::uint32_t>({2, 0, 1}, "SCALAR", 5125);
  for (GltfFile* file : {&bytes, &shorts, &ints}) {
    // Flat normals split the vertices in the order of the indices.
    const Scene scene = file->load();
    EXPECT_THAT(onlyMesh(scene).positions, ElementsAre(glm::vec3(0, 1, 0), glm::vec3(0), glm::vec3(1, 0, 0)));
  }
}

// A unit square in the plane z = 0 as four vertices.
void makeSquare(GltfFile& file, int mode, const std::vector<float>& positions) {
  file.primitive()["attributes"]["POSITION"] = file.add<float>(positions, "VEC3", 5126);
  file.primitive()["mode"] = mode;
}

TEST(GltfGeometry, StripsAndFans_BecomeTrianglesOfTheSameSide) {
  GltfFile strip, fan;
  makeSquare(strip, 5, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  makeSquare(fan, 6, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  for (GltfFile* file : {&strip, &fan}) {
    const Scene scene = file->load();
    EXPECT_EQ(onlyMesh(scene).triangleCount(), 2U);
    EXPECT_THAT(onlyMesh(scene).normals, ::testing::Each(glm::vec3(0, 0, 1)));
  }
}

TEST(GltfGeometry, SparseAccessors_ReplaceTheirElements) {
  GltfFile file;
  const int indices = file.addBufferView(std::string("\x01\0", 2));
  const float moved[] = {5.0f, 6.0f, 7.0f};
  const int values = file.addBufferView({reinterpret_cast<const char*>(moved), sizeof moved});
  file.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_THAT(onlyMesh(file.load()).positions, ElementsAre(glm::vec3(0), glm::vec3(5, 6, 7), glm::vec3(0, 1, 0)));
}

TEST(GltfGeometry, NormalisedIntegers_AreFractions) {
  GltfFile file;
  const int uv = file.add<std::uint16_t>({0, 65535, 13107, 0, 0, 0}, "VEC2", 5123);
  file.json["accessors"][static_cast<std::size_t>(uv)]["normalized"] = true;
  file.primitive()["attributes"]["TEXCOORD_1"] = uv;
  const int color = file.add<std::uint8_t>({255, 0, 51, 255, 255, 0, 51, 255, 255, 0, 51, 255}, "VEC4", 5121);
  file.json["accessors"][static_cast<std::size_t>(color)]["normalized"] = true;
  file.primitive()["attributes"]["COLOR_0"] = color;
  const Scene scene = file.load();
  EXPECT_TRUE(onlyMesh(scene).uvs[0].empty());
  EXPECT_THAT(onlyMesh(scene).uvs[1], ElementsAre(glm::vec2(0, 1), glm::vec2(0.2f, 0), glm::vec2(0)));
  EXPECT_EQ(onlyMesh(scene).colors.at(0), glm::vec4(1, 0, 0.2f, 1));
}

TEST(GltfGeometry, InterleavedVertices_AreReadWithTheirStride) {
  GltfFile file;
  const std::vector<float> interleaved = {0, 0, 0, 9, 2, 0, 0, 9, 0, 2, 0, 9};
  const int positions = file.add(interleaved, "VEC4", 5126);
  json& accessor = file.json["accessors"][static_cast<std::size_t>(positions)];
  accessor["type"] = "VEC3";
  file.json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteStride"] = 16;
  file.primitive()["attributes"]["POSITION"] = positions;
  EXPECT_THAT(onlyMesh(file.load()).positions, ElementsAre(glm::vec3(0), glm::vec3(2, 0, 0), glm::vec3(0, 2, 0)));
}

TEST(GltfGeometry, SharedByNodes_IsOneMesh) {
  GltfFile file;
  file.json["nodes"].push_back({{"mesh", 0}, {"translation", {2, 0, 0}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = file.load();
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh);
  EXPECT_EQ(scene.instances[1].name, "node 1");
}

// --- Nodes

TEST(GltfNodes, TransformsMultiplyDownTheTree_IncludingMirroredScale) {
  GltfFile file;
  file.json["nodes"] = json::parse(R"([
    {"name": "child", "mesh": 0, "scale": [-2, 3, 1]},
    {"name": "root", "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 10,0,0,1], "children": [2]},
    {"name": "middle", "translation": [0, 5, 0], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476],
     "children": [0]}])");
  file.json["scenes"][0]["nodes"] = {1};
  const auto scene = std::make_shared<const Scene>(file.load());
  for (std::size_t n = 0; n < scene->nodes.size(); ++n) EXPECT_LT(scene->nodes[n].parent, static_cast<int>(n));
  const auto snapshot = makeSnapshot(scene, 0, "", 1.0);
  const SnapshotInstance& instance = snapshot->instances.at(0);
  EXPECT_TRUE(instance.mirrored);
  // Scale (-2, 3, 1), a quarter turn, up by 5, another quarter turn, along x by 10: (1,1,0) -> (-2,3,0) -> (-3,-2,0) ->
  // (-3,3,0) -> (-3,-3,0) -> (7,-3,0).
  const glm::vec3 p = glm::vec3(instance.worldFromObject * glm::vec4(1, 1, 0, 1));
  EXPECT_LT(glm::distance(p, glm::vec3(7, -3, 0)), 1e-5f);
}

TEST(GltfNodes, OutsideOfTheScene_AreLeftOut) {
  GltfFile file;
  file.json["nodes"].push_back({{"name", "elsewhere"}, {"mesh", 0}});
  EXPECT_EQ(file.load().instances.size(), 1U);
  file.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {0, 1}}}};
  file.json["scene"] = 1;
  EXPECT_EQ(file.load().instances.size(), 2U);
  file.json.erase("scene");
  file.json.erase("scenes");
  EXPECT_EQ(file.load().instances.size(), 2U);
}

TEST(GltfNodes, ListedAsRootsThoughTheyHaveAParent_KeepTheirTransform) {
  GltfFile file;
  file.json["nodes"].push_back({{"name", "parent"}, {"children", {0}}, {"translation", {1, 0, 0}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = file.load();
  ASSERT_EQ(scene.instances.size(), 1U);
  EXPECT_EQ(worldMeshes(scene, 0.0).at(0).worldFromObject[3].x, 1.0f);
}

// --- Materials

TEST(GltfMaterial, Factors_AreRead) {
  GltfFile file;
  file.material() = json::parse(R"({
    "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.25, "roughnessFactor": 0.75},
    "emissiveFactor": [1, 0.5, 0], "doubleSided": true,
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}, "KHR_materials_ior": {"ior": 1.25},
                   "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 0.5, 0.25]},
                   "KHR_materials_volume": {"thicknessFactor": 2, "attenuationDistance": 3, "attenuationColor": [1, 0, 1]},
                   "KHR_materials_dispersion": {"dispersion": 0.5}}})");
  const Material material = file.load().materials.at(0);
  EXPECT_EQ(material.constants.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(glm::vec3(material.constants.emission), glm::vec3(8, 4, 0));
  EXPECT_EQ(material.constants.factors, glm::vec4(0.25f, 0.75f, 1.0f, 0.0f));
  EXPECT_EQ(material.constants.kind.y, 1.25f);
  EXPECT_TRUE(material.doubleSided);
  EXPECT_EQ(material.constants.specular.w, 0.5f);
  EXPECT_EQ(glm::vec3(material.constants.specular), glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(material.constants.kind.z, 2.0f);
  EXPECT_EQ(material.attenuationDistance, 3.0f);
  EXPECT_EQ(material.attenuationColor, glm::vec3(1, 0, 1));
  EXPECT_EQ(material.constants.kind.w, 0.5f);
}

struct KindCase {
  const char* name;
  const char* material;
  float kind;
  bool isSpecularDominant;
};

class GltfKind : public ::testing::TestWithParam<KindCase> {};

TEST_P(GltfKind, FollowsFromTheFactors) {
  GltfFile file;
  file.material() = json::parse(GetParam().material);
  const Material material = file.load().materials.at(0);
  EXPECT_EQ(material.constants.kind.x, GetParam().kind);
  EXPECT_EQ(material.isSpecularDominant, GetParam().isSpecularDominant);
}

INSTANTIATE_TEST_SUITE_P(
    Materials, GltfKind,
    ::testing::Values(
        KindCase{"SmoothMetal", R"({"pbrMetallicRoughness": {"roughnessFactor": 0}})", shading::kSurfaceMirror, true},
        KindCase{"ShinyMetal", R"({"pbrMetallicRoughness": {"roughnessFactor": 0.29}})", shading::kSurfaceGlossy, true},
        KindCase{"RoughMetal", R"({"pbrMetallicRoughness": {"roughnessFactor": 0.3}})", shading::kSurfaceGlossy, false},
        KindCase{"HalfMetal", R"({"pbrMetallicRoughness": {"metallicFactor": 0.5, "roughnessFactor": 0}})",
                 shading::kSurfaceGlossy, false},
        KindCase{"Coated", R"({"pbrMetallicRoughness": {"metallicFactor": 0}})", shading::kSurfaceGlossy, false},
        KindCase{"Matte",
                 R"({"pbrMetallicRoughness": {"metallicFactor": 0},
                     "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})",
                 shading::kSurfaceDiffuse, false},
        KindCase{"Clear", R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.6}}})",
                 shading::kSurfaceGlass, true},
        KindCase{"HalfClear",
                 R"({"pbrMetallicRoughness": {"metallicFactor": 0},
                     "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}}})",
                 shading::kSurfaceGlass, false},
        KindCase{"Unlit",
                 R"({"pbrMetallicRoughness": {"roughnessFactor": 0}, "extensions": {"KHR_materials_unlit": {}}})",
                 shading::kSurfaceUnlit, false}),
    [](const auto& test) { return test.param.name; });

TEST(GltfMaterial, TextureMeans_DecideWhetherItIsSpecularDominant) {
  // Half of the texels metallic 1 and roughness 0.5, half 0.6 and 0: means of 0.8 and 0.25.
  ImageRgba texels(2, 1, {0, 0.5f, 1, 1});
  texels(1, 0) = {0, 0, 0.6f, 1};
  GltfFile file;
  file.material()["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {
      {"index", file.addTexture(encodePng(texels, 8))}};
  EXPECT_TRUE(file.load().materials.at(0).isSpecularDominant);
  file.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 0.6;
  EXPECT_FALSE(file.load().materials.at(0).isSpecularDominant);
  // A texture may make any texel rough: no mirror, whatever its factors.
  file.json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0;
  EXPECT_EQ(constantsOf(file).kind.x, shading::kSurfaceGlossy);
}

TEST(GltfMaterial, OfPrimitivesWithoutOne_IsRoughWhiteMetal) {
  const Scene scene = GltfFile().load();
  const shading::MaterialConstants& c = scene.materials.at(0).constants;
  EXPECT_EQ(c.kind.x, shading::kSurfaceGlossy);
  EXPECT_EQ(c.baseColor, glm::vec4(1.0f));
  EXPECT_EQ(glm::vec2(c.factors), glm::vec2(1.0f));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("white metal of roughness 1")));
}

TEST(GltfMaterial, AlphaModes_AreReadWithTheirCutoff) {
  GltfFile file;
  file.material()["alphaMode"] = "BLEND";
  EXPECT_EQ(constantsOf(file).alpha.x, shading::kAlphaBlend);
  file.json["materials"][0]["alphaMode"] = "MASK";
  EXPECT_EQ(constantsOf(file).alpha, glm::vec4(shading::kAlphaMask, 0.5f, 0, 0));
  file.json["materials"][0]["alphaCutoff"] = 0.25;
  EXPECT_EQ(constantsOf(file).alpha.y, 0.25f);
  EXPECT_THAT(file.load().warnings, IsEmpty());
}

TEST(GltfMaterial, VolumeAttenuation_IsAbsorptionPerMetre) {
  GltfFile file;
  file.material() = json::parse(R"({"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {
    "KHR_materials_transmission": {"transmissionFactor": 1},
    "KHR_materials_volume": {"attenuationDistance": 2, "attenuationColor": [1, 0.5, 0.25]}}})");
  const glm::vec3 absorption(constantsOf(file).absorption);
  // exp(-a d) is the colour after the attenuation distance, and its square after twice that.
  const shading::vec3 left = shading::transmittance(absorption, 4.0f);
  EXPECT_LT(glm::distance(left, glm::vec3(1, 0.25f, 0.0625f)), 1e-6f);
  EXPECT_EQ(constantsOf(file).kind.z, 0.0f);  // without thicknessFactor it is thin-walled
}

TEST(GltfMaterial, ConductorExtras_AreItsIndexOfRefraction) {
  GltfFile file;
  file.material()["extras"]["probebench"] = {{"eta", {0.2, 0.9, 1.1}}, {"k", {3.9, 2.4, 2.2}}};
  const Scene scene = file.load();
  EXPECT_EQ(scene.materials.at(0).constants.conductorEta, glm::vec4(0.2f, 0.9f, 1.1f, 1.0f));
  EXPECT_EQ(scene.materials.at(0).constants.conductorK, glm::vec4(3.9f, 2.4f, 2.2f, 0.0f));
  EXPECT_THAT(scene.warnings, IsEmpty());
  file.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 0;
  file.json["materials"][0]["extras"]["probebench"]["kappa"] = 1;
  EXPECT_THAT(file.load().warnings,
              ElementsAre("material 0: a member of extras.probebench is ignored: 'kappa' is not known; known are "
                          "'eta', 'k', 'screen'",
                          "material 0: its eta and k are those of a metal, but its metallic factor is 0"));
}

struct OddMaterial {
  const char* name;
  const char* material;
  const char* inWarning;
};

class GltfOddMaterial : public ::testing::TestWithParam<OddMaterial> {};

TEST_P(GltfOddMaterial, LoadsWithOneWarning) {
  GltfFile file;
  file.material() = json::parse(GetParam().material);
  EXPECT_THAT(file.load().warnings, ElementsAre(HasSubstr(GetParam().inWarning)));
}

INSTANTIATE_TEST_SUITE_P(
    Values, GltfOddMaterial,
    ::testing::Values(
        OddMaterial{"IorBelowOne", R"({"extensions": {"KHR_materials_ior": {"ior": 0.9}}})", "1.5 stands for 0.9"},
        OddMaterial{"IorOfZero", R"({"extensions": {"KHR_materials_ior": {"ior": 0}}})", "1.5 stands for 0"},
        OddMaterial{"IorAbsurd", R"({"extensions": {"KHR_materials_ior": {"ior": 40}}})", "of 40, 5 is used"},
        OddMaterial{"AttenuationDistanceOfZero",
                    R"({"extensions": {"KHR_materials_volume": {"attenuationDistance": 0}}})", "taken as none"},
        OddMaterial{"BaseColorAboveOne", R"({"pbrMetallicRoughness": {"baseColorFactor": [1.5, 1, 1, 1]}})",
                    "base colours are at most 1"},
        OddMaterial{"TransmittingMetal", R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}})",
                    "metallic is not rendered on a transmitting surface"}),
    [](const auto& test) { return test.param.name; });

TEST(GltfMaterial, OddValues_AreReplaced) {
  GltfFile file;
  file.material() = json::parse(R"({"pbrMetallicRoughness": {"baseColorFactor": [1.5, 1, 0.5, 1]}, "extensions": {
    "KHR_materials_ior": {"ior": 40}, "KHR_materials_volume": {"attenuationDistance": 0, "attenuationColor": [0, 1, 1]}}})");
  const Material material = file.load().materials.at(0);
  EXPECT_EQ(material.constants.kind.y, 5.0f);
  EXPECT_EQ(material.constants.baseColor, glm::vec4(1, 1, 0.5f, 1));
  EXPECT_EQ(material.constants.absorption, glm::vec4(0.0f));
}

TEST(GltfMaterial, ColorTexturesAreDecodedFromSrgb_DataTexturesAreNot) {
  GltfFile file;
  const int texture = file.addTexture(grayPng(0.5f));
  json& material = file.material();
  material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
  material["normalTexture"] = {{"index", texture}, {"scale", 0.5}};
  material["emissiveTexture"] = {{"index", texture}};
  material["occlusionTexture"] = {{"index", texture}, {"strength", 0.75}};
  const Scene scene = file.load();
  const Material& loaded = scene.materials.at(0);
  const auto texel = [&](int index) { return scene.textures.at(static_cast<std::size_t>(index)).levels[0](0, 0).x; };
  // 0.5 is stored as byte 128.
  EXPECT_EQ(texel(loaded.baseColorTexture), linearFromSrgb(128.0f / 255.0f));
  EXPECT_EQ(loaded.emissionTexture, loaded.baseColorTexture);
  EXPECT_EQ(texel(loaded.normalTexture), 128.0f / 255.0f);
  EXPECT_EQ(loaded.occlusionTexture, loaded.normalTexture);
  EXPECT_EQ(loaded.constants.emission.w, 0.5f);
  EXPECT_EQ(loaded.constants.factors.z, 0.75f);
  EXPECT_EQ(scene.instances.at(0).mesh->tangents.size(), 3U);
}

TEST(GltfMaterial, SamplersAndUvSets_AreRead) {
  GltfFile file;
  const int texture = file.addTexture(grayPng(0.5f));
  file.material()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}, {"texCoord", 1}};
  const shading::TextureSlot defaults = constantsOf(file).baseColorSlot;
  EXPECT_EQ(defaults.sampler_, glm::vec4(shading::kWrapRepeat, shading::kWrapRepeat, shading::kFilterLinear,
                                         shading::kFilterLinearMipLinear));
  EXPECT_EQ(defaults.offset, glm::vec4(0, 0, 1, 1));
  file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9985}}};
  file.json["textures"][0]["sampler"] = 0;
  EXPECT_EQ(
      constantsOf(file).baseColorSlot.sampler_,
      glm::vec4(shading::kWrapClamp, shading::kWrapMirror, shading::kFilterNearest, shading::kFilterLinearMipNearest));
}

TEST(GltfMaterial, TextureTransform_IsThatOfTheExtensionsExample) {
  // KHR_texture_transform's example: the lower left quadrant of the image, turned clockwise by 90 degrees.
  GltfFile file;
  file.material()["emissiveTexture"] = {
      {"index", file.addTexture(grayPng(0.5f))},
      {"extensions",
       {{"KHR_texture_transform", {{"offset", {0, 1}}, {"rotation", 0.5 * M_PI}, {"scale", {0.5, 0.5}}}}}}};
  const shading::TextureSlot slot = constantsOf(file).emissionSlot;
  const auto transformed = [&](glm::vec2 uv) { return shading::textureCoordinates(slot.matrix, slot.offset, uv, uv); };
  const auto expectNear = [](glm::vec2 a, glm::vec2 b) { EXPECT_LT(glm::distance(a, b), 1e-6f) << a.x << ' ' << a.y; };
  expectNear(transformed({0, 0}), {0, 1});
  expectNear(transformed({1, 0}), {0, 0.5f});
  expectNear(transformed({0, 1}), {0.5f, 1});
  expectNear(transformed({1, 1}), {0.5f, 0.5f});
}

// --- Lights, cameras, animation

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

// --- Extras, embedding, Draco

TEST(GltfExtras, Probe_IsMovedOrSwitchedOff) {
  GltfFile file;
  file.material()["pbrMetallicRoughness"]["roughnessFactor"] = 0;
  file.json["nodes"][0]["translation"] = {1, 2, 3};
  const auto probesWith = [&](const json& probe) {
    file.json["nodes"][0]["extras"] = {{"probe", probe}};
    return makeSnapshot(std::make_shared<const Scene>(file.load()), 0, "", 1.0)->probes;
  };
  ASSERT_EQ(probesWith(true).size(), 1U);
  EXPECT_EQ(probesWith(true)[0].position, glm::vec3(1.5f, 2.5f, 3.0f));
  EXPECT_EQ(probesWith({{"position", {0, 0, 9}}}).at(0).position, glm::vec3(1, 2, 12));
  EXPECT_THAT(probesWith(false), IsEmpty());
  EXPECT_THAT(probesWith({{"enabled", false}}), IsEmpty());
}

TEST(GltfExtras, Probe_IsGivenToWhatHasASpecularLobe) {
  GltfFile file;
  file.material()["pbrMetallicRoughness"]["roughnessFactor"] = 0.8;
  const auto probeCount = [&] {
    return makeSnapshot(std::make_shared<const Scene>(file.load()), 0, "", 1.0)->probes.size();
  };
  EXPECT_EQ(probeCount(), 0U);
  file.json["nodes"][0]["extras"] = {{"probe", true}};
  EXPECT_EQ(probeCount(), 1U);
  EXPECT_THAT(describe(file.load()), HasSubstr("as the node's extras want"));
  file.json["materials"][0] = json::parse(R"({"pbrMetallicRoughness": {"metallicFactor": 0},
    "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})");
  EXPECT_EQ(probeCount(), 0U);
}

TEST(GltfExtras, OfProbebench_SetWhatGltfCantSay) {
  GltfFile file;
  file.json["scenes"][0]["extras"]["probebench"] = json::parse(R"({"schema": 1, "shadows": "traced",
    "environment": {"constant": [0.5, 1, 2]}, "framesPerSecond": 25, "probeNear": 0.2})");
  Scene scene = file.load();
  EXPECT_TRUE(scene.castsShadows);
  EXPECT_EQ(scene.framesPerSecond, 25.0);
  EXPECT_EQ(scene.probeNear, 0.2f);
  EXPECT_EQ(environmentRadiance(scene.environment, {0, 1, 0}), glm::vec3(0.5f, 1, 2));
  EXPECT_EQ(shading::ambientRadiance(scene.environment.ambient, {0, 0, 1}), glm::vec3(0.5f, 1, 2));
  json& own = file.json["scenes"][0]["extras"]["probebench"];
  own["environment"] = json::parse(R"({"sky": {"horizon": 1, "zenith": [0, 0, 1], "below": 0.25}, "ambient": [
    [0.5, 0.5, 0.5], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]})");
  own["shadows"] = "none";
  scene = file.load();
  EXPECT_FALSE(scene.castsShadows);
  EXPECT_EQ(environmentRadiance(scene.environment, {0, 1, 0}), glm::vec3(0, 0, 1));
  EXPECT_EQ(environmentRadiance(scene.environment, {0, -1, 0}), glm::vec3(0.25f));
  EXPECT_EQ(shading::ambientRadiance(scene.environment.ambient, {0, 1, 0}), glm::vec3(0.5f));
}

TEST(GltfExtras, OfProbebench_LeaveToOthersWhatTheyDoNotSay) {
  GltfFile file;
  file.json["scenes"][0]["extras"] = {{"skyRadiance", 0.25}, {"probebench", {{"schema", 1}, {"shadows", "traced"}}}};
  const Scene scene = file.load();
  EXPECT_TRUE(scene.castsShadows);
  EXPECT_EQ(environmentRadiance(scene.environment, {0, 1, 0}), glm::vec3(0.25f));
}

TEST(GltfExtras, UnknownMembersOfProbebench_AreIgnoredWithAWarning) {
  GltfFile file;
  file.material()["pbrMetallicRoughness"]["metallicFactor"] = 0;
  file.json["scenes"][0]["extras"]["probebench"] =
      json::parse(R"({"schema": 1, "shadow": "traced", "environment": {"constant": 1, "nam": "x"}})");
  EXPECT_THAT(
      file.load().warnings,
      ElementsAre("a member of extras.probebench is ignored: 'shadow' is not known; nearest is 'shadows'",
                  "a member of extras.probebench/environment is ignored: 'nam' is not known; nearest is 'name'"));
}

TEST(GltfExtras, UnknownMembersOfAProbe_AreIgnoredWithAWarning) {
  GltfFile file;
  file.json["nodes"][0]["name"] = "ball";
  file.json["nodes"][0]["extras"] = {{"probe", {{"postion", {0, 0, 9}}}}};
  EXPECT_THAT(file.load().warnings, Contains("node 'ball': a member of extras.probe is ignored: 'postion' is not "
                                             "known; nearest is 'position'"));
}

TEST(GltfExtras, OfTheCubeCameraBenchmark_SetSkyAmbientAndNearPlane) {
  GltfFile file;
  file.json["scenes"][0]["extras"] = json::parse(R"({"ambientRadiance": 0.25, "cubeCamera": {"near": 0.2},
    "sky": {"horizon": [0.5, 0.6, 0.7], "zenith": [0.1, 0.2, 0.3], "below": [0.3, 0.2, 0.1], "glow": [4, 4, 4],
            "glowPower": 64, "toGlow": [0, 1, 0]}})");
  const Scene scene = file.load();
  EXPECT_EQ(scene.probeNear, 0.2f);
  EXPECT_EQ(shading::ambientRadiance(scene.environment.ambient, {0, 0, 1}), glm::vec3(0.25f));
  EXPECT_EQ(environmentRadiance(scene.environment, {0, -1, 0}), glm::vec3(0.3f, 0.2f, 0.1f));
  EXPECT_EQ(environmentRadiance(scene.environment, {0, 1, 0}), glm::vec3(1.0f));  // clamped: its sky is made of bytes
}

TEST(GltfExtras, OfTheCubeCameraBenchmark_TakeTheCoatsFromItsDiffuseMaterials) {
  GltfFile file;
  file.material()["pbrMetallicRoughness"]["metallicFactor"] = 0;
  EXPECT_EQ(constantsOf(file).kind.x, shading::kSurfaceGlossy);
  file.json["scenes"][0]["extras"]["diffuse"] = "albedo * (ambientRadiance + directRadiance)";
  EXPECT_EQ(constantsOf(file).kind.x, shading::kSurfaceDiffuse);
  EXPECT_EQ(constantsOf(file).specular.w, 0.0f);
  EXPECT_THAT(file.load().notes, Contains(HasSubstr("no dielectric coat")));
  file.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1;
  EXPECT_EQ(constantsOf(file).kind.x, shading::kSurfaceGlossy);
}

// What write_glb() of the ray tracers' benchmark (scenes.py) makes of each of its kinds of material.
TEST(GltfMaterial, OfTheRayTracersBenchmark_AreItsKinds) {
  GltfFile file;
  file.json["scenes"][0]["extras"] = {{"skyRadiance", {0.45, 0.5, 0.6}}};
  const auto load = [&](const char* material) {
    file.material() = json::parse(material);
    const Scene scene = file.load();
    EXPECT_EQ(environmentRadiance(scene.environment, {0, 1, 0}), glm::vec3(0.45f, 0.5f, 0.6f));
    EXPECT_EQ(shading::ambientRadiance(scene.environment.ambient, {0, 1, 0}), glm::vec3(0.45f, 0.5f, 0.6f));
    return scene.materials.at(0).constants;
  };
  const auto diffuse = load(R"({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1},
    "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})");
  EXPECT_EQ(diffuse.kind.x, shading::kSurfaceDiffuse);
  const auto gold = load(R"({"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0.3}})");
  EXPECT_EQ(gold.kind.x, shading::kSurfaceGlossy);
  EXPECT_EQ(gold.factors.y, 0.3f);
  const auto mirror = load(R"({"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0}})");
  EXPECT_EQ(mirror.kind.x, shading::kSurfaceMirror);
  const auto light = load(R"({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
    "emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8},
                                                "KHR_materials_specular": {"specularFactor": 0}}})");
  EXPECT_EQ(light.kind.x, shading::kSurfaceDiffuse);
  EXPECT_EQ(glm::vec3(light.emission), glm::vec3(8.0f));
  const auto glass = load(R"({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}, "extensions": {
    "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.5},
    "KHR_materials_volume": {"thicknessFactor": 1.4}}})");
  EXPECT_EQ(glass.kind, glm::vec4(shading::kSurfaceGlass, 1.5f, 1.4f, 0.0f));
  EXPECT_EQ(glass.absorption, glm::vec4(0.0f));
  EXPECT_EQ(glass.factors, glm::vec4(0.0f, 0.0f, 1.0f, 1.0f));
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

TEST(GltfWarnings, NameTheFeatureAndTheMaterial) {
  GltfFile file;
  file.material() = json::parse(R"({"name": "varnish", "pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {
    "KHR_materials_clearcoat": {"clearcoatFactor": 1},
    "KHR_materials_specular": {"specularTexture": {"index": 0}}}})");
  file.addTexture(grayPng(0.5f));
  EXPECT_THAT(file.load().warnings, ElementsAre("material 'varnish': extension KHR_materials_clearcoat is ignored",
                                                "material 'varnish': specularTexture is ignored"));
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
