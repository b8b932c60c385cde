// Materials and textures of glTF files: what a file says is what the scene holds.
#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "scenes/environment.h"
#include "scenes/image_io.h"
#include "tests/unit/gltf_file.h"

namespace pb {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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

TEST(GltfWarnings, NameTheFeatureAndTheMaterial) {
  GltfFile file;
  file.material() = json::parse(R"({"name": "varnish", "pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {
    "KHR_materials_clearcoat": {"clearcoatFactor": 1},
    "KHR_materials_specular": {"specularTexture": {"index": 0}}}})");
  file.addTexture(grayPng(0.5f));
  EXPECT_THAT(file.load().warnings, ElementsAre("material 'varnish': extension KHR_materials_clearcoat is ignored",
                                                "material 'varnish': specularTexture is ignored"));
}

}  // namespace
}  // namespace pb
