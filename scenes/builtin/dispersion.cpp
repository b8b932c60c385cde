// `dispersion`: prisms and a faceted gem before a dark wall of bright vertical slits, which they pull apart into
// colours.
#include <array>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr int kSlits = 11;
constexpr float kSlitSpacing = 0.6f;
constexpr float kWallZ = -2.2f;

// Index of refraction at 587.6 nm and Abbe number. Glasses: Schott's data sheets of F2, SF6 and N-BK7; diamond: the
// table in KHR_materials_dispersion.
struct Glass {
  const char* name;
  float ior, abbeNumber;
};
constexpr Glass kFlint = {"Flint", 1.62004f, 36.37f};
constexpr Glass kDenseFlint = {"Dense flint", 1.80518f, 25.43f};
constexpr Glass kCrown = {"Green crown", 1.5168f, 64.17f};
constexpr Glass kDiamond = {"Diamond", 2.4175f, 55.0f};

Material makeDispersiveGlass(const Glass& glass, float thickness) {
  Material material = makeGlassMaterial(glass.name, glass.ior, thickness);
  material.constants.kind.w = 20.0f / glass.abbeNumber;
  return material;
}

// `height` above the plane of the outline, whose points (x, z) run counter-clockwise seen from above. Closed; without
// normals, so that it is flat shaded.
Mesh makeExtrusion(const std::vector<glm::vec2>& outline, float height) {
  const auto n = static_cast<std::uint32_t>(outline.size());
  Mesh mesh;
  for (const glm::vec2& p : outline) mesh.positions.emplace_back(p.x, 0.0f, p.y);
  for (const glm::vec2& p : outline) mesh.positions.emplace_back(p.x, height, p.y);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.indices.insert(mesh.indices.end(), {i, next, n + next, i, n + next, n + i});
  }
  for (std::uint32_t i = 1; i + 1 < n; ++i) mesh.indices.insert(mesh.indices.end(), {0, i + 1, i, n, n + i, n + i + 1});
  return mesh;
}

// Corners (x, z) on a circle, counter-clockwise seen from above, the first at `turn` corners' distance from +X.
glm::vec2 onCircle(float radius, double corner, int corners) {
  const double angle = glm::two_pi<double>() * corner / corners;
  return glm::vec2(static_cast<double>(radius) * glm::dvec2(std::cos(angle), -std::sin(angle)));
}

// An isosceles triangle, symmetric in x, apex at -Z.
Mesh makePrismMesh(float apexDegrees, float depth, float height) {
  const float halfBase = depth * glm::tan(0.5f * glm::radians(apexDegrees));
  return makeExtrusion({{-halfBase, 0.5f * depth}, {halfBase, 0.5f * depth}, {0.0f, -0.5f * depth}}, height);
}

Mesh makeHexagonMesh(float radius, float height) {
  std::vector<glm::vec2> outline;
  for (int i = 0; i < 6; ++i) outline.push_back(onCircle(radius, i, 6));
  return makeExtrusion(outline, height);
}

// A round cut with eight-fold symmetry: table, crown, girdle, two rows of the pavilion. Proportions (of the girdle's
// radius) near Tolkowsky's: table 0.53, crown angle 34.5 degrees, pavilion angle 40.75 degrees.
Mesh makeGemMesh(float radius) {
  constexpr std::uint32_t kSides = 8;
  struct Ring {
    double radius, y, turn;  // turn in corners
  };
  constexpr std::array<Ring, 4> kRings = {{{0.53, 0.36, 0.0}, {1.0, 0.03, 0.5}, {1.0, -0.03, 0.5}, {0.45, -0.5, 1.0}}};
  Mesh mesh;
  for (const Ring& ring : kRings)
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const glm::vec2 p = onCircle(radius * static_cast<float>(ring.radius), i + ring.turn, kSides);
      mesh.positions.emplace_back(p.x, radius * static_cast<float>(ring.y), p.y);
    }
  mesh.positions.emplace_back(0.0f, -0.89f * radius, 0.0f);
  const std::uint32_t apex = 4 * kSides;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t next = (i + 1) % kSides, g = kSides + i, gNext = kSides + next;
    const std::uint32_t h = 2 * kSides + i, hNext = 2 * kSides + next, p = 3 * kSides + i, pNext = 3 * kSides + next;
    mesh.indices.insert(mesh.indices.end(), {i, g, next, g, gNext, next});                // crown
    mesh.indices.insert(mesh.indices.end(), {g, h, hNext, g, hNext, gNext});              // girdle
    mesh.indices.insert(mesh.indices.end(), {h, p, hNext, p, pNext, hNext});              // upper pavilion
    mesh.indices.insert(mesh.indices.end(), {p, apex, pNext});                            // lower pavilion
    if (i > 0 && i + 1 < kSides) mesh.indices.insert(mesh.indices.end(), {0, i, i + 1});  // table
  }
  return mesh;
}

