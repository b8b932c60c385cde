// `metals?grid=N`: spheres of silver, gold and copper, one row each on its own step, from perfectly smooth on the left
// to very rough on the right. Each has a probe, so that the error of every roughness stands by itself.
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

// Complex index of refraction at 650, 550 and 450 nm: Johnson and Christy, "Optical Constants of the Noble Metals",
// Phys. Rev. B 6, 4370 (1972), table I, interpolated linearly in wavelength.
struct Metal {
  const char* name;
  glm::vec3 eta, k;
};
const std::array<Metal, 3> kMetals = {{
    {"Silver", {0.0522f, 0.0596f, 0.0400f}, {4.4094f, 3.5974f, 2.6484f}},
    {"Gold", {0.1556f, 0.4241f, 1.3831f}, {3.6024f, 2.4721f, 1.9155f}},
    {"Copper", {0.2378f, 1.0066f, 1.2404f}, {3.6264f, 2.5823f, 2.3929f}},
}};

constexpr float kRadius = 0.42f;
constexpr float kSpacing = 1.0f;
constexpr float kStepHeight = 0.55f;
constexpr float kRoughest = 0.8f;

// Rows go back and up, so that none hides the next.
glm::vec3 stepCentre(int row) {
  const auto r = static_cast<float>(row);
  return {0.0f, 0.5f * kStepHeight * r, -1.1f * r};
}

void addSteps(Scene& scene, float width) {
  const int material = addMaterial(scene, makeDiffuseMaterial("Steps", glm::vec3(0.45f, 0.44f, 0.42f)));
  for (int row = 1; row < static_cast<int>(kMetals.size()); ++row) {
    Node node;
    node.translation = stepCentre(row);
    const float height = 2.0f * node.translation.y;
    addInstance(scene, "Step_" + std::to_string(row), finishMesh(makeBoxMesh({width, height, 1.1f})), material, node);
  }
}

void addSpheres(Scene& scene, int columns) {
  const auto sphere = finishMesh(makeSphereMesh(kRadius, 48, 24));
  for (std::size_t row = 0; row < kMetals.size(); ++row)
    for (int column = 0; column < columns; ++column) {
      const Metal& metal = kMetals[row];
      const float roughness = kRoughest * static_cast<float>(column) / static_cast<float>(columns - 1);
      const std::string name = std::string(metal.name) + "_" + std::to_string(column);
      Node node;
      const glm::vec3 step = stepCentre(static_cast<int>(row));
      node.translation =
          step + glm::vec3(kSpacing * (static_cast<float>(column) - 0.5f * static_cast<float>(columns - 1)),
                           step.y + kRadius, 0.0f);
      node.probe = ProbeSettings{};
      addInstance(scene, name, sphere, addMaterial(scene, makeMetalMaterial(name, metal.eta, metal.k, roughness)),
                  node);
    }
}

// Something to reflect: boxes in front of the steps, behind the camera and at the sides.
void addBoxes(Scene& scene, float width) {
  struct Box {
    glm::vec3 edges, position;
    float yawDegrees;
    glm::vec3 albedo;
  };
  const float side = 0.5f * width + 1.2f;
  const std::array<Box, 6> boxes = {{{{0.9f, 1.8f, 0.9f}, {-side, 0.9f, -1.4f}, 20.0f, {0.75f, 0.12f, 0.10f}},
                                     {{0.9f, 1.2f, 0.9f}, {side, 0.6f, -0.9f}, -30.0f, {0.10f, 0.25f, 0.75f}},
                                     {{0.5f, 0.3f, 0.5f}, {-1.1f, 0.15f, 1.3f}, 40.0f, {0.85f, 0.65f, 0.10f}},
                                     {{0.5f, 0.4f, 0.5f}, {1.3f, 0.2f, 1.4f}, 10.0f, {0.15f, 0.60f, 0.20f}},
                                     {{1.6f, 3.0f, 1.0f}, {-2.5f, 1.5f, 6.5f}, 15.0f, {0.80f, 0.40f, 0.08f}},
                                     {{1.6f, 3.0f, 1.0f}, {2.8f, 1.5f, 6.0f}, -20.0f, {0.45f, 0.12f, 0.60f}}}};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    Node node;
    node.translation = boxes[i].position;
    node.rotation = glm::angleAxis(glm::radians(boxes[i].yawDegrees), glm::vec3(0, 1, 0));
    const std::string name = "Box_" + std::to_string(i);
    addInstance(scene, name, finishMesh(makeBoxMesh(boxes[i].edges)),
                addMaterial(scene, makeDiffuseMaterial(name, boxes[i].albedo)), node);
  }
}

}  // namespace

Scene makeMetalsScene(SpecReader& parameters) {
  const int columns = parameters.integer("grid", 2, 8, 5);
  const float width = kSpacing * static_cast<float>(columns) + 0.2f;
  Scene scene;
  addInstance(scene, "Ground", finishMesh(makeQuadMesh({-15, 0, 15}, {30, 0, 0}, {0, 0, -30})),
              addMaterial(scene, makeDiffuseMaterial("Ground", {0.36f, 0.33f, 0.29f})));
  addSteps(scene, width);
  addSpheres(scene, columns);
  addBoxes(scene, width);
  // Width and height of the grid in a picture of 16:9.
  const float distance = 0.85f * static_cast<float>(std::max(columns, 4)) + 0.6f;
  addCamera(scene, "Camera", {0.0f, 2.3f, distance}, {0.0f, 0.85f, -0.9f}, glm::radians(40.0f), 0.1f);
  scene.environment = makeProceduralSky();
  return scene;
}

}  // namespace pb
