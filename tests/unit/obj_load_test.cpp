// .obj files with their materials, good and bad, and polygons.
#include "scenes/obj_load.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>

#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/gltf_load.h"
#include "scenes/gltf_save.h"
#include "scenes/polygon.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kCrate = PROBEBENCH_SOURCE_DIR "/tests/data/obj/crate.obj";

Scene loadText(const std::string& obj, const std::string& mtl = "") {
  const TemporaryFolder folder;
  std::ofstream(folder.file("scene.obj")) << (mtl.empty() ? obj : "mtllib my scene.mtl\n" + obj);
  if (!mtl.empty()) std::ofstream(folder.file("my scene.mtl")) << mtl;
  return loadObj(folder.file("scene.obj"));
}

double areaOf(const Mesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                     c = mesh.positions[mesh.indices[i + 2]];
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(LoadObj, OfObjectsWithSeveralMaterials_MakesANodeEachWithAnInstanceForEachMaterial) {
  const Scene scene = loadObj(kCrate);
  EXPECT_EQ(scene.name, "crate");
  ASSERT_THAT(scene.instances, SizeIs(3));
  EXPECT_EQ(scene.nodes.at(0).name, "Crate");
  EXPECT_EQ(scene.nodes.at(1).name, "Pane");
  EXPECT_EQ(scene.instances[0].node, 0);
  EXPECT_EQ(scene.instances[1].node, 0);
  EXPECT_EQ(scene.instances[2].node, 1);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(scene.notes, Contains(HasSubstr("procedural sky")));
}

TEST(LoadObj, WithSeparateIndices_JoinsWhatBelongsTogether) {
  const Scene scene = loadObj(kCrate);
  const Mesh& planks = *scene.instances[0].mesh;
  EXPECT_EQ(planks.triangleCount(), 6U);
  EXPECT_THAT(planks.positions,
              SizeIs(12));  // corners of three faces are shared by no other face: their normals differ
  EXPECT_NEAR(areaOf(planks), 12.0, 1e-6);
  for (std::size_t i = 0; i < planks.indices.size(); i += 3) {
    const std::array k = {planks.indices[i], planks.indices[i + 1], planks.indices[i + 2]};
    const glm::vec3 p = planks.positions[k[0]];
    const glm::vec3 normal = glm::normalize(glm::cross(planks.positions[k[1]] - p, planks.positions[k[2]] - p));
    for (const std::uint32_t vertex : k) EXPECT_EQ(planks.normals[vertex], normal);
  }
  // Rows of images count from the top here, from the bottom there.
  EXPECT_THAT(planks.uvs[0], Contains(glm::vec2(1.0f, 0.25f)));
}

TEST(LoadObj, WithNegativeIndices_CountsFromTheLastVertexBefore) {
  const Scene scene = loadObj(kCrate);
  const Mesh& pane = *scene.instances[2].mesh;
  EXPECT_EQ(pane.bounds.lower, glm::vec3(-1.5f, 0.0f, 2.0f));
  EXPECT_EQ(pane.bounds.upper, glm::vec3(1.5f, 1.0f, 2.0f));
}

TEST(LoadObj, WithoutNormals_IsFlat) {
  const Scene scene = loadText("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\n");
  const Mesh& mesh = *scene.instances[0].mesh;
  EXPECT_THAT(mesh.positions, SizeIs(6));
  EXPECT_THAT(mesh.normals, Contains(glm::vec3(0, 0, 1)));
  EXPECT_THAT(mesh.normals, Contains(glm::vec3(0, 1, 0)));
}

TEST(LoadObj, WithANormalOfNoLength_IsFlatToo) {
  const Scene scene = loadText(kSquare + "vn 0 0 0\nf 1//1 2//1 3//1\n");
  EXPECT_THAT(scene.instances[0].mesh->normals, ::testing::Each(glm::vec3(0, 0, 1)));
}

TEST(LoadObj, OfConcaveFaces_CoversTheirAreaOnce) {
  // An L of three unit squares.
  const Scene scene = loadText("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n");
  const Mesh& mesh = *scene.instances[0].mesh;
  EXPECT_EQ(mesh.triangleCount(), 4U);
  EXPECT_NEAR(areaOf(mesh), 3.0, 1e-6);
  EXPECT_THAT(mesh.normals, ::testing::Each(glm::vec3(0, 0, 1)));
}

TEST(LoadObj, OfAMaterialWithATexture_ReadsItAndItsScale) {
  const Scene scene = loadObj(kCrate);
  const Material& planks = scene.materials[static_cast<std::size_t>(scene.instances[0].material)];
  EXPECT_EQ(planks.name, "Planks");
  EXPECT_EQ(planks.constants.kind.x, shading::kSurfaceGlossy);
  EXPECT_FLOAT_EQ(planks.constants.factors.y, 0.5f);  // 1 - sqrt(250 / 1000)
  EXPECT_EQ(planks.constants.specular.w, 1.0f);
  ASSERT_EQ(planks.baseColorTexture, 0);
  const ImageRgba& texels = scene.textures[0].levels[0];
  EXPECT_NEAR(texels(1, 0).x, 0.0331, 1e-4);  // 51 of 255 is 0.2, decoded ((0.2 + 0.055) / 1.055)^2.4
  // (u, v) of the file reads the image at (2 u, 3 v) from below: 1 - 3 v = 3 (1 - v) - 2 from above.
  EXPECT_EQ(planks.constants.baseColorSlot.matrix, glm::vec4(2, 0, 0, 3));
  EXPECT_EQ(planks.constants.baseColorSlot.offset, glm::vec4(0, -2, 0, 1));
}

struct MtlCase {
  const char *name, *mtl;
  float kind, metallic, roughness, specular;
  glm::vec4 baseColor;
  bool isSpecularDominant;
};

class MtlMaterials : public ::testing::TestWithParam<MtlCase> {};

TEST_P(MtlMaterials, BecomesTheNearestKindOfSurface) {
  const MtlCase& expected = GetParam();
  const Scene scene = loadText(kSquare + "usemtl m \nf 1 2 3 4\n", std::string("newmtl m\n") + expected.mtl);
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.constants.kind.x, expected.kind);
  EXPECT_FLOAT_EQ(m.constants.factors.x, expected.metallic);
  EXPECT_NEAR(m.constants.factors.y, expected.roughness, 1e-6);
  EXPECT_FLOAT_EQ(m.constants.specular.w, expected.specular);
  EXPECT_EQ(m.constants.baseColor, expected.baseColor);
  EXPECT_EQ(m.isSpecularDominant, expected.isSpecularDominant);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, MtlMaterials,
    ::testing::Values(
        MtlCase{"matte",
                "Kd 0.5 0.25 1\nKs 1 1 1\nillum 1\n",
                shading::kSurfaceDiffuse,
                0,
                0.5f,
                0,
                {0.5, 0.25, 1, 1},
                false},
        MtlCase{"lacquer",
                "Kd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nNs 1000\nillum 2\n",
                shading::kSurfaceGlossy,
                0,
                0,
                0.5f,
                {0.5, 0.5, 0.5, 1},
                false},
        MtlCase{"mirror", "Kd 0 0 0\nKs 0.5 1 1\nillum 3\n", shading::kSurfaceMirror, 1, 0, 1, {0.5, 1, 1, 1}, true},
        MtlCase{"metal",
                "Kd 0.5 0.5 0.25\nKs 0 0 0\nNs 250\nillum 3\n",
                shading::kSurfaceGlossy,
                1,
                0.5f,
                0,
                {0.5, 0.5, 0.25, 1},
                false},
        MtlCase{"pbr",
                "Kd 0.5 0.5 0.5\nPm 0.75\nPr 0.25\nNs 10\nillum 3\n",
                shading::kSurfaceGlossy,
                0.75f,
                0.25f,
                1,
                {0.5, 0.5, 0.5, 1},
                true},
        MtlCase{
            "glass", "Kd 0 0 0\nNi 1.33\nTf 1 0.5 1\nillum 7\n", shading::kSurfaceGlass, 0, 0, 1, {1, 0.5, 1, 1}, true},
        MtlCase{"veil",
                "Kd 0.5 0.5 0.5\nillum 1\nTr 0.75\n",
                shading::kSurfaceDiffuse,
                0,
                0.5f,
                0,
                {0.5, 0.5, 0.5, 0.25},
                false}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(LoadObj, OfRefractingGlass_IsAsThickAsItsMeshAndSingleSided) {
  const std::string box =
      "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nusemtl m\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";  // a closed corner
  const Scene scene = loadText(box, "newmtl m\nillum 6\nNi 1.33\n");
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.constants.kind, glm::vec4(shading::kSurfaceGlass, 1.33f, 1.0f, 0.0f));
  EXPECT_FALSE(m.doubleSided);
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(LoadObj, OfAMaterialThatNoLibraryHas_WarnsAndIsGrey) {
  const Scene scene = loadText(kSquare + "usemtl lost\nf 1 2 3\n");
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("'lost': is in none of the file's libraries")));
  EXPECT_EQ(scene.materials[0].constants.baseColor, glm::vec4(0.8f, 0.8f, 0.8f, 1.0f));
}