// Turned, and moved up until its lowest point is a hand's breadth of air above the ground: surfaces in one plane would
// flicker.
void addGlass(Scene& scene, const char* name, Mesh mesh, int material, glm::vec3 position, glm::quat rotation) {
  float lowest = std::numeric_limits<float>::infinity();
  for (const glm::vec3& p : mesh.positions) lowest = std::min(lowest, (rotation * p).y);
  Node node;
  node.translation = position + glm::vec3(0.0f, 0.02f - lowest, 0.0f);
  node.rotation = rotation;
  mesh.name = name;
  addInstance(scene, name, finishMesh(std::move(mesh)), material, node);
}

glm::quat turned(float yawDegrees, float pitchDegrees = 0.0f) {
  return glm::angleAxis(glm::radians(yawDegrees), glm::vec3(0, 1, 0)) *
         glm::angleAxis(glm::radians(pitchDegrees), glm::vec3(1, 0, 0));
}

void addGlasses(Scene& scene) {
  const auto glass = [&](const Glass& g, float thickness) {
    return addMaterial(scene, makeDispersiveGlass(g, thickness));
  };
  Material green = makeDispersiveGlass(kCrown, 0.6f);
  setAttenuation(green, {0.15f, 0.75f, 0.35f}, 0.6f);
  // Turned so that the camera's rays cross prism and wedge near the angle of least deviation, towards the slits.
  addGlass(scene, "Prism", makePrismMesh(60.0f, 0.9f, 1.5f), glass(kFlint, 0.5f), {-1.45f, 0.0f, 0.2f}, turned(87.0f));
  addGlass(scene, "Wedge", makePrismMesh(30.0f, 0.9f, 1.3f), glass(kDenseFlint, 0.3f), {-0.15f, 0.0f, -0.6f},
           turned(80.0f));
  addGlass(scene, "Column", makeHexagonMesh(0.42f, 1.1f), addMaterial(scene, std::move(green)), {1.85f, 0.0f, 0.2f},
           turned(12.0f));
  addGlass(scene, "Gem", makeGemMesh(0.55f), glass(kDiamond, 0.6f), {0.75f, 0.0f, 1.0f}, turned(15.0f, 48.0f));
}

void addSlits(Scene& scene) {
  Node wall;
  wall.translation = {0.0f, 1.5f, kWallZ - 0.1f};
  addInstance(scene, "Wall", finishMesh(makeBoxMesh({12.0f, 3.0f, 0.16f})),
              addMaterial(scene, makeDiffuseMaterial("Wall", glm::vec3(0.04f))), wall);
  Material light = makeDiffuseMaterial("Slit", glm::vec3(0.0f));
  light.constants.emission = {12.0f, 12.0f, 12.0f, 1.0f};
  const int material = addMaterial(scene, std::move(light));
  for (int k = 0; k < kSlits; ++k) {
    const float x = kSlitSpacing * (static_cast<float>(k) - 0.5f * static_cast<float>(kSlits - 1));
    addInstance(scene, "Slit_" + std::to_string(k),
                finishMesh(makeQuadMesh({x - 0.02f, 0.1f, kWallZ}, {0.04f, 0, 0}, {0, 2.5f, 0})), material);
  }
}

Texture makeTiles() {
  ImageRgba texels(2, 2);
  for (int i = 0; i < 4; ++i)
    texels(i % 2, i / 2) = roundedToBytes(glm::vec4(glm::vec3(i == 0 || i == 3 ? 0.55f : 0.3f), 1.0f));
  return makeTexture("tiles", std::move(texels));
}

void addGround(Scene& scene) {
  Material material = makeTexturedMaterial("Ground", addTexture(scene, makeTiles()), {10.0f, 10.0f});
  material.constants.baseColorSlot.sampler_.z = shading::kFilterNearest;
  addInstance(scene, "Ground", finishMesh(makeQuadMesh({-5, 0, 7}, {10, 0, 0}, {0, 0, -10})),
              addMaterial(scene, std::move(material)));
}

shading::Sky makeDimSky() {
  shading::Sky sky;
  sky.horizon = {0.10f, 0.11f, 0.13f, 0.0f};
  sky.zenith = {0.03f, 0.04f, 0.07f, 0.0f};
  sky.below = {0.03f, 0.03f, 0.03f, 0.0f};
  sky.glow = {0.0f, 0.0f, 0.0f, 1.0f};
  sky.toGlow = {0.0f, 1.0f, 0.0f, 0.0f};
  return sky;
}

}  // namespace

Scene makeDispersionScene(SpecReader& /*parameters*/) {
  Scene scene;
  addGround(scene);
  addSlits(scene);
  addGlasses(scene);
  addCamera(scene, "Camera", {0.15f, 1.05f, 4.6f}, {0.15f, 0.75f, 0.0f}, glm::radians(34.0f), 0.1f);
  scene.environment = makeGradientEnvironment(makeDimSky());
  return scene;
}

}  // namespace pb
