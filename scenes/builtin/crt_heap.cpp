// `crt-heap?count=N`: a heap of cathode-ray monitors, some on their side or back, that show moving pictures and light
// the room with them. Their cases have mirrors on both sides and on top, and their tubes are of smooth glass.
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/camera_path.h"
#include "scenes/environment.h"
#include "scenes/screen.h"
#include "scenes/spec.h"

namespace pb {
namespace {

// The case in the monitor's own space: the screen looks along +Z.
constexpr glm::vec3 kCase(0.92f, 0.76f, 0.5f);
constexpr glm::vec2 kGlass(0.76f, 0.57f);
constexpr float kBezelDepth = 0.05f;
constexpr float kBackDepth = 0.3f;
constexpr float kPeriodSeconds = 4.0f;

void append(Mesh& mesh, const Mesh& part) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
  mesh.uvs[0].insert(mesh.uvs[0].end(), part.uvs[0].begin(), part.uvs[0].end());
  for (const std::uint32_t i : part.indices) mesh.indices.push_back(first + i);
}

// Flat quad with corners in counter-clockwise order.
void appendQuad(Mesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::vec3 normal = glm::normalize(glm::cross(c - a, d - b));
  mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
  mesh.normals.insert(mesh.normals.end(), 4, normal);
  mesh.uvs[0].insert(mesh.uvs[0].end(), {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
}

// Corners of a rectangle around the axis, counter-clockwise seen from +Z.
std::array<glm::vec3, 4> rectangle(glm::vec2 edges, float z) {
  const glm::vec2 h = 0.5f * edges;
  return {{{-h.x, -h.y, z}, {h.x, -h.y, z}, {h.x, h.y, z}, {-h.x, h.y, z}}};
}

// The band of quads from one rectangle to the other, seen from outside if `to` is in front of `from`.
void appendBand(Mesh& mesh, const std::array<glm::vec3, 4>& from, const std::array<glm::vec3, 4>& to) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    appendQuad(mesh, from[i], from[next], to[next], to[i]);
  }
}

// Case, bezel and the funnel at the back; no sides and top where the mirrors are, but a bottom.
Mesh makeCaseMesh() {
  const float front = 0.5f * kCase.z, back = -front;
  const glm::vec2 edges(kCase);
  const auto frontEdge = rectangle(edges, front), rim = rectangle(edges, front + kBezelDepth);
  const auto innerRim = rectangle(kGlass, front + kBezelDepth), glassEdge = rectangle(kGlass, front);
  const auto backEdge = rectangle(edges, back), funnel = rectangle(0.8f * edges, back);
  const auto funnelEnd = rectangle(0.45f * edges, back - kBackDepth);
  Mesh mesh;
  mesh.name = "case";
  appendBand(mesh, frontEdge, rim);
  appendBand(mesh, rim, innerRim);
  appendBand(mesh, innerRim, glassEdge);
  appendQuad(mesh, backEdge[0], backEdge[1], frontEdge[1], frontEdge[0]);  // bottom
  appendBand(mesh, funnel, backEdge);
  appendBand(mesh, funnelEnd, funnel);
  appendQuad(mesh, funnelEnd[1], funnelEnd[0], funnelEnd[3], funnelEnd[2]);
  return mesh;
}

Mesh makeMirrorsMesh() {
  const glm::vec3 h = 0.5f * kCase;
  Mesh mesh;
  mesh.name = "mirrors";
  append(mesh, makeQuadMesh({h.x, -h.y, h.z}, {0, 0, -kCase.z}, {0, kCase.y, 0}));
  append(mesh, makeQuadMesh({-h.x, -h.y, -h.z}, {0, 0, kCase.z}, {0, kCase.y, 0}));
  append(mesh, makeQuadMesh({-h.x, h.y, h.z}, {kCase.x, 0, 0}, {0, 0, -kCase.z}));
  return mesh;
}

// Pictures have their first row at the top.
Mesh makeTubeMesh() {
  Mesh mesh = makeQuadMesh({-0.5f * kGlass.x, -0.5f * kGlass.y, 0.5f * kCase.z}, {kGlass.x, 0, 0}, {0, kGlass.y, 0});
  mesh.name = "tube";
  for (glm::vec2& uv : mesh.uvs[0]) uv.y = 1.0f - uv.y;
  mesh.tangents.clear();
  return mesh;
}

// Dark phosphor behind smooth glass.
Material makeTubeMaterial(const std::string& name, int screen) {
  Material material = makeDiffuseMaterial(name, glm::vec3(0.03f));
  material.constants.kind.x = shading::kSurfaceGlossy;
  material.constants.factors.y = 0.0f;
  material.constants.specular.w = 1.0f;
  showScreen(material, screen, glm::vec3(1.6f));
  return material;
}

struct Placement {
  glm::vec3 position;  // of the case's centre
  float yawDegrees, pitchDegrees, rollDegrees;
};
const std::array<Placement, 12> kPlacements = {{
    {{-0.55f, 0.38f, 0.0f}, 25.0f, 0.0f, 0.0f},
    {{0.62f, 0.38f, 0.05f}, -18.0f, 0.0f, 0.0f},
    {{0.0f, 1.14f, -0.05f}, 12.0f, 0.0f, 0.0f},
    {{-1.75f, 0.38f, 0.2f}, -20.0f, 0.0f, 0.0f},
    {{1.85f, 0.38f, 0.25f}, 35.0f, 0.0f, 0.0f},
    {{-1.1f, 1.14f, 0.0f}, -35.0f, 0.0f, 0.0f},
    {{1.15f, 1.14f, 0.05f}, 40.0f, 0.0f, 0.0f},
    {{-0.45f, 1.94f, -0.1f}, -28.0f, 0.0f, 5.0f},
    {{-1.5f, 0.47f, 1.35f}, 40.0f, 0.0f, 90.0f},
    {{1.35f, 0.66f, 1.45f}, -25.0f, -68.0f, 0.0f},
    {{0.6f, 1.94f, 0.0f}, 30.0f, 0.0f, -4.0f},
    {{0.1f, 0.55f, 1.5f}, 10.0f, -40.0f, 20.0f},
}};

Node placed(const Placement& p) {
  Node node;
  node.translation = p.position;
  node.rotation = glm::angleAxis(glm::radians(p.yawDegrees), glm::vec3(0, 1, 0)) *
                  glm::angleAxis(glm::radians(p.pitchDegrees), glm::vec3(1, 0, 0)) *
                  glm::angleAxis(glm::radians(p.rollDegrees), glm::vec3(0, 0, 1));
  node.probe = ProbeSettings{};
  return node;
}

// Monitors share the pictures: one of each program.
std::array<int, 4> addTubes(Scene& scene) {
  static constexpr std::array kNames = {"melt", "twist", "ripples", "rings"};
  std::array<int, 4> materials;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    scene.screens.push_back({.name = kNames[i],
                             .program = static_cast<float>(i),
                             .widthPx = 96,
                             .heightPx = 72,
                             .periodSeconds = kPeriodSeconds,
                             .phase = 0.0f});
    materials[i] = addMaterial(scene, makeTubeMaterial(std::string("Tube ") + kNames[i], static_cast<int>(i)));
  }
  return materials;
}