TEST(LoadObj, OfMapsThatItDoesNotRead_WarnsByName) {
  const Scene scene = loadText(kSquare + "usemtl m\nf 1 2 3\n", "newmtl m\nKd 2 1 1\nmap_Bump bumps.png\n");
  EXPECT_THAT(scene.warnings, ElementsAre("material 'm': Kd is from 0 to 1, what exceeds that is cut",
                                          "material 'm': map_Bump is ignored"));
}

TEST(LoadObj, OfFacesWithoutArea_LeavesThemOutAndCountsThem) {
  const Scene scene = loadText(kSquare + "f 1 2 3\nf 1 2 1\nf 1 1 1\n");
  EXPECT_EQ(scene.instances[0].mesh->triangleCount(), 1U);
  EXPECT_THAT(scene.warnings, ElementsAre("2 faces without area are left out"));
}

TEST(LoadObj, WrittenAsGlb_IsTheSameScene) {
  const TemporaryFolder folder;
  const auto scene = std::make_shared<const Scene>(loadObj(kCrate));
  saveGlb(*scene, folder.file("crate.glb"));
  const auto loaded = std::make_shared<const Scene>(loadGltf(folder.file("crate.glb")));
  EXPECT_EQ(contentHash(*makeSnapshot(scene, 0, "", 1.5)), contentHash(*makeSnapshot(loaded, 0, "", 1.5)));
}

