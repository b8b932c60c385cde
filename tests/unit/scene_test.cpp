// The scene model: meshes, animation, snapshots and the built-in scenes.
#include "scenes/scene.h"

#include <gmock/gmock.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <map>
#include <set>

#include "scenes/builtin.h"
#include "scenes/builtin/shapes.h"
#include "scenes/builtin/teapot_mesh.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/gltf_save.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

Mesh makeTriangle() {
  Mesh mesh;
  mesh.name = "triangle";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2};
  return mesh;
}

// Smallest cosine between a triangle's own normal and its vertices' normals.
float smallestCosine(const Mesh& mesh) {
  float smallest = 1.0f;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                    c = mesh.positions[mesh.indices[i + 2]];
    const glm::vec3 face = glm::normalize(glm::cross(b - a, c - a));
    for (std::size_t k = 0; k < 3; ++k)
      smallest = std::min(smallest, glm::dot(face, mesh.normals[mesh.indices[i + k]]));
  }
  return smallest;
}

TEST(FinishMesh, WithoutNormals_GetsFlatOnesAlongTheWinding) {
  const auto mesh = finishMesh(makeTriangle());
  ASSERT_EQ(mesh->normals.size(), 3U);
  for (const glm::vec3& n : mesh->normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
}

TEST(FinishMesh, TrianglesWithoutArea_AreDropped) {
  Mesh mesh = makeTriangle();
  mesh.indices.insert(mesh.indices.end(), {0, 0, 1, 1, 1, 1});
  EXPECT_EQ(finishMesh(std::move(mesh))->triangleCount(), 1U);
}

TEST(FinishMesh, BadInput_IsRefused) {
  Mesh nan = makeTriangle();
  nan.positions[1].y = std::nanf("");
  EXPECT_THROW(finishMesh(nan), Error);
  Mesh outOfRange = makeTriangle();
  outOfRange.indices[2] = 3;
  EXPECT_THROW(finishMesh(outOfRange), Error);
  Mesh uneven = makeTriangle();
  uneven.indices.push_back(0);
  EXPECT_THROW(finishMesh(uneven), Error);
  Mesh shortNormals = makeTriangle();
  shortNormals.normals.assign(1, glm::vec3(0, 0, 1));
  EXPECT_THROW(finishMesh(shortNormals), Error);
}

TEST(FinishMesh, SmoothingGroups_JoinTrianglesWithCommonNormals) {
  const auto box = finishMesh(makeBoxMesh(glm::vec3(1)));
  const auto sphere = finishMesh(makeSphereMesh(1, 16, 8));
  EXPECT_EQ(std::set<std::uint32_t>(box->smoothingGroups.begin(), box->smoothingGroups.end()).size(), 6U);
  EXPECT_EQ(std::set<std::uint32_t>(sphere->smoothingGroups.begin(), sphere->smoothingGroups.end()).size(), 1U);
}

TEST(FinishMesh, UvPerMetre_IsTheTextureScale) {
  // The unit square of texture coordinates over 4 x 4 metres.
  const auto quad = finishMesh(makeQuadMesh({0, 0, 0}, {4, 0, 0}, {0, 4, 0}));
  for (const float density : quad->uvPerMetre) EXPECT_FLOAT_EQ(density, 0.25f);
}

TEST(FinishMesh, ContentHash_SeesEveryArray) {
  const std::uint64_t original = finishMesh(makeQuadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}))->contentHash;
  Mesh moved = makeQuadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  moved.positions[2].z = 1e-6f;
  Mesh recoloured = makeQuadMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  recoloured.colors.assign(4, glm::vec4(1.0f));
  EXPECT_NE(finishMesh(std::move(moved))->contentHash, original);
  EXPECT_NE(finishMesh(std::move(recoloured))->contentHash, original);
}

TEST(Shapes, TrianglesFaceTheSideOfTheirNormals) {
  // Facets and normals of a smooth shape differ by less than the angle between neighbouring facets.
  EXPECT_GT(smallestCosine(makeSphereMesh(1, 32, 16)), 0.95f);
  EXPECT_GT(smallestCosine(makeTorusMesh(1, 0.3f, 64, 32)), 0.95f);
  EXPECT_FLOAT_EQ(smallestCosine(makeBoxMesh({1, 2, 3})), 1.0f);
  // The teapot's knob and handle have tight curves.
  EXPECT_GT(smallestCosine(*finishMesh(makeTeapotMesh(16))), 0.0f);
}

