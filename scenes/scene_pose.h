// The nodes of a scene at one time, and its meshes as they are then.
#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "scenes/snapshot.h"

namespace pb {

// One entry a node of the scene. World transforms hold numbers up to kLargestWorldTransform.
struct ScenePose {
  std::vector<glm::mat4> world;
  std::vector<std::vector<float>> morphWeights;
};

// Both throw as worldMeshes() of scenes/snapshot.h does.
ScenePose poseOf(const Scene& scene, double timeSeconds);
std::vector<WorldMesh> worldMeshes(const Scene& scene, const ScenePose& pose, double timeSeconds);

}  // namespace pb