TEST(LoadScene, OfAnObjFile_TakesTheOptionsOfFiles) {
  const auto scene = loadScene(kCrate + "?mirror=Crate&environment=white&shadows=traced");
  EXPECT_TRUE(scene->castsShadows);
  EXPECT_EQ(scene->environment.name, loadScene("builtin:mirrors?environment=white")->environment.name);
  EXPECT_TRUE(scene->materials[static_cast<std::size_t>(scene->instances[0].material)].isSpecularDominant);
  EXPECT_FALSE(scene->materials[static_cast<std::size_t>(scene->instances[2].material)].isSpecularDominant);
}

TEST(LoadObj, OfBadInput_SaysWhatIsWrongInOneSentence) {
  struct BadCase {
    std::string obj, mtl;
    const char* message;
  };
  const std::vector<BadCase> cases = {
      {"", "", "the file draws no triangle"},
      {kSquare, "", "the file draws no triangle"},
      {"v 0 0\n", "", "line 1: 'v' wants 3 or more finite numbers, got 'v 0 0'"},
      {kSquare + "v 1 x 2\n", "", "line 5: 'v' wants 3 or more finite numbers, got 'v 1 x 2'"},
      {kSquare + "v 1 nan 2\n", "", "line 5: 'v' wants"},
      {kSquare + "vn 1e999 0 0\n", "", "line 5: 'vn' wants"},
      {kSquare + "f 1 2\n", "", "face 1 wants 3 to 4096 corners, got 2"},
      {kSquare + "f 1 2 5\n", "", "face 1 wants vertex 5 of 4 before it"},
      {kSquare + "f 1 2 3\nf -5 2 3\n", "", "face 2 wants vertex -5 of 4 before it"},
      {kSquare + "f 0 1 2\n", "", "face 1 wants vertices from 1 on, got 0"},
      {kSquare + "f 1/1 2/1 3/1\n", "", "face 1 wants texture coordinate 1 of 0 before it"},
      {kSquare + "f 1//2 2//2 3//2\n", "", "face 1 wants normal 2 of 0 before it"},
      {kSquare + "f 1 two 3\n", "", "line 5: faces consist of indices such as 1, 1/2, 1//3 or 1/2/3, got 'two'"},
      {"f 1 2 3\n" + kSquare, "", "face 1 wants vertex 1 of 0 before it"},
      {"mtllib missing.mtl\n" + kSquare + "f 1 2 3\n", "", "missing.mtl"},
      {kSquare + "usemtl m\nf 1 2 3\n", "newmtl m\nKd red\n", "line 2: 'Kd' wants 1 or more finite numbers"},
      {kSquare + "usemtl m\nf 1 2 3\n", "newmtl m\nmap_Kd missing.png\n", "missing.png"},
  };
  for (const BadCase& bad : cases) {
    try {
      loadText(bad.obj, bad.mtl);
      ADD_FAILURE() << "accepted " << bad.obj << bad.mtl;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), Failure::input);
      EXPECT_THAT(e.what(), HasSubstr(bad.message));
      EXPECT_THAT(e.what(), HasSubstr(bad.mtl.empty() ? "scene.obj" : "scene."));
      EXPECT_THAT(e.what(), ::testing::Not(HasSubstr("\n")));
    }
  }
}

