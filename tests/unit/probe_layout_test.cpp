// Where a technique's probes stand and who owns them; meshes cut into their parts.
#include "raster/probe_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "raster/probe_resolution.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/mesh_parts.h"

namespace pb {
namespace {

using glm::vec3;
using testing::ElementsAre;
using testing::SizeIs;

void appendBox(Mesh& mesh, const vec3& centre, float edge) {
  const Mesh box = makeBoxMesh(vec3(edge));
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const vec3& p : box.positions) mesh.positions.push_back(p + centre);
  mesh.normals.insert(mesh.normals.end(), box.normals.begin(), box.normals.end());
  mesh.uvs[0].insert(mesh.uvs[0].end(), box.uvs[0].begin(), box.uvs[0].end());
  for (const std::uint32_t index : box.indices) mesh.indices.push_back(first + index);
}

// A cube of 1 m at x = 0 and one of 0.5 m at x = 3.
std::shared_ptr<const Mesh> makeTwoBoxes() {
  Mesh mesh;
  appendBox(mesh, vec3(0.0f), 1.0f);
  appendBox(mesh, vec3(3.0f, 0.0f, 0.0f), 0.5f);
  return finishMesh(std::move(mesh));
}

Snapshot snapshotWith(const std::shared_ptr<const Mesh>& mesh, const std::vector<vec3>& places) {
  Scene scene;
  scene.environment = makeConstantEnvironment(vec3(1.0f));
  addCamera(scene, "camera", vec3(0, 0, 9), vec3(0), 0.8f, 0.1f);
  const int mirror = addMaterial(scene, makeMirrorMaterial("mirror"));
  for (const vec3& place : places) {
    Node node;
    node.translation = place;
    addInstance(scene, "mirror", mesh, mirror, node);
  }
  finishScene(scene);
  return *makeSnapshot(std::make_shared<const Scene>(std::move(scene)), 0, "", 1.0);
}

vec3 placed(Placement placement) {
  Technique technique;
  technique.placement = placement;
  ProbeLayout layout(technique);
  return layout.apply(snapshotWith(makeTwoBoxes(), {vec3(1, 2, 3)})).probes.at(0).position;
}

void expectNear(const vec3& a, const vec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Placement, Origin_IsTheNodes) { expectNear(placed(Placement::origin), vec3(1, 2, 3)); }

// The box goes from -0.5 to 3.25.
TEST(Placement, BoxCentre_IsThatOfTheBoundsInTheWorld) {
  expectNear(placed(Placement::boxCentre), vec3(1 + 1.375f, 2, 3));
}

// Areas 6 and 1.5: (0 * 6 + 3 * 1.5) / 7.5 = 0.6.
TEST(Placement, Centroid_IsThatOfTheSurface) { expectNear(placed(Placement::centroid), vec3(1 + 0.6f, 2, 3)); }

TEST(Placement, Stated_LeavesTheSnapshotAsItIs) {
  const Snapshot snapshot = snapshotWith(makeTwoBoxes(), {vec3(0)});
  ProbeLayout layout((Technique()));
  EXPECT_EQ(&layout.apply(snapshot), &snapshot);
}

// Mirrors of 0.5 m at x = 0, 1 and 5.
std::vector<Probe> shared(const char* sharing) {
  Mesh mesh;
  appendBox(mesh, vec3(0.0f), 0.5f);
  Technique technique;
  technique.sharing = parseSpec(sharing);
  ProbeLayout layout(technique);
  const Snapshot& laidOut =
      layout.apply(snapshotWith(finishMesh(std::move(mesh)), {vec3(0), vec3(1, 0, 0), vec3(5, 0, 0)}));
  for (std::size_t probe = 0; probe < laidOut.probes.size(); ++probe)
    for (const int owner : laidOut.probes[probe].owners)
      EXPECT_EQ(laidOut.instances[static_cast<std::size_t>(owner)].probe, static_cast<int>(probe));
  return laidOut.probes;
}

TEST(Sharing, ByDistance_JoinsNeighboursAtTheMeanOfTheirPlaces) {
  const std::vector<Probe> probes = shared("distance?metres=1.5");
  ASSERT_THAT(probes, SizeIs(2));
  EXPECT_THAT(probes[0].owners, ElementsAre(0, 1));
  EXPECT_THAT(probes[1].owners, ElementsAre(2));
  expectNear(probes[0].position, vec3(0.5f, 0, 0));
  expectNear(probes[1].position, vec3(5, 0, 0));
}

TEST(Sharing, ByDistance_LeavesThoseApartThatAreFartherAway) { EXPECT_THAT(shared("distance?metres=0.9"), SizeIs(3)); }

TEST(Sharing, ByCount_JoinsUntilThatManyAreLeft) {
  EXPECT_THAT(shared("count?probes=3"), SizeIs(3));
  EXPECT_THAT(shared("count?probes=2").at(0).owners, ElementsAre(0, 1));
  const std::vector<Probe> one = shared("count?probes=1");
  ASSERT_THAT(one, SizeIs(1));
  EXPECT_THAT(one[0].owners, ElementsAre(0, 1, 2));
  expectNear(one[0].position, vec3(2, 0, 0));
}

TEST(Sharing, RefusesUnknownKindsAndParameters) {
  for (const char* bad : {"always", "distance?meters=1", "distance?metres=-1", "count?probes=0", "none?n=1"})
    EXPECT_THROW(checkSharing(parseSpec(bad)), Error) << bad;
}

Technique splitting() {
  Technique technique;
  technique.selfReflection = SelfReflection::splitParts;
  return technique;
}

TEST(SplitParts, GivesEachPartAnInstanceWithAProbeAtItsCentre) {
  ProbeLayout layout(splitting());
  const Snapshot& laidOut = layout.apply(snapshotWith(makeTwoBoxes(), {vec3(0), vec3(0, 4, 0)}));
  ASSERT_THAT(laidOut.instances, SizeIs(4));
  ASSERT_THAT(laidOut.probes, SizeIs(4));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(laidOut.instances[i].probe, static_cast<int>(i));
    EXPECT_EQ(laidOut.instances[i].source, static_cast<int>(i / 2)) << "ids stay those of the scene";
    EXPECT_THAT(laidOut.probes[i].owners, ElementsAre(static_cast<int>(i)));
    expectNear(laidOut.probes[i].position, vec3(i % 2 == 0 ? 0 : 3, i / 2 == 0 ? 0 : 4, 0));
  }
}