TEST(Shapes, Teapot_StandsOnTheGroundAndIsAsLargeAsNewells) {
  const auto teapot = finishMesh(makeTeapotMesh(32));
  EXPECT_NEAR(teapot->bounds.lower.y, 0.0f, 1e-6f);
  EXPECT_NEAR(teapot->bounds.upper.y, 0.5f * 3.15f, 1e-6f);
  // The published surface reaches from -3 (handle) to 3.4316 (spout) and is 4 wide, in units of half a metre.
  EXPECT_NEAR(teapot->bounds.lower.x, -1.5f, 2e-3f);
  EXPECT_NEAR(teapot->bounds.upper.x, 0.5f * 3.4316f, 2e-3f);
  EXPECT_NEAR(teapot->bounds.upper.z, 1.0f, 2e-3f);
}

TEST(Shapes, TeapotBody_NormalsPointAwayFromTheAxis) {
  const Mesh mesh = makeTeapotMesh(8);
  // The second profile is the upper body; four quarters of 81 vertices each before it.
  for (std::size_t v = 4 * 81; v < 8 * 81; ++v) {
    const glm::vec3 p = mesh.positions[v];
    EXPECT_GT(glm::dot(mesh.normals[v], glm::vec3(p.x, 0, p.z)), 0.0f);
  }
}

TEST(Texture, MipLevels_HalveAndKeepTheMean) {
  ImageRgba texels(6, 3);
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = glm::vec4(static_cast<float>(i));
  const Texture texture = makeTexture("t", texels);
  ASSERT_EQ(texture.levels.size(), 3U);
  EXPECT_EQ(texture.levels[1].width(), 3);
  EXPECT_EQ(texture.levels[1].height(), 1);
  EXPECT_EQ(texture.levels[2].width(), 1);
  EXPECT_NEAR(texture.levels[2](0, 0).x, 8.5f, 1e-5f);
}

TEST(Track, Interpolation_MeetsItsDefinition) {
  Track track;
  track.timesSeconds = {1.0f, 3.0f};
  track.values = {{0, 0, 0, 0}, {4, 8, 0, 0}};
  EXPECT_EQ(sampleTrack(track, 0.0), glm::vec4(0, 0, 0, 0));
  EXPECT_EQ(sampleTrack(track, 2.0), glm::vec4(2, 4, 0, 0));
  EXPECT_EQ(sampleTrack(track, 9.0), glm::vec4(4, 8, 0, 0));
  track.interpolation = Interpolation::step;
  EXPECT_EQ(sampleTrack(track, 2.9), glm::vec4(0, 0, 0, 0));
  // Hermite with zero tangents is the smooth step: 3/4 of a quarter squared ... at t = 1/4: 3/16 - 2/64 = 5/32.
  track.interpolation = Interpolation::cubicSpline;
  track.values = {glm::vec4(0), glm::vec4(0), glm::vec4(0), glm::vec4(0), glm::vec4(1), glm::vec4(0)};
  EXPECT_NEAR(sampleTrack(track, 1.5).x, 5.0 / 32.0, 1e-6);
  // A tangent of 1 a second over 2 s adds 2 (t^3 - 2 t^2 + t) = 2 * 9/64.
  track.values[2] = glm::vec4(1);
  EXPECT_NEAR(sampleTrack(track, 1.5).x, 5.0 / 32.0 + 18.0 / 64.0, 1e-6);
}

TEST(Track, Rotations_AreInterpolatedAtConstantSpeed) {
  Track track;
  track.target = TrackTarget::rotation;
  track.timesSeconds = {0.0f, 1.0f};
  const glm::quat end = glm::angleAxis(glm::half_pi<float>(), glm::vec3(0, 1, 0));
  track.values = {{0, 0, 0, 1}, {end.x, end.y, end.z, end.w}};
  const glm::vec4 q = sampleTrack(track, 1.0 / 3.0);
  const glm::quat expected = glm::angleAxis(glm::half_pi<float>() / 3.0f, glm::vec3(0, 1, 0));
  EXPECT_NEAR(q.y, expected.y, 1e-6f);
  EXPECT_NEAR(q.w, expected.w, 1e-6f);
}