std::vector<glm::vec3> star(int tips, const glm::vec3& u, const glm::vec3& v) {
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 2 * tips; ++i) {
    const double angle = 3.14159265358979 * i / tips, radius = i % 2 == 0 ? 1.0 : 0.3;
    corners.push_back(static_cast<float>(radius * std::cos(angle)) * u +
                      static_cast<float>(radius * std::sin(angle)) * v);
  }
  return corners;
}

TEST(Triangulate, OfStarsInAnyPlaneAndOrientation_CoversTheirAreaOnce) {
  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), tilted = glm::normalize(glm::vec3(1, 2, 3));
  const glm::vec3 across = glm::normalize(glm::cross(tilted, y));
  for (const auto& [u, v] : {std::pair(x, y), std::pair(y, x), std::pair(y, z), std::pair(z, x),
                             std::pair(tilted, across), std::pair(across, tilted)})
    for (const int tips : {3, 8, 50}) {
      const std::vector<glm::vec3> corners = star(tips, u, v);
      const auto triangles = triangulate(corners);
      EXPECT_EQ(triangles.size(), corners.size() - 2);
      double area = 0.0;
      for (const auto& [a, b, c] : triangles) {
        const double part = 0.5 * static_cast<double>(glm::dot(
                                      glm::cross(corners[b] - corners[a], corners[c] - corners[a]), glm::cross(u, v)));
        EXPECT_GT(part, 0.0);
        area += part;
      }
      // 2 n triangles with sides 1 and 0.3 and the angle pi / n between them.
      EXPECT_NEAR(area, tips * 0.3 * std::sin(3.14159265358979 / tips), 1e-5);
    }
}

TEST(Triangulate, OfSelfCrossingAndCollinearCorners_Ends) {
  const std::vector<glm::vec3> bow = {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}};
  EXPECT_THAT(triangulate(bow), SizeIs(2));
  const std::vector<glm::vec3> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  EXPECT_THAT(triangulate(line), IsEmpty());
}

}  // namespace
}  // namespace pb
