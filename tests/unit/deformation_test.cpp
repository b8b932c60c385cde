// Skins, morph targets and waves: closed forms, glTF's rules, and files that break them.
#include "scenes/deformation.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/gltf_save.h"
#include "scenes/snapshot.h"
#include "tests/unit/gltf_file.h"

namespace pb {
namespace {

using glm::vec3;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::shared_ptr<const Scene> shared(Scene scene) { return std::make_shared<const Scene>(std::move(scene)); }

const Mesh& meshAt(const std::shared_ptr<const Scene>& scene, int frame, std::shared_ptr<const Snapshot>& keeper) {
  keeper = makeSnapshot(scene, frame, "", 1.0);
  return *keeper->instances.at(0).mesh;
}

std::vector<vec3> positionsAt(const std::shared_ptr<const Scene>& scene, int frame) {
  std::shared_ptr<const Snapshot> keeper;
  return meshAt(scene, frame, keeper).positions;
}

void expectNear(const vec3& a, const vec3& b, float tolerance) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " for " << b.x << " " << b.y << " " << b.z;
}

// The triangle (0,0,0), (1,0,0), (0,1,0) with a skin of two joints, the second one 1 m above the first and child of it.
// The corner at the top is moved by the second joint alone.
struct SkinnedFile : GltfFile {
  SkinnedFile() {
    json["nodes"] = {{{"name", "triangle"}, {"mesh", 0}, {"skin", 0}, {"translation", {5, 6, 7}}},
                     {{"name", "lower"}, {"children", {2}}},
                     {{"name", "upper"}, {"translation", {0, 1, 0}}}};
    json["scenes"] = {{{"nodes", {0, 1}}}};
    json["skins"] = {{{"name", "bones"}, {"joints", {1, 2}}, {"inverseBindMatrices", addBindMatrices()}}};
    primitive()["attributes"]["NORMAL"] = add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
    setJoints({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
    setWeights({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  }

  void setJoints(const std::vector<std::uint8_t>& joints) {
    primitive()["attributes"]["JOINTS_0"] = add(joints, "VEC4", 5121);
  }
  void setWeights(const std::vector<float>& weights) {
    primitive()["attributes"]["WEIGHTS_0"] = add(weights, "VEC4", 5126);
  }

  int addMatrices(const std::vector<glm::mat4>& matrices) {
    std::vector<float> numbers;
    for (const glm::mat4& m : matrices) numbers.insert(numbers.end(), &m[0][0], &m[0][0] + 16);
    const int accessor = add(numbers, "VEC4", 5126);
    json["accessors"][static_cast<std::size_t>(accessor)]["type"] = "MAT4";
    json["accessors"][static_cast<std::size_t>(accessor)]["count"] = matrices.size();
    return accessor;
  }
  int addBindMatrices() { return addMatrices({glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), vec3(0, -1, 0))}); }

  // Turns `upper` around Z by 90 degrees within one second.
  void turnUpperJoint() {
    const float h = std::sqrt(0.5f);
    animate("rotation", add<float>({0, 1}, "SCALAR", 5126), add<float>({0, 0, 0, 1, 0, 0, h, h}, "VEC4", 5126), 2);
  }
  void animate(const char* path, int times, int values, int node) {
    json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}},
                           {"samplers", {{{"input", times}, {"output", values}}}}}};
  }
};

