#include "raster/frame_passes.h"

#include <glm/geometric.hpp>
#include <limits>

#include "raster/lookup.h"
#include "raster/proxy.h"
#include "raster/refresh/policies.h"
#include "raster/texel_format.h"

namespace pb {
namespace {

constexpr float kUnlimited = std::numeric_limits<float>::infinity();

gpu::PassConstants passConstants(const Snapshot& snapshot, const shading::View& view, int width, int height,
                                 float largestRadiance) {
  return {.view = withResolution(view, width),
          .image = {static_cast<float>(width), static_cast<float>(height), largestRadiance, 0.0f},
          .lights = {static_cast<float>(snapshot.areaLights.size()), 0.0f, 0.0f, 0.0f},
          .clip = glm::vec4(0.0f)};
}

// PassConstants::clip of a capture that shows nothing farther than that along the axis of its face; 0: everything.
glm::vec4 farPlane(const shading::View& view, float metres) {
  if (metres <= 0.0f) return glm::vec4(0.0f);
  const glm::vec3 forward(view.forward);
  return {-forward, metres + glm::dot(forward, glm::vec3(view.origin))};
}

}  // namespace

gpu::PassConstants finalPass(const Snapshot& snapshot, int widthSamples, int heightSamples) {
  return passConstants(snapshot, snapshot.camera, widthSamples, heightSamples, kUnlimited);
}

gpu::PassConstants mirroredPass(const Snapshot& snapshot, const MirroredView& mirror, int widthSamples,
                                int heightSamples) {
  const float largestRadiance = texelFormat(ProbeFormat::rgba16f).largestRadiance;
  gpu::PassConstants pass = passConstants(snapshot, mirror.view, widthSamples, heightSamples, largestRadiance);
  pass.clip = {mirror.plane.normal, -mirror.plane.offset};
  return pass;
}

std::vector<gpu::PassConstants> capturePasses(const Technique& technique, const Snapshot& snapshot,
                                              const std::vector<int>& resolutions) {
  const bool isSingleView = viewsOfProbe(technique) == 1;
  const float largestRadiance = texelFormat(technique.format).largestRadiance;
  std::vector<gpu::PassConstants> passes;
  for (const ProbeFace& f : allFaces(snapshot)) {
    const Probe& probe = snapshot.probes[static_cast<std::size_t>(f.probe)];
    const shading::View view =
        isSingleView ? singleView(snapshot, probe) : cubeFaceView(probe.position, f.face, probe.zNear);
    const int resolution = resolutions[static_cast<std::size_t>(f.probe)];
    passes.push_back(passConstants(snapshot, view, resolution, resolution, largestRadiance));
    passes.back().clip = farPlane(view, technique.captureFar);
  }
  return passes;
}

}  // namespace pb
