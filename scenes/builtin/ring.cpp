// `mirrors-ring` and `glass`: scenes A and B of the peer benchmark of CPU ray tracers (its mirrors8.glb and glass.glb),
// vertex for vertex, so that other renderers' pictures and times compare. Eight spheres on a ring among matte cubes and
// balls on 1 m tiles under a constant sky: all mirrors, or half of them glass under a lamp.
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

const std::array<glm::vec3, 8> kHues = {{{0.70f, 0.12f, 0.10f},
                                         {0.72f, 0.42f, 0.10f},
                                         {0.65f, 0.63f, 0.12f},
                                         {0.18f, 0.58f, 0.14f},
                                         {0.12f, 0.55f, 0.55f},
                                         {0.12f, 0.22f, 0.70f},
                                         {0.42f, 0.15f, 0.62f},
                                         {0.70f, 0.20f, 0.45f}}};
const glm::vec3 kSkyRadiance(0.45f, 0.50f, 0.60f);
constexpr float kLampRadiance = 8.0f;

// Positions are computed in double and rounded once, as in the peer benchmark's file.
void addVertex(Mesh& mesh, const glm::dvec3& position, const glm::dvec3& normal) {
  mesh.positions.emplace_back(position);
  mesh.normals.emplace_back(normal);
}

// Poles are single vertices and there is no seam: every edge belongs to two triangles.
Mesh makeWeldedSphere(const glm::dvec3& centre, double radius) {
  constexpr std::uint32_t kSegments = 64, kRings = 32;
  Mesh mesh;
  const auto add = [&](const glm::dvec3& n) { addVertex(mesh, centre + radius * n, n); };
  add({0, 1, 0});
  for (std::uint32_t j = 1; j < kRings; ++j) {
    const double theta = glm::pi<double>() * j / kRings;
    for (std::uint32_t i = 0; i < kSegments; ++i) {
      const double phi = 2 * glm::pi<double>() * i / kSegments;
      add({std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)});
    }
  }
  add({0, -1, 0});
  const std::uint32_t last = 1 + (kRings - 1) * kSegments;
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    const std::uint32_t next = (i + 1) % kSegments;
    mesh.indices.insert(mesh.indices.end(), {0, 1 + next, 1 + i});
    for (std::uint32_t j = 0; j + 2 < kRings; ++j) {
      const std::uint32_t a = 1 + j * kSegments + i, b = 1 + j * kSegments + next;
      mesh.indices.insert(mesh.indices.end(), {a, b, b + kSegments, a, b + kSegments, a + kSegments});
    }
    const std::uint32_t ring = 1 + (kRings - 2) * kSegments;
    mesh.indices.insert(mesh.indices.end(), {last, ring + i, ring + next});
  }
  return mesh;
}

void appendTile(Mesh& mesh, const std::array<glm::dvec3, 4>& corners, const glm::dvec3& normal) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const glm::dvec3& corner : corners) addVertex(mesh, corner, normal);
  mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
}

// A cube of the given half edge, turned around +Y.
Mesh makeTurnedCube(const glm::dvec3& centre, double halfEdge, double yaw) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  const auto turned = [&](const glm::dvec3& v) { return glm::dvec3(c * v.x + s * v.z, v.y, -s * v.x + c * v.z); };
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      glm::dvec3 n(0.0), u(0.0), v(0.0);
      n[axis] = side;
      (side > 0 ? u : v)[(axis + 1) % 3] = 1.0;
      (side > 0 ? v : u)[(axis + 2) % 3] = 1.0;
      const auto corner = [&](double p, double q) { return centre + turned(halfEdge * (n + p * u + q * v)); };
      appendTile(mesh, {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}, turned(n));
    }
  return mesh;
}

// The tiles of one colour: column + row is even for parity 0.
Mesh makeTiles(int parity) {
  Mesh mesh;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      if ((i + j) % 2 != parity) continue;
      const double x = i - 10.0, z = j - 10.0;
      appendTile(mesh, {{{x, 0, z}, {x, 0, z + 1}, {x + 1, 0, z + 1}, {x + 1, 0, z}}}, {0, 1, 0});
    }
  return mesh;
}

Mesh makeLamp() {
  Mesh mesh;
  appendTile(mesh, {{{0.5, 5, 0}, {2.5, 5, 0}, {2.5, 5, 2}, {0.5, 5, 2}}}, {0, -1, 0});
  return mesh;
}

// A metal whose reflectance is Schlick's with this F0.
Material makeTintedMetal(std::string name, glm::vec3 f0, float roughness) {
  Material material = makeMirrorMaterial(std::move(name), f0);
  material.constants.factors.y = roughness;
  material.constants.kind.x = shading::kSurfaceGlossy;
  material.isSpecularDominant = false;
  return material;
}