TEST(SplitParts, CutsAMeshOnce) {
  ProbeLayout layout(splitting());
  const Snapshot snapshot = snapshotWith(makeTwoBoxes(), {vec3(0), vec3(0, 4, 0)});
  const std::shared_ptr<const Mesh> first = layout.apply(snapshot).instances[0].mesh;
  EXPECT_EQ(layout.apply(snapshot).instances[2].mesh, first);
}

TEST(SplitParts, LeavesMeshesThatDeformWhole) {
  Snapshot snapshot = snapshotWith(makeTwoBoxes(), {vec3(0)});
  Mesh deformed = *snapshot.instances[0].mesh;
  deformed.isDeformed = true;
  snapshot.instances[0].mesh = std::make_shared<const Mesh>(std::move(deformed));
  ProbeLayout layout(splitting());
  EXPECT_THAT(layout.apply(snapshot).instances, SizeIs(1));
}

TEST(SplitParts, CanShareProbesAgain) {
  Technique technique = splitting();
  technique.sharing = parseSpec("count?probes=1");
  ProbeLayout layout(technique);
  const Snapshot& laidOut = layout.apply(snapshotWith(makeTwoBoxes(), {vec3(0)}));
  ASSERT_THAT(laidOut.probes, SizeIs(1));
  EXPECT_THAT(laidOut.probes[0].owners, ElementsAre(0, 1));
}

