// `street`: a car-like body of mirror-like paint and thin glass drives past facades at 8 m/s, and a camera with it. The
// street repeats every 24 m, so that nothing jumps when the animation loops.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/closed_body.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr float kPeriodMetres = 24.0f;
constexpr float kPeriodSeconds = 3.0f;
constexpr int kPeriods = 4;
constexpr float kHalfLength = 0.5f * kPeriodMetres * kPeriods;
constexpr float kRoadHalfWidth = 3.0f;
constexpr float kFacade = 4.6f;  // distance from the middle of the road

// A rounded box along +X around (x, y, 0): cross sections and outline from above are superellipses of exponent 4.
struct Shell {
  double x, y;
  double halfLength, halfHeight, halfWidth;
  double taper = 0.0;  // how much narrower it is at its top
};
Mesh makeShell(const Shell& shell, int rings, int columns) {
  return makeClosedBody(rings, columns, [&](double along, double around) {
    const double t = -std::cos(glm::pi<double>() * along);
    const double outline = std::pow(std::max(0.0, 1.0 - std::pow(t, 4.0)), 0.25);
    const double angle = glm::two_pi<double>() * around;
    const double up = signedPower(std::sin(angle), 0.5), aside = signedPower(std::cos(angle), 0.5);
    const double narrowing = 1.0 - shell.taper * 0.5 * (1.0 + up * outline);
    return glm::dvec3(shell.x + shell.halfLength * t * narrowing, shell.y + shell.halfHeight * up * outline,
                      shell.halfWidth * aside * outline * narrowing);
  });
}

// Axis along Z; a superellipse of exponent 20/3, turned.
Mesh makeWheel(double x, double z) {
  constexpr double kRadius = 0.32, kHalfWidth = 0.12;
  return makeClosedBody(20, 36, [&](double along, double around) {
    const double slope = glm::pi<double>() * along, angle = glm::two_pi<double>() * around;
    const double radius = kRadius * std::pow(std::max(std::sin(slope), 0.0), 0.3);
    return glm::dvec3(x + radius * std::cos(angle), 0.34 + radius * std::sin(angle),
                      z - kHalfWidth * signedPower(std::cos(slope), 0.3));
  });
}

// Reflects and lets through; tinted, as the windows of cars are.
Material makeWindowMaterial() {
  Material material = makeGlassMaterial("Window", 1.5f, 0.0f);
  material.constants.baseColor = {0.35f, 0.42f, 0.40f, 1.0f};
  return material;
}

// All of it reflects, so that all of it is one owner of one probe.
int addCar(Scene& scene) {
  const int paint = addMaterial(scene, makeMirrorMaterial("Paint", {0.62f, 0.14f, 0.12f}));
  const int chrome = addMaterial(scene, makeMirrorMaterial("Chrome", glm::vec3(0.4f)));
  const int window = addMaterial(scene, makeWindowMaterial());
  const auto named = [](Mesh mesh, const char* name) {
    mesh.name = name;
    return finishMesh(std::move(mesh));
  };
  const int car = addInstance(scene, "Car", named(makeShell({0.0, 0.58, 2.1, 0.32, 0.88}, 40, 48), "hull"), paint);
  const auto part = [&](Mesh mesh, const char* name, int material) {
    scene.instances.push_back({name, car, named(std::move(mesh), name), material});
  };
  part(makeShell({-0.25, 0.98, 1.25, 0.40, 0.76, 0.22}, 28, 40), "windows", window);
  part(makeShell({-0.25, 1.36, 0.86, 0.04, 0.53}, 20, 40), "roof", paint);
  for (const double x : {-1.35, 1.35})
    for (const double z : {-0.78, 0.78}) part(makeWheel(x, z), "wheel", chrome);
  Track track;
  track.node = car;
  track.timesSeconds = {0.0f, kPeriodSeconds};
  track.values = {{-0.5f * kPeriodMetres, 0, 0, 0}, {0.5f * kPeriodMetres, 0, 0, 0}};
  scene.tracks.push_back(track);
  return car;
}

// A grid of lit and dark windows in a wall of one colour.
Texture makeFacade(std::string name, glm::vec3 wall) {
  constexpr int kWidth = 96, kHeight = 128;
  const glm::vec4 plaster = roundedToBytes(glm::vec4(wall, 1.0f));
  const glm::vec4 dark = roundedToBytes({0.04f, 0.05f, 0.07f, 1.0f}), frame = roundedToBytes({0.7f, 0.7f, 0.68f, 1.0f});
  ImageRgba texels(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const int cx = x % 24, cy = y % 32;
      const bool pane = cx >= 7 && cx < 17 && cy >= 8 && cy < 24;
      const bool border = cx >= 5 && cx < 19 && cy >= 6 && cy < 26;
      texels(x, y) = pane ? dark : border ? frame : plaster;
    }
  return makeTexture(std::move(name), std::move(texels));
}

int addTextured(Scene& scene, std::string name, Texture texture, glm::vec2 repeats) {
  const int index = addTexture(scene, std::move(texture));
  return addMaterial(scene, makeTexturedMaterial(std::move(name), index, repeats));
}