TEST(Skin, AtItsBindPose_LeavesTheMeshWhereTheJointsAreNotAtTheNode) {
  const auto snapshot = makeSnapshot(shared(SkinnedFile().load()), 0, "", 1.0);
  const SnapshotInstance& instance = snapshot->instances.at(0);
  EXPECT_EQ(instance.worldFromObject, glm::mat4(1.0f));
  EXPECT_EQ(instance.mesh->positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(instance.worldBounds.upper, vec3(1, 1, 0));
}

// At 1/2 s the upper joint, at (0, 1, 0), has turned by 45 degrees. A corner at p = (0, 2, 0) goes to
// (0, 1, 0) + R (0, 1, 0); one that half belongs to each joint to the mean of that and its place at rest.
TEST(Skin, TurnsVerticesAroundTheirJoints_ByWeight) {
  SkinnedFile file;
  file.primitive()["attributes"]["POSITION"] = file.add<float>({0, 0, 0, 0, 2, 0, 0, 2, 1}, "VEC3", 5126);
  file.setJoints({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
  file.setWeights({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0});
  file.turnUpperJoint();
  std::shared_ptr<const Snapshot> keeper;
  const Mesh& mesh = meshAt(shared(file.load()), 15, keeper);
  const float h = std::sqrt(0.5f);
  expectNear(mesh.positions[0], vec3(0, 0, 0), 1e-6f);
  expectNear(mesh.positions[1], vec3(-h, 1 + h, 0), 1e-6f);
  expectNear(mesh.positions[2], 0.5f * (vec3(0, 2, 1) + vec3(-h, 1 + h, 1)), 1e-6f);
}

// Normals of a surface that a joint scales by (1, 1, 3): those of an ellipsoid, across its triangles.
TEST(Skin, OfAScaledJoint_KeepsNormalsAcrossTheSurface) {
  Scene scene;
  Mesh ball = makeSphereMesh(1.0f, 64, 32);
  ball.joints.assign(ball.positions.size(), glm::u16vec4(0));
  ball.jointWeights.assign(ball.positions.size(), glm::vec4(1, 0, 0, 0));
  Node node;
  node.skin = 0;
  const int n = addInstance(scene, "ball", finishMesh(std::move(ball)),
                            addMaterial(scene, makeDiffuseMaterial("matte", vec3(0.5f))), node);
  Node joint;
  joint.scale = vec3(1, 1, 3);
  scene.nodes.push_back(joint);
  scene.skins.push_back({"skin", {n + 1}, {glm::mat4(1.0f)}});
  finishScene(scene);
  std::shared_ptr<const Snapshot> keeper;
  const Mesh& mesh = meshAt(shared(std::move(scene)), 0, keeper);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const vec3 p = mesh.positions[v];
    expectNear(mesh.normals[v], glm::normalize(vec3(p.x, p.y, p.z / 9.0f)), 1e-5f);
  }
  EXPECT_NEAR(mesh.bounds.upper.z, 3.0f, 1e-5f);
}

TEST(Skin, ThatMirrors_TurnsTrianglesRound) {
  SkinnedFile file;
  file.json["nodes"][1]["scale"] = {-1, 1, 1};
  const auto snapshot = makeSnapshot(shared(file.load()), 0, "", 1.0);
  EXPECT_TRUE(snapshot->instances.at(0).mirrored);
  expectNear(snapshot->instances[0].mesh->normals[0], vec3(0, 0, 1), 1e-6f);
}

// The triangle with one target that moves its second corner by (1, 0, 2).
struct MorphedFile : GltfFile {
  MorphedFile() {
    primitive()["targets"] = {{{"POSITION", add<float>({0, 0, 0, 1, 0, 2, 0, 0, 0}, "VEC3", 5126)}}};
    json["meshes"][0]["weights"] = {0.5};
    json["meshes"][0]["name"] = "shape";
  }
};

TEST(Morph, AddsTargetsByTheMeshsWeights_UnlessTheNodeHasItsOwn) {
  MorphedFile file;
  EXPECT_EQ(positionsAt(shared(file.load()), 0)[1], vec3(1.5f, 0, 1));
  file.json["nodes"][0]["weights"] = {-1.0};
  EXPECT_EQ(positionsAt(shared(file.load()), 0)[1], vec3(0, 0, -2));
}

TEST(Morph, Weights_AreAnimated) {
  MorphedFile file;
  const int times = file.add<float>({0, 1}, "SCALAR", 5126), weights = file.add<float>({0, 1}, "SCALAR", 5126);
  file.json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}},
                              {"samplers", {{{"input", times}, {"output", weights}}}}}};
  const auto scene = shared(file.load());
  EXPECT_EQ(scene->durationSeconds, 1.0);
  EXPECT_EQ(positionsAt(scene, 0)[1], vec3(1, 0, 0));
  expectNear(positionsAt(scene, 15)[1], vec3(1.5f, 0, 1), 1e-6f);
}

TEST(Morph, OfFlatShading_ComputesNormalsAnew) {
  std::shared_ptr<const Snapshot> keeper;
  const Mesh& mesh = meshAt(shared(MorphedFile().load()), 0, keeper);
  // Corners (0,0,0), (1.5,0,1), (0,1,0).
  for (const vec3& n : mesh.normals) expectNear(n, glm::normalize(vec3(-1, 0, 1.5f)), 1e-6f);
}

TEST(Morph, OfGivenNormals_AddsTheTargetsAndNormalises) {
  MorphedFile file;
  file.primitive()["attributes"]["NORMAL"] = file.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
  file.primitive()["targets"][0]["NORMAL"] = file.add<float>({0, 0, 0, 2, 0, 0, 0, 0, 0}, "VEC3", 5126);
  std::shared_ptr<const Snapshot> keeper;
  const Mesh& mesh = meshAt(shared(file.load()), 0, keeper);
  expectNear(mesh.normals[0], vec3(0, 0, 1), 1e-6f);
  expectNear(mesh.normals[1], glm::normalize(vec3(1, 0, 1)), 1e-6f);
}

