#include "scenes/camera_path.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr double kFar = 1e6;  // metres
constexpr float kDefaultFovDegrees = 40.0f;
constexpr float kDefaultElevationDegrees = 20.0f;
// Between samples of a smoothstep of T seconds linear key frames are off by at most 6 / T^2 / 8 / rate^2 of the way:
// 0.03 % for a transition of 1.5 s.
constexpr double kSamplesPerSecond = 30.0;

glm::vec3 parsePoint(const std::string& text, const std::string& place) {
  glm::vec3 point(0.0f);
  std::size_t at = 0;
  for (int i = 0; i < 3; ++i) {
    const std::size_t end = std::min(text.find(';', at), text.size());
    const std::optional<double> number = at <= text.size() ? parseNumber(text.substr(at, end - at)) : std::nullopt;
    const bool isLast = end == text.size();
    if (!number || std::abs(*number) > kFar || isLast != (i == 2))
      throwInputError("{}: target wants x;y;z within {:g} m, got '{}'", place, kFar, text);
    point[i] = static_cast<float>(*number);
    at = end + 1;
  }
  return point;
}

}  // namespace

CameraPose lookAt(const glm::vec3& eye, const glm::vec3& target) {
  const glm::vec3 forward = shading::safeNormalize(target - eye);
  // Straight up or down there is no other up direction to be preferred.
  const glm::vec3 up = std::abs(forward.y) < 0.9999f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
  return {eye, glm::quatLookAt(forward, up)};
}

CameraPose easedBetween(const CameraPose& a, const CameraPose& b, float t) {
  const float s = glm::smoothstep(0.0f, 1.0f, t);
  return {glm::mix(a.eye, b.eye, s), glm::slerp(a.rotation, b.rotation, s)};
}

CameraPose poseAt(const Orbit& orbit, double seconds) {
  const double turns = seconds / orbit.periodSeconds + orbit.startDegrees / 360.0;
  const double angle = 2.0 * 3.14159265358979323846 * (turns - std::floor(turns));
  const glm::vec3 direction(static_cast<float>(std::sin(angle)), 0.0f, static_cast<float>(std::cos(angle)));
  const glm::vec3 eye = orbit.target + orbit.radius * direction + glm::vec3(0.0f, orbit.height, 0.0f);
  return lookAt(eye, orbit.target);
}

std::optional<Orbit> parseOrbit(const std::string& camera, const Bounds& box) {
  if (camera != "orbit" && !camera.starts_with("orbit?")) return std::nullopt;
  const Spec spec = parseSpec(camera);
  const std::string place = "camera '" + camera + "'";
  SpecReader reader(spec, place);
  Orbit orbit;
  const std::optional<std::string> target = reader.optionalText("target");
  orbit.target = target ? parsePoint(*target, place) : box.empty() ? glm::vec3(0.0f) : box.centre();
  orbit.verticalFov = glm::radians(static_cast<float>(reader.number("fov", 1.0, 150.0, kDefaultFovDegrees)));
  // As far away as the bounding sphere just fits the vertical field of view.
  const float sphere = box.empty() ? 1.0f : std::max(0.5f * glm::length(box.extent()), 1e-3f);
  const float distance = sphere / std::sin(0.5f * orbit.verticalFov);
  const float elevation = glm::radians(kDefaultElevationDegrees);
  orbit.radius =
      static_cast<float>(reader.number("radius", 1e-3, kFar, static_cast<double>(distance * std::cos(elevation))));
  orbit.height =
      static_cast<float>(reader.number("height", -kFar, kFar, static_cast<double>(orbit.radius * std::tan(elevation))));
  orbit.periodSeconds = reader.number("period", 1e-2, 1e6, orbit.periodSeconds);
  orbit.startDegrees = reader.number("start", -360.0, 360.0, orbit.startDegrees);
  reader.finish();
  return orbit;
}

void addCameraPath(Scene& scene, const std::string& name, double durationSeconds, float verticalFov, float zNear,
                   const std::function<CameraPose(double seconds)>& poseAt) {
  const int steps = static_cast<int>(std::ceil(durationSeconds * kSamplesPerSecond));
  const int index = static_cast<int>(scene.nodes.size());
  Track translation, rotation;
  translation.node = rotation.node = index;
  rotation.target = TrackTarget::rotation;
  for (int i = 0; i <= steps; ++i) {
    const double seconds = durationSeconds * i / steps;
    const CameraPose pose = poseAt(seconds);
    translation.timesSeconds.push_back(static_cast<float>(seconds));
    translation.values.emplace_back(pose.eye, 0.0f);
    rotation.values.emplace_back(pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w);
  }
  rotation.timesSeconds = translation.timesSeconds;
  Node node;
  node.name = name;
  const CameraPose first = poseAt(0.0);
  node.translation = first.eye;
  node.rotation = first.rotation;
  scene.nodes.push_back(std::move(node));
  scene.tracks.push_back(std::move(translation));
  scene.tracks.push_back(std::move(rotation));
  scene.cameras.push_back({.name = name, .node = index, .verticalFov = verticalFov, .zNear = zNear});
}

}  // namespace pb
