#include "scenes/deformation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>
#include <span>

namespace pb {
namespace {

void addWeighted(std::vector<glm::vec3>& values, const std::vector<glm::vec3>& deltas, float weight) {
  for (std::size_t i = 0; i < deltas.size(); ++i) values[i] += weight * deltas[i];
}

void addWeighted(std::vector<glm::vec4>& tangents, const std::vector<glm::vec3>& deltas, float weight) {
  if (tangents.empty()) return;
  for (std::size_t i = 0; i < deltas.size(); ++i) tangents[i] += glm::vec4(weight * deltas[i], 0.0f);
}

// glTF 2.0, section 3.7.2.2.
void morph(Mesh& mesh, const std::vector<MorphTarget>& targets, const std::vector<float>& weights) {
  assert(targets.size() == weights.size());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    if (weights[t] == 0.0f) continue;
    addWeighted(mesh.positions, targets[t].positions, weights[t]);
    addWeighted(mesh.normals, targets[t].normals, weights[t]);
    addWeighted(mesh.tangents, targets[t].tangents, weights[t]);
  }
}

// The displacement along Z at (x, y) and its derivatives.
struct Displacement {
  float z;
  glm::vec3 gradient;
};
Displacement displacementAt(const Wave& wave, double turns, const glm::vec3& p) {
  if (p.x <= 0.0f) return {0.0f, glm::vec3(0.0f)};
  constexpr double kTwoPi = glm::two_pi<double>();
  const double x = p.x, growth = static_cast<double>(wave.amplitude) / static_cast<double>(wave.length);
  const double wavelength = wave.wavelength, skew = wave.skew;
  const double phase = kTwoPi * (x / wavelength + skew * static_cast<double>(p.y) - turns);
  const double sine = std::sin(phase), cosine = std::cos(phase);
  const double alongX = growth * (sine + x * cosine * kTwoPi / wavelength);
  return {static_cast<float>(growth * x * sine),
          glm::vec3(static_cast<float>(alongX), static_cast<float>(growth * x * cosine * kTwoPi * skew), 0.0f)};
}

// The deformation's Jacobian is J = I + z g^T with g the displacement's gradient and z the unit vector: it takes
// tangents to t + z (g . t) and, as its inverse transpose is I - g z^T, normals to n - g n.z.
void makeWaves(Mesh& mesh, const Wave& wave, double timeSeconds) {
  const double periods = timeSeconds / static_cast<double>(wave.periodSeconds);
  const double turns = periods - std::floor(periods);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Displacement d = displacementAt(wave, turns, mesh.positions[v]);
    mesh.positions[v].z += d.z;
    mesh.normals[v] -= d.gradient * mesh.normals[v].z;
    if (!mesh.tangents.empty()) mesh.tangents[v].z += glm::dot(d.gradient, glm::vec3(mesh.tangents[v]));
  }
}

glm::mat4 blended(const std::vector<glm::mat4>& matrices, const glm::u16vec4& joints, const glm::vec4& weights) {
  if (weights.x == 1.0f) return matrices[joints.x];
  glm::mat4 sum(0.0f);
  for (int k = 0; k < 4; ++k)
    if (weights[k] != 0.0f) sum += weights[k] * matrices[joints[k]];
  return sum;
}

// glTF 2.0, section 3.7.3.3.
void bend(Mesh& mesh, const Mesh& rest, const std::vector<glm::mat4>& matrices) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::mat4 m = blended(matrices, rest.joints[v], rest.jointWeights[v]);
    mesh.positions[v] = glm::vec3(m * glm::vec4(mesh.positions[v], 1.0f));
    mesh.normals[v] = normalMatrixOf(glm::mat3(m)) * mesh.normals[v];
    if (!mesh.tangents.empty())
      mesh.tangents[v] = glm::vec4(glm::mat3(m) * glm::vec3(mesh.tangents[v]), mesh.tangents[v].w);
  }
}

void normaliseFrames(Mesh& mesh) {
  for (glm::vec3& n : mesh.normals) n = shading::safeNormalize(n);
  for (glm::vec4& t : mesh.tangents) t = glm::vec4(shading::safeNormalize(glm::vec3(t)), t.w);
}

}  // namespace

std::shared_ptr<const Mesh> deform(const Mesh& rest, const MeshPose& pose) {
  Mesh mesh;
  mesh.name = rest.name;
  mesh.positions = rest.positions;
  mesh.normals = rest.normals;
  mesh.tangents = rest.tangents;
  mesh.uvs = rest.uvs;
  mesh.colors = rest.colors;
  mesh.indices = rest.indices;
  mesh.hasFlatNormals = rest.hasFlatNormals;
  mesh.smoothingGroups = rest.smoothingGroups;
  morph(mesh, rest.targets, pose.morphWeights);
  if (pose.wave) makeWaves(mesh, *pose.wave, pose.timeSeconds);
  if (!pose.jointMatrices.empty()) bend(mesh, rest, pose.jointMatrices);
  normaliseFrames(mesh);
  return finishDeformedMesh(std::move(mesh));
}

glm::mat3 normalMatrixOf(const glm::mat3& m) {
  const glm::mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0.0f ? -cofactors : cofactors;
}

}  // namespace pb
