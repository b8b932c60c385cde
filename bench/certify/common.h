// Shared by the certificates: scenes in code rendered by both renderers.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "raster/renderer.h"
#include "reference/renderer.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/snapshot.h"

namespace pb {

// Half floats have 11 significant bits: storing rounds by at most this fraction of the value.
inline constexpr double kHalfRounding = 1.0 / 4096.0;

// finishScene() and the snapshot of frame 0.
inline std::shared_ptr<const Snapshot> snapshotOf(Scene scene, double aspect = 1.0) {
  finishScene(scene);
  return makeSnapshot(std::make_shared<const Scene>(std::move(scene)), 0, "", aspect);
}

// Radiance horizon + slope * max(d.y, 0), grey.
inline Environment makeLinearSky(double horizon, double slope) {
  shading::Sky sky{};
  sky.horizon = glm::vec4(glm::vec3(static_cast<float>(horizon)), 0.0f);
  sky.zenith = glm::vec4(glm::vec3(static_cast<float>(horizon + slope)), 0.0f);
  sky.below = sky.horizon;
  sky.glow.w = 1.0f;
  sky.toGlow = {0.0f, 1.0f, 0.0f, 0.0f};
  return makeGradientEnvironment(sky);
}

// The faces of one probe after one frame.
inline std::array<Image, 6> captureProbe(RasterDevice& device, const Snapshot& snapshot, const Technique& technique,
                                         int probe = 0) {
  RasterSequence sequence(device, technique, 8, 8, 1);
  sequence.renderFrame(snapshot);
  return sequence.readProbe(probe);
}

inline Image renderRaster(RasterDevice& device, const Snapshot& snapshot, const Technique& technique, int widthPx,
                          int heightPx, int samplesPerAxis) {
  RasterSequence sequence(device, technique, widthPx, heightPx, samplesPerAxis);
  sequence.renderFrame(snapshot);
  return sequence.readImage();
}

inline std::vector<ImageRgba> rgbaFaces(const std::array<Image, 6>& faces) {
  std::vector<ImageRgba> result;
  for (const Image& face : faces) {
    ImageRgba rgba(face.width(), face.height());
    for (std::size_t i = 0; i < face.size(); ++i) rgba[i] = glm::vec4(face[i], 1.0f);
    result.push_back(std::move(rgba));
  }
  return result;
}

inline double maxDifference(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 d = glm::abs(a - b);
  return static_cast<double>(std::max({d.x, d.y, d.z}));
}

}  // namespace pb