// Triangles without area at rest may get one.
TEST(Morph, OfACollapsedTriangle_OpensIt) {
  MorphedFile file;
  file.primitive()["attributes"]["POSITION"] = file.add<float>({0, 0, 0, 0, 0, 0, 0, 1, 0}, "VEC3", 5126);
  std::shared_ptr<const Snapshot> keeper;
  EXPECT_EQ(meshAt(shared(file.load()), 0, keeper).triangleCount(), 1U);
}

Scene makeFlagScene(const Wave& wave, Material material) {
  Scene scene;
  Mesh grid = makeSphereMesh(1.0f, 32, 16);  // any mesh with all kinds of normals
  for (vec3& p : grid.positions) p.x += 1.5f;
  Node node;
  node.wave = wave;
  addInstance(scene, "flag", finishMesh(std::move(grid), true), addMaterial(scene, std::move(material)), node);
  finishScene(scene);
  return scene;
}

// By its definition, with central differences for the surface's directions.
TEST(Wave, MovesVerticesAndTurnsNormalsAndTangents_AsItsDerivativesSay) {
  const Wave wave{.amplitude = 0.3f, .length = 2.0f, .wavelength = 1.2f, .skew = 0.4f, .periodSeconds = 1.5f};
  const auto scene = shared(makeFlagScene(wave, makeDiffuseMaterial("cloth", vec3(0.5f))));
  EXPECT_EQ(scene->durationSeconds, 1.5);
  const Mesh& rest = *scene->instances[0].mesh;
  const double time = 11 / 30.0;
  const auto moved = [&](const glm::dvec3& p) {
    const double phase = 2 * 3.141592653589793 * (p.x / 1.2 + 0.4 * p.y - time / 1.5);
    return p + glm::dvec3(0, 0, 0.3 * std::max(p.x, 0.0) / 2.0 * std::sin(phase));
  };
  const auto turned = [&](const glm::dvec3& p, const glm::dvec3& d) {
    return (moved(p + 1e-5 * d) - moved(p - 1e-5 * d)) / 2e-5;
  };
  std::shared_ptr<const Snapshot> keeper;
  const Mesh& mesh = meshAt(scene, 11, keeper);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    expectNear(mesh.positions[v], vec3(moved(rest.positions[v])), 1e-6f);
    if (glm::vec3(rest.tangents[v]) == vec3(0.0f)) continue;  // of no triangle, at the poles
    const glm::dvec3 n = rest.normals[v], t = glm::normalize(glm::dvec3(rest.tangents[v])), b = glm::cross(n, t);
    const glm::dvec3 p = rest.positions[v];
    expectNear(mesh.normals[v], vec3(glm::normalize(glm::cross(turned(p, t), turned(p, b)))), 1e-4f);
    expectNear(vec3(mesh.tangents[v]), vec3(glm::normalize(turned(p, t))), 1e-4f);
  }
}

TEST(Wave, AfterItsPeriod_IsTheSame) {
  const auto scene = shared(makeFlagScene(Wave{.periodSeconds = 0.5f}, makeDiffuseMaterial("cloth", vec3(0.5f))));
  EXPECT_EQ(positionsAt(scene, 4), positionsAt(scene, 19));
  EXPECT_NE(positionsAt(scene, 4), positionsAt(scene, 5));
}

TEST(Deformation, MovesAreaLightsAndProbesWithTheShape) {
  Material lamp = makeDiffuseMaterial("lamp", vec3(0.0f));
  lamp.constants.emission = glm::vec4(1.0f);
  MorphedFile file;
  Scene scene = file.load();
  scene.materials[0] = lamp;
  const auto snapshot = makeSnapshot(shared(std::move(scene)), 0, "", 1.0);
  ASSERT_EQ(snapshot->areaLights.size(), 1U);
  EXPECT_EQ(vec3(snapshot->areaLights[0].b), vec3(1.5f, 0, 1));
  EXPECT_EQ(snapshot->instances[0].worldBounds.upper, vec3(1.5f, 1, 1));

  const auto mirror = makeSnapshot(shared(makeFlagScene(Wave{}, makeMirrorMaterial("mirror"))), 3, "", 1.0);
  EXPECT_EQ(mirror->probes.at(0).position, mirror->instances[0].worldBounds.centre());
  EXPECT_EQ(mirror->instances[0].mesh->bounds.upper, mirror->instances[0].worldBounds.upper);
}

