// Rays of paths, kept apart by what they are: for measuring what tracing them costs without the rest.
#pragma once

#include <array>
#include <vector>

#include "reference/embree_scene.h"
#include "reference/path.h"

namespace pb {

inline constexpr std::size_t kRayKinds = 4;

struct RecordedRays {
  std::array<std::vector<Ray>, kRayKinds> ofKind;  // each in the order in which the paths needed them
};

struct RayLog {
  RecordedRays* rays;
  void add(const Ray& ray, RayKind kind) { rays->ofKind[static_cast<std::size_t>(kind)].push_back(ray); }
};

extern template class BasicPath<RayLog>;

}  // namespace pb
