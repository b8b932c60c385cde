// The triangles of a snapshot in world space, and the nearest one along a ray. All of Embree is behind this header.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/snapshot.h"

namespace pb {

struct Ray {
  glm::vec3 origin;
  glm::vec3 direction;  // any length; distances along the ray count in it
  float tNear = 0.0f;
};

struct Hit {
  int instance;
  std::uint32_t triangle;
  float t;
  glm::vec2 barycentrics;     // of the triangle's second and third vertex
  glm::vec3 geometricNormal;  // unit, on the side that the ray comes from
  bool entering;              // the ray comes from the side that the mesh calls outside
};

// One flag an instance, non-zero: no ray meets it. Empty: none is hidden, which is the quickest to trace.
using HiddenInstances = std::vector<unsigned char>;

// What stands in a ray's way.
enum class Occlusion {
  none,
  transparent,  // surfaces whose material isn't opaque, and nothing else
  full
};

class EmbreeScene {
 public:
  // Throws an environment Error if Embree can't build the acceleration structure. The snapshot must outlive this
  // object.
  explicit EmbreeScene(const Snapshot& snapshot);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  // The nearest hit beyond tNear. Triangles seen from behind count only where the material is double-sided or glass,
  // as the raster culls the others. Called from any thread.
  std::optional<Hit> intersect(const Ray& ray, const HiddenInstances& hidden) const;

  // Whether something is hit between tNear and tFar, under the same rules. Called from any thread.
  Occlusion occlusion(const Ray& ray, float tFar, const HiddenInstances& hidden) const;

  // Processor seconds that this thread spends in Embree to find the nearest triangle of all along each ray, facing
  // aside, in packets of `width` consecutive rays: 1, 8 or 16. `coherent` is Embree's hint. For measuring.
  double secondsToIntersect(std::span<const Ray> rays, int width, bool coherent) const;

  // World positions of the triangle's vertices.
  std::array<glm::vec3, 3> triangle(int instance, std::uint32_t index) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pb