// Four houses a period on either side, of different colours and heights.
void addHouses(Scene& scene) {
  struct House {
    const char* name;
    glm::vec3 albedo;
    float height;
  };
  const std::array<House, 4> houses = {{{"Brick", {0.50f, 0.20f, 0.14f}, 9.0f},
                                        {"Cream", {0.72f, 0.64f, 0.48f}, 7.5f},
                                        {"Green", {0.30f, 0.44f, 0.32f}, 10.5f},
                                        {"Blue", {0.32f, 0.42f, 0.60f}, 8.0f}}};
  std::array<int, 4> materials;
  std::array<std::shared_ptr<const Mesh>, 4> meshes;
  for (std::size_t i = 0; i < houses.size(); ++i) {
    materials[i] = addTextured(scene, houses[i].name, makeFacade(houses[i].name, houses[i].albedo), glm::vec2(1.0f));
    meshes[i] = finishMesh(makeBoxMesh({5.6f, houses[i].height, 4.0f}));
  }
  for (std::size_t k = 0; k < 4 * kPeriods; ++k)
    for (const float side : {-1.0f, 1.0f}) {
      const std::size_t i = side < 0.0f ? k % 4 : (k + 2) % 4;
      Node node;
      node.translation = {-kHalfLength + 6.0f * (static_cast<float>(k) + 0.5f), 0.5f * houses[i].height,
                          side * (kFacade + 2.0f)};
      addInstance(scene, fmt::format("House_{}_{}", side < 0.0f ? "north" : "south", k), meshes[i], materials[i], node);
    }
}

// Lanterns on the northern kerb and trees on the southern one, each 6 m.
void addKerbs(Scene& scene) {
  const auto post = finishMesh(makeBoxMesh({0.12f, 3.4f, 0.12f}));
  const auto crown = finishMesh(makeSphereMesh(0.75f, 16, 10));
  const int iron = addMaterial(scene, makeDiffuseMaterial("Iron", glm::vec3(0.10f)));
  const int leaves = addMaterial(scene, makeDiffuseMaterial("Leaves", {0.16f, 0.40f, 0.10f}));
  const auto add = [&](const char* kind, int k, std::shared_ptr<const Mesh> mesh, int material, glm::vec3 position) {
    Node node;
    node.translation = position;
    addInstance(scene, fmt::format("{}_{}", kind, k), std::move(mesh), material, node);
  };
  for (int k = 0; k < 4 * kPeriods; ++k) {
    const float x = -kHalfLength + 6.0f * (static_cast<float>(k) + 0.25f);
    add("Lantern", k, post, iron, {x, 1.7f, -kRoadHalfWidth - 0.4f});
    add("Tree", k, crown, leaves, {x + 3.0f, 2.6f, kRoadHalfWidth + 0.6f});
  }
}

Texture makeAsphalt() {
  // One period of 4 m along u, the width of the road along v: kerb lines and a broken line in the middle.
  ImageRgba texels(64, 64);
  const glm::vec4 grey = roundedToBytes(glm::vec4(glm::vec3(0.10f), 1.0f));
  const glm::vec4 paint = roundedToBytes(glm::vec4(glm::vec3(0.80f), 1.0f));
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool kerbLine = y == 2 || y == 61;
      const bool middle = (y == 31 || y == 32) && x < 32;
      texels(x, y) = kerbLine || middle ? paint : grey;
    }
  return makeTexture("asphalt", std::move(texels));
}

void addGround(Scene& scene) {
  const auto strip = [](float z0, float z1, float y) {
    return finishMesh(makeQuadMesh({-kHalfLength, y, z1}, {2 * kHalfLength, 0, 0}, {0, 0, z0 - z1}));
  };
  addInstance(scene, "Road", strip(-kRoadHalfWidth, kRoadHalfWidth, 0.0f),
              addTextured(scene, "Asphalt", makeAsphalt(), {2 * kHalfLength / 4.0f, 1.0f}));
  const int paving = addMaterial(scene, makeDiffuseMaterial("Paving", {0.45f, 0.43f, 0.40f}));
  addInstance(scene, "Pavement north", strip(-kFacade - 4.0f, -kRoadHalfWidth, 0.0f), paving);
  addInstance(scene, "Pavement south", strip(kRoadHalfWidth, kFacade + 4.0f, 0.0f), paving);
}

}  // namespace

Scene makeStreetScene(SpecReader& /*parameters*/) {
  Scene scene;
  const int car = addCar(scene);
  addGround(scene);
  addHouses(scene);
  addKerbs(scene);
  addCamera(scene, "Beside", {2.3f, 1.45f, 3.9f}, {0.0f, 0.72f, 0.0f}, glm::radians(46.0f), 0.1f);
  scene.nodes.back().parent = car;
  addCamera(scene, "Kerb", {4.0f, 1.6f, 3.2f}, {-1.0f, 0.8f, 0.0f}, glm::radians(46.0f), 0.1f);
  addDirectionalLight(scene, "Sun", {0.3f, 0.9f, 0.55f}, glm::vec3(2.4f, 2.3f, 2.1f));
  scene.environment = makeProceduralSky();
  scene.framesPerSecond = 30.0;
  return scene;
}

}  // namespace pb
