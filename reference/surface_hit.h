// What rays meet, and what the surface looks like where they meet it.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "reference/embree_scene.h"
#include "scenes/snapshot.h"

namespace pb {

class LightSampler;

// One flag an instance, non-zero: opaque, and sends out no light by itself.
using DarkInstances = std::span<const unsigned char>;
std::vector<unsigned char> findDarkInstances(const Snapshot& snapshot);

// The snapshot and its triangles, less the hidden instances.
struct TracedScene {
  const Snapshot& snapshot;
  const EmbreeScene& embree;
  HiddenInstances hidden;
  HiddenInstances hiddenFromPrimary;     // those included that are hidden from all rays
  const LightSampler* lights = nullptr;  // none: light is only found by chance
  DarkInstances dark{};                  // empty: not known
  bool isAllDark = false;

  bool isDark(int instance) const { return !dark.empty() && dark[static_cast<std::size_t>(instance)] != 0; }

  std::optional<Hit> intersect(const Ray& ray) const { return embree.intersect(ray, hidden); }
  std::optional<Hit> intersectPrimary(const Ray& ray) const { return embree.intersect(ray, hiddenFromPrimary); }
  Occlusion occlusion(const Ray& ray, float tFar) const { return embree.occlusion(ray, tFar, hidden); }
  bool isHidden(int instance) const {
    return instance >= 0 && !hidden.empty() && hidden[static_cast<std::size_t>(instance)] != 0;
  }
  const SnapshotInstance& instanceOf(const Hit& hit) const {
    return snapshot.instances[static_cast<std::size_t>(hit.instance)];
  }
  const Material& materialOf(const Hit& hit) const { return snapshot.materialOf(instanceOf(hit)); }
};

// The vertices' attributes at the hit of a ray in unit direction d. The normal of a double-sided or glass surface is
// turned to the side from which the ray comes: the triangle's side, not the normal's own, so that a smooth normal that
// leans away at a silhouette isn't turned.
SurfaceAttributes interpolate(const TracedScene& scene, const Hit& hit, const glm::vec3& d, float coneWidth);

// The surface at the hit of a ray in unit direction d: its attributes interpolated, its textures read.
shading::Surface surfaceAt(const TracedScene& scene, const Hit& hit, const glm::vec3& d, float coneWidth);

// The point from which a ray in `direction` goes on, off the triangle by more than the rounding of `position` and of
// the next intersection, so that neither this triangle nor a neighbour in its plane is met again. Which side it is on
// is the direction's: see tracePath() for directions that dive under the triangle.
glm::vec3 offsetOrigin(const TracedScene& scene, const Hit& hit, const glm::vec3& position, const glm::vec3& direction);

// What a primary ray shows.
SampleId identify(const TracedScene& scene, const Ray& primary, float conePerMetre);

// The length of a primary ray to that, in lengths of its direction; infinity for the environment.
float distanceAlong(const TracedScene& scene, const Ray& primary, float conePerMetre);

}  // namespace pb
