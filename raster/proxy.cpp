#include "raster/proxy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <optional>

namespace pb {
namespace {

// Metres; rays end so far away that nothing but their direction counts.
constexpr float kFarAway = 1e12f;

// A mean of unit vectors that is shorter than this is none: the normals of a bowl, half a sphere, have one of 0.5.
constexpr double kLeastMean = 0.1;

// Sums over the surfaces of a probe's owners, weighted by area.
struct MeanFrame {
  glm::dvec3 normal{0.0}, right{0.0}, down{0.0};  // of texture coordinates: along u and along v
  double area = 0.0;

  std::optional<glm::vec3> unit(const glm::dvec3& sum) const {
    return glm::length(sum) > kLeastMean * area ? std::optional(glm::vec3(glm::normalize(sum))) : std::nullopt;
  }
};

void add(MeanFrame& mean, const SnapshotInstance& instance) {
  const Mesh& mesh = *instance.mesh;
  const glm::dmat4 worldFromObject(instance.worldFromObject);
  const double side = instance.mirrored ? -1.0 : 1.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::array<glm::dvec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = worldFromObject * glm::dvec4(mesh.positions[mesh.indices[i + k]], 1.0);
    const glm::dvec3 area = side * glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    mean.normal += area;
    mean.area += glm::length(area);
    if (mesh.tangents.empty()) continue;
    const glm::vec4& tangent = mesh.tangents[mesh.indices[i]];
    const glm::dvec3 right = glm::dmat3(worldFromObject) * glm::dvec3(tangent);
    if (glm::length(right) == 0.0) continue;
    mean.right += glm::length(area) * glm::normalize(right);
    mean.down -= side * static_cast<double>(tangent.w) * glm::cross(area, glm::normalize(right));
  }
}

MeanFrame meanFrameOf(const Snapshot& snapshot, const Probe& probe) {
  MeanFrame mean;
  for (const int owner : probe.owners) add(mean, snapshot.instances[static_cast<std::size_t>(owner)]);
  return mean;
}

glm::vec3 towardsCamera(const Snapshot& snapshot, const Probe& probe) {
  const glm::vec3 toCamera = glm::vec3(snapshot.camera.origin) - probe.position;
  return glm::length(toCamera) > 0.0f ? glm::normalize(toCamera) : glm::vec3(0.0f, 0.0f, 1.0f);
}

}  // namespace

Bounds proxyBoxOf(const Snapshot& snapshot, const Probe& probe) {
  if (probe.proxyBox) return *probe.proxyBox;
  Bounds bounds;
  for (std::size_t i = 0; i < snapshot.instances.size(); ++i)
    if (std::ranges::find(probe.owners, static_cast<int>(i)) == probe.owners.end())
      bounds.include(snapshot.instances[i].worldBounds);
  return bounds.empty() ? Bounds{glm::vec3(-kFarAway), glm::vec3(kFarAway)} : bounds;
}

float proxyRadiusOf(const Bounds& box) {
  const glm::vec3 edges = box.extent();
  return (edges.x + edges.y + edges.z) / 6.0f;
}

shading::View singleView(const Snapshot& snapshot, const Probe& probe) {
  const MeanFrame mean = meanFrameOf(snapshot, probe);
  const glm::vec3 front = mean.unit(mean.normal).value_or(towardsCamera(snapshot, probe));
  const glm::vec3 upright = std::abs(front.y) < 0.99f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
  glm::vec3 right = glm::normalize(glm::cross(upright, front));
  glm::vec3 down = glm::cross(right, front);
  const glm::dvec3 across = mean.right - glm::dot(mean.right, glm::dvec3(front)) * glm::dvec3(front);
  if (const auto along = mean.unit(across)) {
    right = *along;
    down = glm::cross(right, front);
    if (glm::dot(mean.down, glm::dvec3(down)) < 0.0) down = -down;
  }
  return {
      .origin = {probe.position, probe.zNear}, .forward = {front, 0.0f}, .right = {right, 0.0f}, .down = {down, 0.0f}};
}

gpu::ProbeConstants probeConstants(const Snapshot& snapshot, const Probe& probe) {
  const Bounds box = proxyBoxOf(snapshot, probe);
  return {.position = {probe.position, probe.zNear},
          .boxLower = {box.lower, proxyRadiusOf(box)},
          .boxUpper = {box.upper, 0.0f},
          .right = singleView(snapshot, probe).right};
}

}  // namespace pb
