// Meshes that change their shape: morph targets, waves and skins, in this order. Pure functions of a mesh at rest and
// its pose.
#pragma once

#include <glm/mat4x4.hpp>
#include <memory>
#include <vector>

#include "scenes/scene.h"

namespace pb {

struct MeshPose {
  std::vector<float> morphWeights;  // one a morph target of the mesh
  std::optional<Wave> wave;
  double timeSeconds = 0.0;              // of the wave
  std::vector<glm::mat4> jointMatrices;  // by joint of the skin, destination from rest; empty: the mesh is not skinned
};

// The mesh as the pose has it, with the topology of the one at rest. Normals follow by the inverse transpose of the
// deformation, tangents by the deformation itself; targets without normals or tangents leave these as they are, except
// that flat normals are computed anew (glTF 2.0, section 3.7.2.2). A skinned mesh is in the joints' destination space,
// any other in its own. Throws an input Error naming the mesh for vertices beyond kLargestWorldTransform.
std::shared_ptr<const Mesh> deform(const Mesh& rest, const MeshPose& pose);

// Completes a mesh whose vertices moved: flat normals, density of texture coordinates, bounds, content hash.
std::shared_ptr<const Mesh> finishDeformedMesh(Mesh mesh);

// Inverse transpose of a matrix up to a positive factor: of its cofactors, which exist for singular matrices too.
glm::mat3 normalMatrixOf(const glm::mat3& m);

}  // namespace pb