std::shared_ptr<const Scene> sceneWith(Node node, Material material) {
  Scene scene;
  addInstance(scene, "object", finishMesh(makeBoxMesh({1, 2, 3})), addMaterial(scene, std::move(material)),
              std::move(node));
  finishScene(scene);
  return std::make_shared<const Scene>(std::move(scene));
}

TEST(Snapshot, NormalsUnderMirroredAndUnevenScale_StayPerpendicularAndOutside) {
  Node node;
  node.scale = {-2.0f, 0.5f, 3.0f};
  node.rotation = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 2, 3)));
  const auto snapshot = makeSnapshot(sceneWith(node, makeDiffuseMaterial("m", glm::vec3(1))), 0, "", 1.0);
  const SnapshotInstance& instance = snapshot->instances[0];
  EXPECT_TRUE(instance.mirrored);
  const Mesh& mesh = *instance.mesh;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto world = [&](std::size_t k) {
      return glm::vec3(instance.worldFromObject * glm::vec4(mesh.positions[mesh.indices[i + k]], 1));
    };
    const glm::vec3 n = glm::normalize(instance.normalMatrix * mesh.normals[mesh.indices[i]]);
    EXPECT_NEAR(glm::dot(n, glm::normalize(world(1) - world(0))), 0.0f, 1e-5f);
    // The box is around the origin: outside is away from it.
    EXPECT_GT(glm::dot(n, world(0)), 0.0f);
  }
}

TEST(Snapshot, ProbesStandAtTheCentreOfTheWorldBounds) {
  Node node;
  node.translation = {1, 2, 3};
  node.rotation = glm::angleAxis(0.5f, glm::vec3(0, 1, 0));
  const auto snapshot = makeSnapshot(sceneWith(node, makeMirrorMaterial("m")), 0, "", 1.0);
  ASSERT_EQ(snapshot->probes.size(), 1U);
  EXPECT_LT(glm::distance(snapshot->probes[0].position, glm::vec3(1, 2, 3)), 1e-5f);
  EXPECT_THAT(snapshot->probes[0].owners, testing::ElementsAre(0));
  EXPECT_EQ(snapshot->instances[0].probe, 0);
}

TEST(Snapshot, ProbeSettingsOfTheNode_AreObeyed) {
  Node moved;
  moved.translation = {1, 0, 0};
  moved.probe.emplace().position = glm::vec3(0, 5, 0);
  EXPECT_EQ(makeSnapshot(sceneWith(moved, makeMirrorMaterial("m")), 0, "", 1.0)->probes.at(0).position,
            glm::vec3(1, 5, 0));
  Node disabled;
  disabled.probe.emplace().enabled = false;
  EXPECT_TRUE(makeSnapshot(sceneWith(disabled, makeMirrorMaterial("m")), 0, "", 1.0)->probes.empty());
  EXPECT_TRUE(makeSnapshot(sceneWith({}, makeDiffuseMaterial("m", glm::vec3(1))), 0, "", 1.0)->probes.empty());
}

TEST(Snapshot, ProxyBoxOfAProbe_IsItsNodesBoxOrElseTheRoom) {
  Node boxed;
  boxed.probe.emplace().box = Bounds{{-1, -2, -3}, {1, 2, 3}};
  const auto proxyBox = [](const Node& node, std::optional<Bounds> room) {
    Scene scene = *sceneWith(node, makeMirrorMaterial("m"));
    scene.room = room;
    return makeSnapshot(std::make_shared<const Scene>(std::move(scene)), 0, "", 1.0)->probes.at(0).proxyBox;
  };
  const Bounds room = {{-9, -9, -9}, {9, 9, 9}};
  EXPECT_EQ(proxyBox(boxed, room)->upper, glm::vec3(1, 2, 3));
  EXPECT_EQ(proxyBox({}, room)->upper, glm::vec3(9, 9, 9));
  EXPECT_FALSE(proxyBox({}, std::nullopt).has_value());
}

// Lookups read it, so that pictures of the rasteriser change; references don't.
TEST(Snapshot, ProxyBoxes_AreInTheContentHashButNotInTheReferences) {
  Scene scene = makeBuiltinScene({"mirrors", {{"count", "2"}}});
  const auto hashes = [&] {
    const auto snapshot = makeSnapshot(std::make_shared<const Scene>(scene), 0, "", 1.0);
    return std::pair(contentHash(*snapshot), referenceHash(*snapshot));
  };
  const auto without = hashes();
  scene.room = Bounds{{-9, -9, -9}, {9, 9, 9}};
  const auto with = hashes();
  EXPECT_NE(with.first, without.first);
  EXPECT_EQ(with.second, without.second);
}

