// `glass-shapes`: a cube, a ball and a bust of glass before a striped wall, each with dispersion: flat, convex and
// wrinkled surfaces, through which a ray goes straight on, meets a focus, or comes out anywhere.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/closed_body.h"
#include "scenes/builtin/room.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

// Index of refraction at 587.6 nm and Abbe number, by Schott's data sheets of N-BK7 and F2.
struct Glass {
  const char* name;
  float ior, abbeNumber;
};
constexpr Glass kCrown = {"Crown glass", 1.5168f, 64.17f};
constexpr Glass kFlint = {"Flint glass", 1.62004f, 36.37f};
// Above the ground: surfaces in one plane would flicker.
constexpr float kGap = 0.02f;

// Smooth step from 0 at a to 1 at b.
double step(double a, double b, double x) {
  const double t = std::clamp((x - a) / (b - a), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// A bump of height 1 and the given half width around 0.
double bump(double x, double width) { return std::exp(-x * x / (width * width)); }

// Height above the foot, 1.5 in all, and half widths in x (shoulders) and z (face and back).
struct BustSection {
  double y, x, z;
};

// Chest and shoulders, neck, head; round at the crown, flat below.
BustSection bustSection(double along) {
  // Rows are closer where the outline turns: at the crown and below the chest.
  const double t = 0.5 - 0.5 * std::cos(glm::pi<double>() * along);
  const double y = 1.5 * (1.0 - t);
  const double head = std::sqrt(std::max(0.0, 1.0 - std::pow((y - 1.16) / 0.34, 2.0)));
  const double neck = 0.135, shoulders = 0.36 * (1.0 - step(0.44, 0.74, y)) + neck;
  const double foot = std::pow(std::clamp(y / 0.06, 0.0, 1.0), 0.3);
  const double trunk = y < 1.0 ? shoulders : neck * (1.0 - step(1.0, 1.15, y));
  return {y, foot * std::max(trunk, 0.245 * head), foot * std::max(0.62 * trunk, 0.30 * head)};
}

// Without seam, so that it is closed to the last bit.
Mesh makeBall(double radius) {
  Mesh mesh = makeClosedBody(32, 64, [&](double along, double around) {
    const double theta = glm::pi<double>() * along, phi = glm::two_pi<double>() * around;
    return radius * glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  });
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) mesh.normals[i] = glm::normalize(mesh.positions[i]);
  return mesh;
}

// Looks along +Z.
glm::dvec3 bustPoint(double along, double around) {
  const BustSection s = bustSection(along);
  const double angle = glm::two_pi<double>() * around;
  const double front = std::sin(angle), side = std::cos(angle);
  const double face = std::max(front, 0.0);
  const double nose = 0.10 * bump(s.y - 1.12, 0.07) * std::pow(face, 40.0);
  const double brow = 0.025 * bump(s.y - 1.25, 0.035) * std::pow(face, 6.0);
  const double sockets = -0.03 * bump(s.y - 1.19, 0.03) * bump(std::abs(side) - 0.40, 0.16) * face;
  const double chin = 0.04 * bump(s.y - 0.90, 0.05) * std::pow(face, 8.0);
  const double ears = 0.05 * bump(s.y - 1.15, 0.06) * std::pow(std::abs(side), 24.0);
  return {side * (s.x + ears), s.y, front * s.z + nose + brow + sockets + chin};
}

int addGlass(Scene& scene, const Glass& glass, float thickness) {
  Material material = makeGlassMaterial(glass.name, glass.ior, thickness);
  material.constants.kind.w = 20.0f / glass.abbeNumber;
  return addMaterial(scene, std::move(material));
}

void addShape(Scene& scene, const char* name, Mesh mesh, int material, glm::vec3 position, float yawDegrees) {
  Node node;
  node.translation = position;
  node.rotation = glm::angleAxis(glm::radians(yawDegrees), glm::vec3(0, 1, 0));
  mesh.name = name;
  addInstance(scene, name, finishMesh(std::move(mesh)), material, node);
}

void addStripedWall(Scene& scene) {
  const int light = addMaterial(scene, makeDiffuseMaterial("Light stripe", glm::vec3(0.85f)));
  const int dark = addMaterial(scene, makeDiffuseMaterial("Dark stripe", glm::vec3(0.06f)));
  for (int k = 0; k < 20; ++k) {
    const float x = 0.4f * static_cast<float>(k - 10);
    addInstance(scene, "Stripe_" + std::to_string(k),
                finishMesh(makeQuadMesh({x, 0.0f, -2.5f}, {0.4f, 0, 0}, {0, 2.6f, 0})), k % 2 == 0 ? light : dark);
  }
}

void addSurroundings(Scene& scene) {
  addInstance(scene, "Ground", finishMesh(makeQuadMesh({-6, 0, 6}, {12, 0, 0}, {0, 0, -12})),
              addMaterial(scene, makeCheckeredMaterial(scene, "Ground", {0.62f, 0.56f, 0.48f}, glm::vec2(12.0f))));
  addStripedWall(scene);
  const auto block = [&](const char* name, glm::vec3 foot, glm::vec3 edges, glm::vec3 albedo) {
    Node node;
    node.translation = foot + glm::vec3(0.0f, 0.5f * edges.y, 0.0f);
    addInstance(scene, name, finishMesh(makeBoxMesh(edges)), addMaterial(scene, makeDiffuseMaterial(name, albedo)),
                node);
  };
  block("Red block", {-2.9f, 0, -0.6f}, {0.5f, 1.3f, 0.5f}, {0.80f, 0.12f, 0.10f});
  block("Blue block", {2.9f, 0, -0.4f}, {0.5f, 1.6f, 0.5f}, {0.10f, 0.22f, 0.75f});
  block("Green block", {0.55f, 0, -1.6f}, {0.4f, 0.9f, 0.4f}, {0.12f, 0.60f, 0.18f});
}

}  // namespace

Scene makeGlassShapesScene(SpecReader& /*parameters*/) {
  Scene scene;
  addSurroundings(scene);
  addShape(scene, "Cube", makeBoxMesh(glm::vec3(0.95f)), addGlass(scene, kCrown, 0.95f), {-1.55f, kGap + 0.475f, 0.1f},
           28.0f);
  addShape(scene, "Bust", makeClosedBody(72, 80, bustPoint), addGlass(scene, kFlint, 0.5f), {0.0f, kGap, 0.0f}, 22.0f);
  addShape(scene, "Ball", makeBall(0.6), addGlass(scene, kFlint, 1.2f), {1.5f, kGap + 0.6f, 0.2f}, 0.0f);
  addCamera(scene, "Camera", {0.0f, 1.15f, 4.6f}, {0.0f, 0.72f, 0.0f}, glm::radians(32.0f), 0.1f);
  addDirectionalLight(scene, "Sun", {0.4f, 0.8f, 0.6f}, glm::vec3(2.2f, 2.1f, 1.9f));
  scene.environment = makeProceduralSky();
  return scene;
}

}  // namespace pb