int add(Scene& scene, const std::string& name, Mesh mesh, int material) {
  mesh.name = name;
  return addInstance(scene, name, finishMesh(std::move(mesh)), material);
}

glm::dvec3 onRing(double radius, double height, double angle) {
  return {radius * std::sin(angle), height, radius * std::cos(angle)};
}

void addMatteObjects(Scene& scene) {
  add(scene, "tiles0", makeTiles(0), addMaterial(scene, makeDiffuseMaterial("ground_light", glm::vec3(0.75f))));
  add(scene, "tiles1", makeTiles(1),
      addMaterial(scene, makeDiffuseMaterial("ground_dark", glm::vec3(0.15f, 0.15f, 0.18f))));
  std::array<int, 8> hues;
  for (std::size_t k = 0; k < 8; ++k)
    hues[k] = addMaterial(scene, makeDiffuseMaterial("hue" + std::to_string(k), kHues[k]));
  for (std::size_t k = 0; k < 8; ++k) {
    const double angle = static_cast<double>(k) * glm::pi<double>() / 4;
    add(scene, "cube" + std::to_string(k), makeTurnedCube(onRing(5.2, 0.45, angle), 0.45, angle), hues[k]);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const double angle = static_cast<double>(k) * glm::pi<double>() / 2 + 0.3;
    add(scene, "ball" + std::to_string(k), makeWeldedSphere(onRing(1.3, 0.45, angle), 0.45), hues[2 * k + 1]);
  }
}

void addRing(Scene& scene, const std::array<int, 8>& materials) {
  for (std::size_t k = 0; k < 8; ++k) {
    const double angle = (static_cast<double>(k) + 0.5) * glm::pi<double>() / 4;
    const int node =
        add(scene, "ring" + std::to_string(k), makeWeldedSphere(onRing(3.2, 0.7, angle), 0.7), materials[k]);
    // The rough metals, too, are worth a probe of their own.
    scene.nodes[static_cast<std::size_t>(node)].probe = ProbeSettings{};
  }
}

void addCameraAndSky(Scene& scene) {
  const glm::dvec3 eye(0.0, 4.0, 8.5);
  const glm::dvec3 forward = glm::normalize(glm::dvec3(0.0, 0.2, 0.3) - eye);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
  const glm::dvec3 up = glm::cross(right, forward);
  Node node;
  node.name = "camera";
  node.matrix =
      glm::dmat4(glm::dvec4(right, 0.0), glm::dvec4(up, 0.0), glm::dvec4(-forward, 0.0), glm::dvec4(eye, 1.0));
  scene.cameras.push_back({"camera", static_cast<int>(scene.nodes.size()), glm::radians(40.0f), 0.01f});
  scene.nodes.push_back(std::move(node));
  scene.environment = makeConstantEnvironment(kSkyRadiance);
}

void addPointLight(Scene& scene) {
  Node node;
  node.name = "point";
  node.translation = {3.0f, 6.0f, 4.0f};
  PunctualLight light;
  light.node = static_cast<int>(scene.nodes.size());
  light.kind = shading::kLightPoint;
  light.intensity = glm::vec3(100.0f);
  scene.nodes.push_back(std::move(node));
  scene.lights.push_back(light);
}

}  // namespace

Scene makeMirrorsRingScene(SpecReader& parameters) {
  const bool point = parameters.integer("point", 0, 1, 0) == 1;
  Scene scene;
  addMatteObjects(scene);
  std::array<int, 8> ring;
  ring.fill(addMaterial(scene, makeMirrorMaterial("mirror")));
  addRing(scene, ring);
  addCameraAndSky(scene);
  if (point) addPointLight(scene);
  return scene;
}

Scene makeGlassScene(SpecReader& /*parameters*/) {
  Scene scene;
  addMatteObjects(scene);
  const int mirror = addMaterial(scene, makeMirrorMaterial("mirror"));
  const int glass = addMaterial(scene, makeGlassMaterial("glass", 1.5f, 1.4f));
  const int gold = addMaterial(scene, makeTintedMetal("gold", {1.0f, 0.77f, 0.34f}, 0.3f));
  const int copper = addMaterial(scene, makeTintedMetal("copper", {0.95f, 0.64f, 0.54f}, 0.3f));
  addRing(scene, {glass, gold, glass, mirror, glass, copper, glass, mirror});
  Material lamp = makeDiffuseMaterial("light", glm::vec3(0.0f));
  lamp.constants.emission = glm::vec4(glm::vec3(kLampRadiance), 1.0f);
  add(scene, "arealight", makeLamp(), addMaterial(scene, std::move(lamp)));
  addCameraAndSky(scene);
  return scene;
}

}  // namespace pb