TEST(Snapshot, FramesOfAnAnimation_MoveAndLoop) {
  const auto scene = std::make_shared<const Scene>(makeBuiltinScene({"teapot", {}}));
  const auto hashAt = [&](int frame) { return contentHash(*makeSnapshot(scene, frame, "", 1.5)); };
  EXPECT_NE(hashAt(0), hashAt(1));
  EXPECT_EQ(hashAt(0), hashAt(60));  // 30 frames a second, two seconds a turn
  EXPECT_EQ(hashAt(7), hashAt(7));
}

TEST(Snapshot, ContentHash_SeesWhatChangesThePicture) {
  const auto base = std::make_shared<const Scene>(makeBuiltinScene({"mirrors", {{"count", "2"}}}));
  const std::uint64_t hash = contentHash(*makeSnapshot(base, 0, "", 1.0));
  const auto changed = [&](auto&& change) {
    Scene scene = *base;
    change(scene);
    return contentHash(*makeSnapshot(std::make_shared<const Scene>(std::move(scene)), 0, "", 1.0));
  };
  EXPECT_EQ(changed([](Scene&) {}), hash);
  EXPECT_NE(changed([](Scene& s) { s.materials[1].constants.baseColor.x += 0.01f; }), hash);
  EXPECT_NE(changed([](Scene& s) { s.lights[0].intensity.x += 0.01f; }), hash);
  EXPECT_NE(changed([](Scene& s) { s.textures[0].levels[0](3, 3).x += 0.01f; }), hash);
  EXPECT_NE(changed([](Scene& s) { s.environment.sky.zenith.x += 0.01f; }), hash);
  EXPECT_NE(changed([](Scene& s) { s.environment.ambient.y.x += 0.01f; }), hash);
  EXPECT_NE(changed([](Scene& s) { s.nodes.back().translation.x += 0.01f; }), hash);
  EXPECT_NE(changed([](Scene& s) { s.cameras[0].verticalFov += 0.01f; }), hash);
  EXPECT_NE(changed([](Scene& s) { s.probeNear += 0.01f; }), hash);
}

TEST(Snapshot, UnknownCamera_NamesTheNearest) {
  const auto scene = std::make_shared<const Scene>(makeBuiltinScene({"control", {}}));
  EXPECT_THAT([&] { makeSnapshot(scene, 0, "Camra", 1.0); },
              testing::ThrowsMessage<Error>("scene 'control': camera 'Camra' is not known; nearest is 'Camera'"));
}

TEST(FramingCamera, SeesTheWholeScene) {
  const auto snapshot = makeSnapshot(sceneWith({}, makeDiffuseMaterial("m", glm::vec3(1))), 0, "", 1.0);
  const Bounds& bounds = snapshot->instances[0].worldBounds;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p((corner & 1) != 0 ? bounds.upper.x : bounds.lower.x,
                      (corner & 2) != 0 ? bounds.upper.y : bounds.lower.y,
                      (corner & 4) != 0 ? bounds.upper.z : bounds.lower.z);
    const glm::vec4 clip = shading::clipFromWorldPosition(snapshot->camera, p);
    EXPECT_GT(clip.w, clip.z);  // beyond the near plane
    EXPECT_LE(std::abs(clip.x), clip.w);
    EXPECT_LE(std::abs(clip.y), clip.w);
  }
}

TEST(View, WorldUpIsTheTopRow) {
  const auto scene = std::make_shared<const Scene>(makeBuiltinScene({"mirrors", {}}));
  const shading::View view = makeSnapshot(scene, 0, "", 1.0)->camera;
  EXPECT_GT(shading::viewDirection(view, {0, -1}).y, shading::viewDirection(view, {0, 1}).y);
  EXPECT_GT(shading::viewDirection(view, {1, 0}).x, shading::viewDirection(view, {-1, 0}).x);
}