// A box has 24 vertices, four to a side: sides belong together because their corners have equal positions.
TEST(MeshParts, AreJoinedByEqualPositions) {
  Mesh box;
  appendBox(box, vec3(0.0f), 1.0f);
  const auto mesh = finishMesh(std::move(box));
  EXPECT_THAT(connectedParts(mesh, 8), ElementsAre(mesh));
}

TEST(MeshParts, KeepAllTrianglesAndAttributes) {
  const auto parts = connectedParts(makeTwoBoxes(), 8);
  ASSERT_THAT(parts, SizeIs(2));
  for (const auto& part : parts) {
    EXPECT_THAT(part->indices, SizeIs(36));
    EXPECT_THAT(part->positions, SizeIs(24));
    EXPECT_THAT(part->normals, SizeIs(24));
    EXPECT_THAT(part->uvs[0], SizeIs(24));
  }
  expectNear(parts[0]->bounds.extent(), vec3(1.0f));
  expectNear(parts[1]->bounds.centre(), vec3(3, 0, 0));
}

TEST(MeshParts, BeyondTheLimit_JoinTheirNearestLargerPart) {
  Mesh mesh;
  appendBox(mesh, vec3(0.0f), 1.0f);
  appendBox(mesh, vec3(5.0f, 0.0f, 0.0f), 0.5f);
  appendBox(mesh, vec3(4.0f, 0.0f, 0.0f), 0.1f);
  const auto parts = connectedParts(finishMesh(std::move(mesh)), 2);
  ASSERT_THAT(parts, SizeIs(2));
  EXPECT_THAT(parts[0]->indices, SizeIs(36));
  EXPECT_THAT(parts[1]->indices, SizeIs(72));
}

// A mirror ball of 2 m seen from `distance` under 90 degrees in a picture of 100 pixels in height.
int resolutionAt(float distance, int most = 256) {
  Snapshot snapshot = snapshotWith(makeTwoBoxes(), {vec3(0)});
  const float edge = 2.0f / std::sqrt(3.0f);  // of the cube in the sphere
  snapshot.instances[0].worldBounds = {vec3(-0.5f * edge), vec3(0.5f * edge)};
  snapshot.camera = cubeFaceView(vec3(0, 0, distance), 5, 0.1f);
  Technique technique;
  technique.resolution = most;
  technique.resolutionScale = ResolutionScale::distance;
  return probeResolutions(technique, snapshot, 100).at(0);
}

// 100 pixels / distance are the ball's diameter.
TEST(ProbeResolution, ByDistance_IsNoLessThanTheOwnersDiameterInPixels) {
  EXPECT_EQ(resolutionAt(0.9f), 256) << "inside";
  EXPECT_EQ(resolutionAt(0.99f * 100.0f / 64.0f), 128);
  EXPECT_EQ(resolutionAt(1.01f * 100.0f / 64.0f), 64);
  EXPECT_EQ(resolutionAt(1.01f * 100.0f / 32.0f), 32);
  EXPECT_EQ(resolutionAt(1.01f * 100.0f / 16.0f), 16);
}

TEST(ProbeResolution, ByDistance_IsFromEightToTheTechniques) {
  EXPECT_EQ(resolutionAt(1e6f), 8);
  EXPECT_EQ(resolutionAt(0.0f, 64), 64);
  EXPECT_EQ(resolutionAt(1.5f, 16), 16);
}

TEST(ProbeResolution, Fixed_IsTheTechniquesAtAnyDistance) {
  Snapshot snapshot = snapshotWith(makeTwoBoxes(), {vec3(0), vec3(0, 0, -1000)});
  EXPECT_THAT(probeResolutions(Technique(), snapshot, 100), ElementsAre(256, 256));
}

}  // namespace
}  // namespace pb