TEST(Deformation, OfNoDeformingInstance_SharesTheScenesMesh) {
  const auto scene = loadScene("builtin:flag-and-horse");
  const auto a = makeSnapshot(scene, 0, "", 1.0), b = makeSnapshot(scene, 5, "", 1.0);
  int deforming = 0;
  for (std::size_t i = 0; i < a->instances.size(); ++i) {
    const bool isShared = a->instances[i].mesh == scene->instances[i].mesh;
    EXPECT_EQ(isShared, !deforms(*scene, scene->instances[i]));
    deforming += isShared ? 0 : 1;
    EXPECT_EQ(isShared, a->instances[i].mesh->contentHash == b->instances[i].mesh->contentHash) << i;
  }
  EXPECT_EQ(deforming, 1);
}

void expectSameShapes(const std::shared_ptr<const Scene>& a, const std::shared_ptr<const Scene>& b) {
  EXPECT_EQ(a->durationSeconds, b->durationSeconds);
  for (const int frame : {0, 7, 22}) {
    const auto before = makeSnapshot(a, frame, "", 1.0), after = makeSnapshot(b, frame, "", 1.0);
    for (std::size_t i = 0; i < before->instances.size(); ++i) {
      EXPECT_EQ(before->instances[i].mesh->contentHash, after->instances[i].mesh->contentHash) << frame;
      EXPECT_EQ(before->instances[i].worldFromObject, after->instances[i].worldFromObject);
    }
  }
}

std::shared_ptr<const Scene> savedAndLoaded(const Scene& scene) {
  const TemporaryFolder folder;
  saveGlb(scene, folder.file("scene.glb"));
  return shared(loadGltf(folder.file("scene.glb")));
}

TEST(Deformation, SavedAndLoaded_HasTheSameShapesBitByBit) {
  SkinnedFile skinned;
  skinned.turnUpperJoint();
  const auto skin = shared(skinned.load());
  expectSameShapes(skin, savedAndLoaded(*skin));
  const auto flat = shared(MorphedFile().load());
  expectSameShapes(flat, savedAndLoaded(*flat));
  MorphedFile smooth;
  smooth.primitive()["attributes"]["NORMAL"] = smooth.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 5126);
  smooth.primitive()["targets"][0]["NORMAL"] = smooth.add<float>({0, 0, 0, 2, 0, 0, 0, 0, 0}, "VEC3", 5126);
  const auto morph = shared(smooth.load());
  expectSameShapes(morph, savedAndLoaded(*morph));
  const auto flag = loadScene("builtin:flag-and-horse");
  expectSameShapes(flag, savedAndLoaded(*flag));
}

struct BadFile {
  const char* name;
  std::function<void(SkinnedFile&)> spoil;
  const char* message;
};

class BadDeformation : public ::testing::TestWithParam<BadFile> {};

TEST_P(BadDeformation, IsRefusedByName) {
  SkinnedFile file;
  file.json["meshes"][0]["name"] = "shape";
  GetParam().spoil(file);
  try {
    file.load();
    FAIL() << "was loaded";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::input);
    EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
    EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
  }
}

