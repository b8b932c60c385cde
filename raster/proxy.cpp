#include "raster/proxy.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace pb {
namespace {

// Metres; rays end so far away that nothing but their direction counts.
constexpr float kFarAway = 1e12f;

// A mean normal shorter than this is none: that of a bowl, a quarter sphere's surface seen from its rim, has 0.5.
constexpr double kLeastMeanNormal = 0.1;

// Unit mean over the surfaces of the probe's owners, or towards the camera.
glm::vec3 frontOf(const Snapshot& snapshot, const Probe& probe) {
  glm::dvec3 sum(0.0);
  double area = 0.0;
  for (const int owner : probe.owners) {
    const SnapshotInstance& instance = snapshot.instances[static_cast<std::size_t>(owner)];
    const Mesh& mesh = *instance.mesh;
    const auto corner = [&](std::size_t i) {
      return glm::dvec3(instance.worldFromObject * glm::vec4(mesh.positions[mesh.indices[i]], 1.0f));
    };
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const glm::dvec3 normal = glm::cross(corner(i + 1) - corner(i), corner(i + 2) - corner(i));
      sum += instance.mirrored ? -normal : normal;
      area += glm::length(normal);
    }
  }
  if (glm::length(sum) > kLeastMeanNormal * area) return glm::vec3(glm::normalize(sum));
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
  const glm::vec3 front = frontOf(snapshot, probe);
  const glm::vec3 upright = std::abs(front.y) < 0.99f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
  const glm::vec3 right = glm::normalize(glm::cross(upright, front));
  return {.origin = {probe.position, probe.zNear},
          .forward = {front, 0.0f},
          .right = {right, 0.0f},
          .down = {glm::cross(right, front), 0.0f}};
}

gpu::ProbeConstants probeConstants(const Snapshot& snapshot, const Probe& probe) {
  const Bounds box = proxyBoxOf(snapshot, probe);
  return {.position = {probe.position, probe.zNear},
          .boxLower = {box.lower, proxyRadiusOf(box)},
          .boxUpper = {box.upper, 0.0f},
          .right = singleView(snapshot, probe).right};
}

}  // namespace pb