void addMonitors(Scene& scene, int count) {
  const auto body = finishMesh(makeCaseMesh());
  const auto mirrors = finishMesh(makeMirrorsMesh());
  const auto tube = finishMesh(makeTubeMesh());
  const int plastic = addMaterial(scene, makeDiffuseMaterial("Plastic", {0.62f, 0.58f, 0.48f}));
  const int mirror = addMaterial(scene, makeMirrorMaterial("Mirror", {0.92f, 0.93f, 0.94f}));
  const std::array<int, 4> tubes = addTubes(scene);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const std::string name = "Monitor_" + std::to_string(i);
    const int node = addInstance(scene, name, body, plastic, placed(kPlacements[i]));
    scene.instances.push_back({name, node, mirrors, mirror});
    scene.instances.push_back({name, node, tube, tubes[i % tubes.size()]});
  }
}

Texture makeFloorBoards() {
  ImageRgba texels(8, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 8; ++x) {
      const float tone = 0.8f + 0.2f * static_cast<float>((x * 5) % 8) / 8.0f;
      texels(x, y) = roundedToBytes(glm::vec4(tone * glm::vec3(0.42f, 0.28f, 0.17f), 1.0f));
    }
  return makeTexture("boards", std::move(texels));
}

void addRoom(Scene& scene) {
  const int boards = addTexture(scene, makeFloorBoards());
  addInstance(scene, "Floor", finishMesh(makeQuadMesh({-6, 0, 6}, {12, 0, 0}, {0, 0, -9})),
              addMaterial(scene, makeTexturedMaterial("Floor", boards, {4.0f, 4.0f})));
  const auto wall = [&](const char* name, glm::vec3 corner, glm::vec3 along, glm::vec3 albedo) {
    addInstance(scene, name, finishMesh(makeQuadMesh(corner, along, {0, 4, 0})),
                addMaterial(scene, makeDiffuseMaterial(name, albedo)));
  };
  // The side walls are what most mirrors show.
  wall("Back wall", {-4, 0, -1.6f}, {8, 0, 0}, {0.50f, 0.52f, 0.55f});
  wall("Left wall", {-4, 0, 3}, {0, 0, -4.6f}, {0.60f, 0.22f, 0.14f});
  wall("Right wall", {4, 0, -1.6f}, {0, 0, 4.6f}, {0.16f, 0.42f, 0.30f});
}

