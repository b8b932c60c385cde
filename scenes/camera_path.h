// Cameras that move: orbits, and key frames with eased transitions.
#pragma once

#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>

#include "scenes/scene.h"

namespace pb {

// Looks along -Z of the rotation, +Y up. World space.
struct CameraPose {
  glm::vec3 eye{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  // w x y z
};

CameraPose lookAt(const glm::vec3& eye, const glm::vec3& target);

// From a (t = 0) to b (t = 1) with speed 0 at both ends: smoothstep of t, linear for positions, along the great circle
// for rotations. Constant outside of [0, 1].
CameraPose easedBetween(const CameraPose& a, const CameraPose& b, float t);

// A circle at `height` above the target, counter-clockwise seen from above.
struct Orbit {
  glm::vec3 target{0.0f};
  float radius = 1.0f;  // of the circle, horizontally from the target
  float height = 0.0f;
  double periodSeconds = 8.0;
  double startDegrees = 0.0;  // where it begins: 0 towards +Z, 90 towards +X
  float verticalFov = 0.0f;   // radians
};
CameraPose poseAt(const Orbit& orbit, double seconds);

// "orbit" or "orbit?target=x;y;z&radius=..&height=..&period=..&start=..&fov=.." (metres, seconds, degrees); nullopt for
// other names. What is not given is chosen so that the box is in sight. Throws an input Error for bad parameters.
std::optional<Orbit> parseOrbit(const std::string& camera, const Bounds& box);

// Adds a camera that moves along poseAt(seconds) from 0 to durationSeconds: sampled into linear key frames, which other
// programs play as well.
void addCameraPath(Scene& scene, const std::string& name, double durationSeconds, float verticalFov, float zNear,
                   const std::function<CameraPose(double seconds)>& poseAt);

}  // namespace pb
