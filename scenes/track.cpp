#include "scenes/track.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>

namespace pb {
namespace {

glm::quat quatOf(const glm::vec4& xyzw) { return {xyzw.w, xyzw.x, xyzw.y, xyzw.z}; }

glm::vec4 slerp(const glm::vec4& a, const glm::vec4& b, float t) {
  const glm::quat q = glm::slerp(glm::normalize(quatOf(a)), glm::normalize(quatOf(b)), t);
  return {q.x, q.y, q.z, q.w};
}

// Hermite spline of glTF 2.0, appendix C.5, from v0 to v1, `step` seconds later, with the out-tangent b0 and the
// in-tangent a1.
template <class T>
T hermite(const T& v0, const T& b0, const T& a1, const T& v1, float t, float step) {
  const float t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * v0 + step * (t3 - 2 * t2 + t) * b0 + (-2 * t3 + 3 * t2) * v1 + step * (t3 - t2) * a1;
}

// Where a time lies between the keys: t of the way from key `first` to `second`, `step` seconds later.
struct BetweenKeys {
  std::size_t first, second;
  float t, step;
};
BetweenKeys locate(const std::vector<float>& times, double timeSeconds) {
  const auto time = static_cast<float>(timeSeconds);
  if (time <= times.front()) return {0, 0, 0.0f, 0.0f};
  if (time >= times.back()) return {times.size() - 1, times.size() - 1, 0.0f, 0.0f};
  const auto k = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin()) - 1;
  const float step = times[k + 1] - times[k];
  return {k, k + 1, (time - times[k]) / step, step};
}

// at(key, part) is what stands at a key: its value or, of a cubic spline, its in-tangent, value and out-tangent.
template <class At, class Mix>
auto interpolate(const Track& track, const BetweenKeys& keys, const At& at, const Mix& mix) {
  const bool spline = track.interpolation == Interpolation::cubicSpline;
  const std::size_t value = spline ? 1 : 0;
  if (keys.first == keys.second || track.interpolation == Interpolation::step) return at(keys.first, value);
  if (spline)
    return hermite(at(keys.first, 1), at(keys.first, 2), at(keys.second, 0), at(keys.second, 1), keys.t, keys.step);
  return mix(at(keys.first, 0), at(keys.second, 0), keys.t);
}

}  // namespace

std::size_t valuesPerKey(const Track& track) { return track.interpolation == Interpolation::cubicSpline ? 3 : 1; }

std::size_t weightsPerValue(const Track& track) {
  const std::size_t values = track.timesSeconds.size() * valuesPerKey(track);
  return values == 0 || track.weights.size() % values != 0 ? 0 : track.weights.size() / values;
}

glm::vec4 sampleTrack(const Track& track, double timeSeconds) {
  const std::size_t perKey = valuesPerKey(track);
  const auto at = [&](std::size_t key, std::size_t part) { return track.values[key * perKey + part]; };
  const auto mix = [&](const glm::vec4& a, const glm::vec4& b, float t) {
    return track.target == TrackTarget::rotation ? slerp(a, b, t) : glm::mix(a, b, t);
  };
  return interpolate(track, locate(track.timesSeconds, timeSeconds), at, mix);
}

std::vector<float> sampleWeights(const Track& track, double timeSeconds) {
  const std::size_t count = weightsPerValue(track), perKey = valuesPerKey(track);
  const BetweenKeys keys = locate(track.timesSeconds, timeSeconds);
  std::vector<float> weights;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&](std::size_t key, std::size_t part) { return track.weights[(key * perKey + part) * count + i]; };
    const auto mix = [](float a, float b, float t) { return glm::mix(a, b, t); };
    weights.push_back(interpolate(track, keys, at, mix));
  }
  return weights;
}

}  // namespace pb