void addTarget(SkinnedFile& file, const std::vector<float>& deltas) {
  file.primitive()["targets"] = {{{"POSITION", file.add(deltas, "VEC3", 5126)}}};
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadDeformation,
    ::testing::Values(
        BadFile{"JointOutOfRange",
                [](SkinnedFile& f) {
                  f.setJoints({0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0});
                },
                "mesh 'shape' has a joint out of range: vertex 2 wants joint 2 of 2 in skin 'bones'"},
        BadFile{"WeightsOfZero",
                [](SkinnedFile& f) {
                  f.setWeights({1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
                },
                "mesh 'shape' wants joint weights of at least 0 that sum to 1, got 0 0 0 0 at vertex 1"},
        BadFile{"NegativeWeights",
                [](SkinnedFile& f) {
                  f.setWeights({1, 0, 0, 0, 2, -1, 0, 0, 1, 0, 0, 0});
                },
                "mesh 'shape' wants joint weights of at least 0"},
        BadFile{"WeightThatIsNoNumber",
                [](SkinnedFile& f) {
                  f.setWeights({1, 0, 0, 0, std::nanf(""), 0, 0, 0, 1, 0, 0, 0});
                },
                "mesh 'shape' primitive 0: accessors/"},
        BadFile{"FewerWeightsThanVertices",
                [](SkinnedFile& f) {
                  f.setWeights({1, 0, 0, 0});
                },
                "mesh 'shape' has 3 vertices, with 3 joint indices and 1 joint weights"},
        BadFile{"JointsWithoutWeights", [](SkinnedFile& f) { f.primitive()["attributes"].erase("WEIGHTS_0"); },
                "mesh 'shape' has 3 vertices, with 3 joint indices and 0 joint weights"},
        BadFile{"TooFewBindMatrices",
                [](SkinnedFile& f) { f.json["skins"][0]["inverseBindMatrices"] = f.addMatrices({glm::mat4(1.0f)}); },
                "skin 'bones': 1 inverse bind matrices for 2 joints"},
        BadFile{"BindMatrixThatIsNotAffine",
                [](SkinnedFile& f) {
                  f.json["skins"][0]["inverseBindMatrices"] = f.addMatrices({glm::mat4(1.0f), glm::mat4(2.0f)});
                },
                "skin 'bones': inverse bind matrix 1 is not affine"},
        BadFile{"JointOutsideOfTheScene",
                [](SkinnedFile& f) {
                  f.json["scenes"] = {{{"nodes", {0}}}};
                },
                "skin 'bones': joints are nodes of the scene, node 1 is none"},
        BadFile{"JointThatIsNoNode",
                [](SkinnedFile& f) {
                  f.json["skins"][0]["joints"] = {1, 9};
                },
                "skins/0/joints/1 is out of range: index 9 of 3 nodes"},
        BadFile{"SkinWithoutJoints", [](SkinnedFile& f) { f.json["skins"][0]["joints"] = nlohmann::json::array(); },
                "skin 'bones': a skin has at least one joint"},
        BadFile{"TargetOfOtherLength",
                [](SkinnedFile& f) {
                  addTarget(f, {0, 0, 0, 1, 1, 1});
                },
                "mesh 'shape' has 3 vertices, morph target 0 has 2"},
        BadFile{"TargetThatIsNoAccessor",
                [](SkinnedFile& f) {
                  f.primitive()["targets"] = {{{"POSITION", 99}}};
                },
                "targets/0/POSITION is out of range: index 99"},
        BadFile{"TargetsThatAreNoArray", [](SkinnedFile& f) { f.primitive()["targets"] = 3; },
                "targets wants an array, got 3"},
        BadFile{"OtherNumberOfMorphWeights",
                [](SkinnedFile& f) {
                  addTarget(f, {0, 0, 0, 1, 0, 0, 0, 0, 0});
                  f.json["nodes"][0]["weights"] = {0, 1};
                },
                "node 'triangle' has 2 morph weights, its mesh 'shape' has 1 morph targets"},
        BadFile{"MorphWeightThatIsNoNumber",
                [](SkinnedFile& f) {
                  addTarget(f, {0, 0, 0, 1, 0, 0, 0, 0, 0});
                  f.json["nodes"][0]["weights"] = {"one"};
                },
                "nodes/0/weights/0 wants a number"},
        BadFile{
            "AnimatedWeightsOfOtherNumber",
            [](SkinnedFile& f) {
              addTarget(f, {0, 0, 0, 1, 0, 0, 0, 0, 0});
              f.animate("weights", f.add<float>({0, 1}, "SCALAR", 5126), f.add<float>({0, 1, 2}, "SCALAR", 5126), 0);
            },
            "animation of node 'triangle' has 3 morph weights for 2 keys of 1 morph targets"},
        BadFile{"WaveWithoutLength",
                [](SkinnedFile& f) { f.json["nodes"][0]["extras"]["probebench"]["wave"]["length"] = 0; },
                "extras.probebench/wave/length wants a number from 1e-06 to 1000000"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Deformation, BeyondAllBounds_IsRefusedByName) {
  MorphedFile file;
  file.json["nodes"][0]["weights"] = {1e9};
  file.primitive()["targets"][0]["POSITION"] = file.add<float>({0, 0, 0, 1e20f, 0, 0, 0, 0, 0}, "VEC3", 5126);
  EXPECT_THAT([&] { file.load(); }, ::testing::ThrowsMessage<Error>(HasSubstr("one of mesh 'shape' is at 1e+29")));
}

TEST(Deformation, PartsThatAreNotRead_AreNamedInWarnings) {
  SkinnedFile file;
  file.primitive()["attributes"]["JOINTS_1"] = file.primitive()["attributes"]["JOINTS_0"];
  addTarget(file, {0, 0, 0, 1, 0, 0, 0, 0, 0});
  file.primitive()["targets"][0]["TEXCOORD_0"] = file.add<float>({0, 0, 0, 0, 0, 0}, "VEC2", 5126);
  EXPECT_THAT(file.load().warnings, AllOf(::testing::Contains(AllOf(HasSubstr("JOINTS_1"), HasSubstr("first four"))),
                                          ::testing::Contains(HasSubstr("TEXCOORD_0"))));
}

}  // namespace
}  // namespace pb
