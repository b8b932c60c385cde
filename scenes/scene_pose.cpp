#include "scenes/scene_pose.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "scenes/deformation.h"
#include "scenes/error.h"

namespace pb {
namespace {

struct Pose {
  glm::vec3 translation;
  glm::quat rotation;
  glm::vec3 scale;
};

glm::mat4 localMatrix(const Node& node, const Pose& pose) {
  if (node.matrix) return *node.matrix;
  const glm::mat4 rotation = glm::mat4_cast(glm::normalize(pose.rotation));
  return glm::scale(glm::translate(glm::mat4(1.0f), pose.translation) * rotation, pose.scale);
}

// The scales of a chain of nodes multiply, also beyond what float holds.
void checkWorldMatrix(const Scene& scene, const Node& node, const glm::mat4& world, double timeSeconds) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      if (const float number = world[column][row]; !(std::abs(number) <= kLargestWorldTransform))
        throwInputError("world transforms hold numbers up to {:g}, that of node '{}' of scene '{}' has {:g} at {:g} s",
                        kLargestWorldTransform, node.name, scene.name, number, timeSeconds);
}

std::vector<glm::mat4> worldMatrices(const Scene& scene, double timeSeconds) {
  std::vector<Pose> poses;
  poses.reserve(scene.nodes.size());
  for (const Node& node : scene.nodes) poses.push_back({node.translation, node.rotation, node.scale});
  for (const Track& track : scene.tracks) {
    if (track.target == TrackTarget::morphWeights) continue;
    const glm::vec4 value = sampleTrack(track, timeSeconds);
    Pose& pose = poses[static_cast<std::size_t>(track.node)];
    switch (track.target) {
      case TrackTarget::translation:
        pose.translation = glm::vec3(value);
        break;
      case TrackTarget::scale:
        pose.scale = glm::vec3(value);
        break;
      case TrackTarget::rotation:
        pose.rotation = glm::quat(value.w, value.x, value.y, value.z);
        break;
      case TrackTarget::morphWeights:
        break;
    }
  }
  std::vector<glm::mat4> world(scene.nodes.size());
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const int parent = scene.nodes[n].parent;
    const glm::mat4 local = localMatrix(scene.nodes[n], poses[n]);
    world[n] = parent < 0 ? local : world[static_cast<std::size_t>(parent)] * local;
    checkWorldMatrix(scene, scene.nodes[n], world[n], timeSeconds);
  }
  return world;
}

std::vector<glm::mat4> jointMatrices(const Skin& skin, const ScenePose& pose) {
  std::vector<glm::mat4> matrices;
  for (std::size_t j = 0; j < skin.joints.size(); ++j)
    matrices.push_back(pose.world[static_cast<std::size_t>(skin.joints[j])] * skin.inverseBindMatrices[j]);
  return matrices;
}

WorldMesh worldMesh(const Scene& scene, const Instance& instance, const ScenePose& pose, double timeSeconds) {
  const auto n = static_cast<std::size_t>(instance.node);
  const Node& node = scene.nodes[n];
  const Mesh& mesh = *instance.mesh;
  WorldMesh result{pose.world[n], instance.mesh, false};
  if (deforms(scene, instance)) {
    MeshPose meshPose{.morphWeights = {}, .wave = node.wave, .timeSeconds = timeSeconds, .jointMatrices = {}};
    if (!mesh.targets.empty()) meshPose.morphWeights = pose.morphWeights[n];
    if (node.skin >= 0 && !mesh.joints.empty()) {
      meshPose.jointMatrices = jointMatrices(scene.skins[static_cast<std::size_t>(node.skin)], pose);
      result.worldFromObject = glm::mat4(1.0f);
      // A skin that mirrors does so as a whole.
      result.mirrored = glm::determinant(glm::mat3(meshPose.jointMatrices.front())) < 0.0f;
    }
    result.mesh = deform(mesh, meshPose);
  }
  if (glm::determinant(glm::mat3(result.worldFromObject)) < 0.0f) result.mirrored = !result.mirrored;
  return result;
}

}  // namespace

ScenePose poseOf(const Scene& scene, double timeSeconds) {
  ScenePose pose{worldMatrices(scene, timeSeconds), {}};
  for (const Node& node : scene.nodes) pose.morphWeights.push_back(node.morphWeights);
  for (const Track& track : scene.tracks)
    if (track.target == TrackTarget::morphWeights)
      pose.morphWeights[static_cast<std::size_t>(track.node)] = sampleWeights(track, timeSeconds);
  return pose;
}

std::vector<WorldMesh> worldMeshes(const Scene& scene, const ScenePose& pose, double timeSeconds) {
  std::vector<WorldMesh> result;
  result.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) result.push_back(worldMesh(scene, instance, pose, timeSeconds));
  return result;
}

std::vector<WorldMesh> worldMeshes(const Scene& scene, double timeSeconds) {
  return worldMeshes(scene, poseOf(scene, timeSeconds), timeSeconds);
}

}  // namespace pb
