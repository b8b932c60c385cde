// Meshes and nodes of glTF files: what a file says is what the scene holds.
#include <gmock/gmock.h>

#include <glm/geometric.hpp>

#include "scenes/snapshot.h"
#include "tests/unit/gltf_file.h"

namespace pb {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

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

}  // namespace
}  // namespace pb
