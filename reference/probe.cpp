#include "reference/probe.h"

namespace pb {

OracleProbe traceProbe(const ReferenceScene& scene, const Probe& probe, int resolutionPx, ReferenceSettings settings,
                       const std::atomic<bool>* cancelled) {
  settings.hiddenFromPrimary = probe.owners;
  OracleProbe oracle;
  for (int face = 0; face < 6; ++face) {
    const shading::View view = cubeFaceView(probe.position, face, probe.zNear);
    const auto f = static_cast<std::size_t>(face);
    oracle.faces[f] = scene.render(view, resolutionPx, resolutionPx, settings, cancelled).mean();
    oracle.distances[f] = scene.renderDistances(view, resolutionPx, resolutionPx, probe.owners);
  }
  return oracle;
}

}  // namespace pb