constexpr float kVerticalFov = 36.0f;  // degrees

// Where one looks at a monitor from: straight at its screen, which fills most of the image's height.
CameraPose before(const Placement& monitor) {
  const glm::quat turned = placed(monitor).rotation;
  constexpr float kDistance = 1.9f;
  const glm::vec3 eye = monitor.position + turned * glm::vec3(0.0f, 0.0f, kDistance);
  // The camera is rolled as the monitor is.
  return {eye, turned};
}

// A quarter of an orbit before the heap, then from screen to screen: a look of one second at each, with 1.75 s on the
// way.
CameraPose tourAt(double seconds) {
  constexpr double kOrbitSeconds = 4.0, kMoveSeconds = 1.75, kStopSeconds = 1.0;
  const Orbit orbit{.target = {0.0f, 0.9f, 0.0f},
                    .radius = 5.2f,
                    .height = 1.1f,
                    .periodSeconds = 4.0 * kOrbitSeconds,
                    .startDegrees = -45.0,
                    .verticalFov = glm::radians(kVerticalFov)};
  if (seconds <= kOrbitSeconds) return poseAt(orbit, seconds);
  const std::array stops = {poseAt(orbit, kOrbitSeconds), before(kPlacements[0]), before(kPlacements[2]),
                            poseAt(orbit, 0.0)};
  double start = kOrbitSeconds;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i, start += kMoveSeconds + kStopSeconds)
    if (seconds <= start + kMoveSeconds + kStopSeconds || i + 2 == stops.size())
      return easedBetween(stops[i], stops[i + 1], static_cast<float>((seconds - start) / kMoveSeconds));
  return stops.back();
}

// Three loops of the pictures.
constexpr double kTourSeconds = 3.0 * static_cast<double>(kPeriodSeconds);

}  // namespace

Scene makeCrtHeapScene(SpecReader& parameters) {
  const int count = parameters.integer("count", 1, static_cast<int>(kPlacements.size()), 10);
  Scene scene;
  addRoom(scene);
  addMonitors(scene, count);
  addCamera(scene, "Camera", {-0.9f, 2.0f, 5.2f}, {0.0f, 0.9f, 0.0f}, glm::radians(kVerticalFov), 0.1f);
  addCameraPath(scene, "Tour", kTourSeconds, glm::radians(kVerticalFov), 0.05f, tourAt);
  addDirectionalLight(scene, "Moon", {-0.4f, 0.9f, 0.7f}, glm::vec3(0.5f, 0.6f, 0.8f));
  scene.environment = makeConstantEnvironment(glm::vec3(0.12f, 0.14f, 0.2f));
  return scene;
}

}  // namespace pb