TEST(View, ClipPositionOfAViewRay_IsItsImagePoint) {
  const auto scene = std::make_shared<const Scene>(makeBuiltinScene({"mirrors", {}}));
  const shading::View view = makeSnapshot(scene, 0, "", 16.0 / 9.0)->camera;
  for (const glm::vec2& st : {glm::vec2(0.3f, -0.8f), glm::vec2(-1.0f, 1.0f), glm::vec2(0.0f)}) {
    const glm::vec4 clip =
        shading::clipFromWorldPosition(view, glm::vec3(view.origin) + 7.0f * shading::viewDirection(view, st));
    EXPECT_NEAR(clip.x / clip.w, st.x, 1e-5f);
    EXPECT_NEAR(clip.y / clip.w, st.y, 1e-5f);
    EXPECT_NEAR(clip.z / clip.w, view.origin.w / 7.0f, 1e-6f);
  }
}

TEST(BuiltinScenes, AreAllMadeAndKnownByName) {
  for (const BuiltinScene& builtin : builtinScenes()) {
    const Scene scene = makeBuiltinScene({builtin.name, {}});
    EXPECT_FALSE(scene.instances.empty()) << builtin.name;
    EXPECT_FALSE(scene.cameras.empty()) << builtin.name;
    EXPECT_TRUE(scene.warnings.empty()) << builtin.name;
  }
  EXPECT_THROW(makeBuiltinScene({"miror", {}}), Error);
  EXPECT_THROW(makeBuiltinScene({"mirrors", {{"count", "65"}}}), Error);
}

TEST(BuiltinScenes, ControlsHaveNoSpecularSurface) {
  for (const char* name : {"control", "control-alpha", "control-shadows"})
    for (const Material& material : makeBuiltinScene({name, {}}).materials)
      EXPECT_TRUE(material.constants.kind.x == shading::kSurfaceDiffuse ||
                  material.constants.kind.x == shading::kSurfaceUnlit)
          << name << ": " << material.name;
}

TEST(BuiltinScenes, OnlyControlShadowsCastsShadows) {
  for (const BuiltinScene& builtin : builtinScenes())
    EXPECT_EQ(makeBuiltinScene({builtin.name, {}}).castsShadows, builtin.name == "control-shadows") << builtin.name;
}

// Vertices are welded by position: flat shaded ones are split.
using DirectedEdge = std::pair<std::array<float, 3>, std::array<float, 3>>;
std::map<DirectedEdge, int> countEdges(const Mesh& mesh) {
  std::map<DirectedEdge, int> edges;
  const auto corner = [&](std::size_t i) {
    const glm::vec3& p = mesh.positions[mesh.indices[i]];
    return std::array<float, 3>{p.x, p.y, p.z};
  };
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{corner(t + k), corner(t + (k + 1) % 3)}];
  return edges;
}

double signedVolume(const Mesh& mesh) {
  double volume = 0.0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const auto p = [&](std::size_t k) { return glm::dvec3(mesh.positions[mesh.indices[t + k]]); };
    volume += glm::dot(p(0), glm::cross(p(1), p(2))) / 6.0;
  }
  return volume;
}

TEST(BuiltinScenes, GlassIsClosedAndWoundOutwards) {
  int meshes = 0;
  for (const BuiltinScene& builtin : builtinScenes()) {
    const Scene scene = makeBuiltinScene({builtin.name, {}});
    for (const Instance& instance : scene.instances) {
      if (scene.materials[static_cast<std::size_t>(instance.material)].constants.kind.x != shading::kSurfaceGlass)
        continue;
      const std::map<DirectedEdge, int> edges = countEdges(*instance.mesh);
      for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1) << builtin.name << ": " << instance.name;
        ASSERT_TRUE(edges.contains({edge.second, edge.first})) << builtin.name << ": " << instance.name;
      }
      EXPECT_GT(signedVolume(*instance.mesh), 0.0) << builtin.name << ": " << instance.name;
      ++meshes;
    }
  }
  // Four balls of `glass`, four bodies of `dispersion`, three of `glass-shapes`, the windows of `street`.
  EXPECT_EQ(meshes, 12);
}

TEST(BuiltinScenes, MetalsAreRoughRows_EachSphereWithItsProbe) {
  for (const int grid : {2, 5}) {
    const auto scene = std::make_shared<const Scene>(makeBuiltinScene({"metals", {{"grid", std::to_string(grid)}}}));
    EXPECT_EQ(makeSnapshot(scene, 0, "", 1.0)->probes.size(), static_cast<std::size_t>(3 * grid));
    float before = 1.0f;
    for (const Material& material : scene->materials) {
      if (material.constants.conductorEta.w == 0.0f) continue;
      const float roughness = material.constants.factors.y;
      EXPECT_EQ(material.constants.kind.x, roughness == 0.0f ? shading::kSurfaceMirror : shading::kSurfaceGlossy);
      if (roughness > 0.0f) {
        EXPECT_GT(roughness, before);
      }
      before = roughness;
    }
    EXPECT_FLOAT_EQ(before, 0.8f);
  }
}

