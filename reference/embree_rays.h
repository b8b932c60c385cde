// Embree's types for rays, of either version. Only for the files that call Embree.
#pragma once

#include <limits>

#include "reference/embree_scene.h"

#if PROBEBENCH_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace pb {

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
inline constexpr RTCSceneFlags kFilterOfQuery = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
using QueryContext = RTCIntersectContext;
inline constexpr RTCSceneFlags kFilterOfQuery = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

inline RTCRay makeRay(const Ray& ray, float tFar) {
  RTCRay r{};
  r.org_x = ray.origin.x;
  r.org_y = ray.origin.y;
  r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.tnear = ray.tNear;
  r.tfar = tFar;
  r.mask = ~0u;
  return r;
}

inline RTCRayHit makeRayHit(const Ray& ray) {
  RTCRayHit r{};
  r.ray = makeRay(ray, std::numeric_limits<float>::infinity());
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return r;
}

}  // namespace pb
