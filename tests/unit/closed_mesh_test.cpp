// What counts as a closed body, and the warning about glass that is none.
#include "scenes/closed_mesh.h"

#include <gmock/gmock.h>

#include <array>
#include <glm/gtc/constants.hpp>

#include "scenes/builtin.h"
#include "scenes/builtin/shapes.h"
#include "scenes/builtin/teapot_mesh.h"

namespace pb {
namespace {

Boundary boundaryOf(Mesh mesh) {
  const auto finished = finishMesh(std::move(mesh));
  const std::array meshes = {finished.get()};
  return pb::boundaryOf(meshes);
}

TEST(Boundary, OfShapesWithSeams_IsClosed) {
  EXPECT_EQ(boundaryOf(makeBoxMesh({1, 2, 3})), Boundary::closed);
  EXPECT_EQ(boundaryOf(makeSphereMesh(1, 64, 32)), Boundary::closed);
  EXPECT_EQ(boundaryOf(makeTorusMesh(1, 0.3f, 64, 32)), Boundary::closed);
  Mesh far = makeSphereMesh(0.1f, 32, 16);  // its positions are rounded to steps of 6e-5
  for (glm::vec3& p : far.positions) p.x += 1000.0f;
  EXPECT_EQ(boundaryOf(far), Boundary::closed);
}

TEST(Boundary, OfSurfacesWithRimsOrHoles_IsOpen) {
  EXPECT_EQ(boundaryOf(makeQuadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0})), Boundary::open);
  EXPECT_EQ(boundaryOf(makeTeapotMesh(4)), Boundary::open);  // its lid and handle end inside the body
  Mesh box = makeBoxMesh(glm::vec3(1));
  box.indices.resize(box.indices.size() - 3);
  EXPECT_EQ(boundaryOf(box), Boundary::open);
}

TEST(Boundary, WithOneTriangleTurnedRound_IsOpen) {
  Mesh box = makeBoxMesh(glm::vec3(1));
  std::swap(box.indices[0], box.indices[1]);
  EXPECT_EQ(boundaryOf(box), Boundary::open);
}

TEST(Boundary, WithAllTrianglesTurnedRound_IsInsideOut) {
  Mesh box = makeBoxMesh(glm::vec3(1));
  for (std::size_t i = 0; i < box.indices.size(); i += 3) std::swap(box.indices[i], box.indices[i + 1]);
  EXPECT_EQ(boundaryOf(box), Boundary::insideOut);
}

TEST(Boundary, OfTwoHalvesOfABody_IsClosed) {
  Mesh lower = makeBoxMesh(glm::vec3(1)), upper = lower;
  lower.indices.resize(18);
  upper.indices.erase(upper.indices.begin(), upper.indices.begin() + 18);
  const auto a = finishMesh(lower), b = finishMesh(upper);
  EXPECT_EQ(pb::boundaryOf(std::array{a.get(), b.get()}), Boundary::closed);
  EXPECT_EQ(pb::boundaryOf(std::array{a.get()}), Boundary::open);
}

Scene sceneWith(Mesh mesh, Material material) {
  Scene scene;
  mesh.name = "pane mesh";
  addInstance(scene, "pane", finishMesh(std::move(mesh)), addMaterial(scene, std::move(material)));
  return scene;
}

TEST(OpenGlass, IsWarnedOfByNodeAndMesh) {
  Scene thick = sceneWith(makeQuadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), makeGlassMaterial("glass", 1.5f, 0.01f));
  warnOfOpenGlass(thick);
  EXPECT_THAT(thick.warnings,
              testing::ElementsAre("node 'pane': its glass has a thickness, but mesh 'pane mesh' is not "
                                   "closed: light that enters it may never leave it"));
  Scene thin = sceneWith(makeQuadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), makeGlassMaterial("glass", 1.5f, 0.0f));
  Scene closed = sceneWith(makeBoxMesh(glm::vec3(1)), makeGlassMaterial("glass", 1.5f));
  Scene opaque = sceneWith(makeQuadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), makeMirrorMaterial("mirror"));
  for (Scene* scene : {&thin, &closed, &opaque}) {
    warnOfOpenGlass(*scene);
    EXPECT_THAT(scene->warnings, testing::IsEmpty());
  }
}

TEST(OpenGlass, IsInNoBuiltinScene) {
  for (const BuiltinScene& builtin : builtinScenes()) {
    Scene scene = makeBuiltinScene({builtin.name, {}});
    warnOfOpenGlass(scene);
    EXPECT_THAT(scene.warnings, testing::IsEmpty()) << builtin.name;
  }
}

}  // namespace
}  // namespace pb