TEST(BuiltinScenes, MetalsHaveTheirPublishedColours) {
  // Reflectance at normal incidence, ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2), of Johnson and Christy's n and k in table I
  // at 1.88 eV (659.5 nm), 2.26 eV (548.6 nm) and 2.75 eV (450.9 nm). The scene interpolates to 650, 550 and 450 nm,
  // which moves the largest, copper's in the red, by 0.014.
  const glm::vec3 silver(0.9906f, 0.9828f, 0.9803f), gold(0.9626f, 0.7869f, 0.4082f), copper(0.9433f, 0.6195f, 0.5392f);
  const auto f0 = [](const Material& m) {
    return shading::F_Conductor(1.0f, glm::vec3(m.constants.conductorEta), glm::vec3(m.constants.conductorK));
  };
  for (const Material& material : makeBuiltinScene({"metals", {}}).materials)
    for (const auto& [name, color] :
         {std::pair("Silver", silver), std::pair("Gold", gold), std::pair("Copper", copper)}) {
      if (!material.name.starts_with(name)) continue;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(f0(material)[c], color[c], 0.015f) << material.name;
    }
}

std::size_t triangleCount(const Scene& scene) {
  std::size_t triangles = 0;
  for (const Instance& instance : scene.instances) triangles += instance.mesh->triangleCount();
  return triangles;
}

// The scenes of the peer benchmark are written by its own script, which stands beside this repository where it was
// made.
class PeerScene : public ::testing::TestWithParam<std::array<const char*, 2>> {};

TEST_P(PeerScene, HasTheVerticesAndMaterialsOfItsFile) {
  const std::filesystem::path script = PROBEBENCH_SOURCE_DIR "/../shared/peers/cpu-raytracers/scenes.py";
  if (!std::filesystem::exists(script)) GTEST_SKIP() << "no " << script;
  const TemporaryFolder folder;
  const auto [reference, name] = GetParam();
  const std::string command =
      fmt::format("python3 -B '{}' '{}' {} > '{}'", script.string(), folder.path().string(), name, folder.file("log"));
  ASSERT_EQ(std::system(command.c_str()), 0);
  const auto file = loadScene(folder.file(std::string(name) + ".glb")), builtin = loadScene(reference);
  ASSERT_EQ(file->instances.size(), builtin->instances.size());
  for (std::size_t i = 0; i < file->instances.size(); ++i) {
    const Instance &a = file->instances[i], &b = builtin->instances[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.mesh->positions, b.mesh->positions) << a.name;
    EXPECT_EQ(a.mesh->normals, b.mesh->normals) << a.name;
    EXPECT_EQ(a.mesh->indices, b.mesh->indices) << a.name;
    const Material& m = file->materials[static_cast<std::size_t>(a.material)];
    const Material& n = builtin->materials[static_cast<std::size_t>(b.material)];
    EXPECT_EQ(m.name, n.name);
    EXPECT_EQ(m.constants.baseColor, n.constants.baseColor) << m.name;
    EXPECT_EQ(m.constants.emission, n.constants.emission) << m.name;
    EXPECT_EQ(m.constants.kind, n.constants.kind) << m.name;
    EXPECT_EQ(m.constants.factors, n.constants.factors) << m.name;
  }
  const auto a = makeSnapshot(file, 0, "", 16.0 / 9.0), b = makeSnapshot(builtin, 0, "", 16.0 / 9.0);
  for (const auto member :
       {&shading::View::origin, &shading::View::forward, &shading::View::right, &shading::View::down})
    EXPECT_LT(glm::distance(a->camera.*member, b->camera.*member), 1e-6f);
  EXPECT_EQ(a->lights.size(), b->lights.size());
  EXPECT_EQ(a->areaLights.size(), b->areaLights.size());
  EXPECT_EQ(environmentRadiance(file->environment, {0, 1, 0}), environmentRadiance(builtin->environment, {0, 1, 0}));
}

