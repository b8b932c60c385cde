#include "reference/probe.h"

namespace pb {

std::array<Image, 6> traceProbe(const ReferenceScene& scene, const Probe& probe, int resolutionPx,
                                ReferenceSettings settings, const std::atomic<bool>* cancelled) {
  settings.hiddenFromPrimary = probe.owners;
  std::array<Image, 6> faces;
  for (int face = 0; face < 6; ++face)
    faces[static_cast<std::size_t>(face)] =
        scene.render(cubeFaceView(probe.position, face, probe.zNear), resolutionPx, resolutionPx, settings, cancelled)
            .mean();
  return faces;
}

std::array<Plane, 6> traceProbeDistances(const ReferenceScene& scene, const Probe& probe, int resolutionPx) {
  std::array<Plane, 6> distances;
  for (int face = 0; face < 6; ++face)
    distances[static_cast<std::size_t>(face)] = scene.renderDistances(cubeFaceView(probe.position, face, probe.zNear),
                                                                      resolutionPx, resolutionPx, probe.owners);
  return distances;
}

}  // namespace pb
