// What extras of glTF files say: probebench's own and those of peer benchmarks.
#include <gmock/gmock.h>

#include "scenes/describe.h"
#include "scenes/environment.h"
#include "scenes/snapshot.h"
#include "tests/unit/gltf_file.h"

namespace pb {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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

}  // namespace
}  // namespace pb