INSTANTIATE_TEST_SUITE_P(Scenes, PeerScene,
                         ::testing::Values(std::array{"builtin:mirrors-ring", "mirrors8"},
                                           std::array{"builtin:glass", "glass"},
                                           std::array{"builtin:mirrors-ring?point=1", "mirrors8pt"}),
                         [](const auto& test) { return std::string(test.param[1]); });

TEST(BuiltinScenes, ExportedAndLoadedAgain_GiveTheSamePictures) {
  for (const BuiltinScene& builtin : builtinScenes()) {
    // Their textures have more than 8 bits a channel, which the file rounds to 16.
    if (builtin.name == "control" || builtin.name == "control-shadows" || builtin.name == "mirror-room" ||
        builtin.name == "teapot")
      continue;
    const TemporaryFolder folder;
    const auto scene = loadScene("builtin:" + builtin.name);
    saveGlb(*scene, folder.file("scene.glb"));
    const auto loaded = loadScene(folder.file("scene.glb"));
    for (const int frame : {0, 7})
      EXPECT_EQ(contentHash(*makeSnapshot(scene, frame, "", 1.5)), contentHash(*makeSnapshot(loaded, frame, "", 1.5)))
          << builtin.name << ", frame " << frame;
  }
}

// Where the model's origin, the centre of its box and its probe stand is what placements of probes differ in.
TEST(BuiltinScenes, TeapotHasItsOriginAtItsFoot) {
  const Scene scene = makeBuiltinScene({"teapot", {}});
  const Bounds& bounds = scene.instances.at(5).mesh->bounds;
  ASSERT_EQ(scene.instances[5].name, "Mirror teapot");
  EXPECT_NEAR(bounds.lower.y, 0.0f, 1e-6f);
  EXPECT_GT(bounds.centre().y, 0.7f);
  EXPECT_GT(std::abs(bounds.centre().x), 0.05f);  // the spout reaches farther than the handle
}

TEST(BuiltinScenes, InRooms_StateThem) {
  for (const char* name : {"mirror-cube", "planar-floor", "hall-of-mirrors"}) {
    const auto scene = std::make_shared<const Scene>(makeBuiltinScene({name, {}}));
    Bounds all;
    const auto snapshot = makeSnapshot(scene, 0, "", 1.0);
    for (const SnapshotInstance& instance : snapshot->instances) all.include(instance.worldBounds);
    ASSERT_TRUE(scene->room.has_value()) << name;
    EXPECT_EQ(scene->room->lower, all.lower) << name;
    EXPECT_EQ(scene->room->upper, all.upper) << name;
  }
}

// A camera that drives with the car sees the same street again when the animation loops.
TEST(BuiltinScenes, StreetRepeatsAfterOneLoop) {
  const Scene scene = makeBuiltinScene({"street", {}});
  const Track& track = scene.tracks.at(0);
  const float period = track.values.back().x - track.values.front().x;
  const auto houseAt = [&](float x) -> const Instance* {
    for (const Instance& instance : scene.instances) {
      const glm::vec3& position = scene.nodes[static_cast<std::size_t>(instance.node)].translation;
      if (instance.name.starts_with("House_north") && position.x == x) return &instance;
    }
    return nullptr;
  };
  int pairs = 0;
  for (float x = -45.0f; x + period <= 45.0f; x += 6.0f, ++pairs) {
    const Instance *a = houseAt(x), *b = houseAt(x + period);
    ASSERT_TRUE(a != nullptr && b != nullptr) << x;
    EXPECT_EQ(a->mesh, b->mesh);
    EXPECT_EQ(a->material, b->material);
  }
  EXPECT_EQ(pairs, 12);
}

TEST(BuiltinScenes, PeerScenesHaveTheirTriangles) {
  EXPECT_EQ(triangleCount(makeBuiltinScene({"mirrors-ring", {}})), 48512U);
  EXPECT_EQ(triangleCount(makeBuiltinScene({"glass", {}})), 48514U);
}

TEST(BuiltinScenes, MirrorsHasAsManyProbesAsMirrors) {
  for (const int count : {1, 3, 8}) {
    const auto scene = std::make_shared<const Scene>(makeBuiltinScene({"mirrors", {{"count", std::to_string(count)}}}));
    EXPECT_EQ(makeSnapshot(scene, 0, "", 1.0)->probes.size(), static_cast<std::size_t>(count));
  }
}

}  // namespace
}  // namespace pb
