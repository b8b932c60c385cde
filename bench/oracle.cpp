#include "bench/oracle.h"

#include <algorithm>
#include <optional>

#include "bench/bounce_depth.h"
#include "bench/interrupt.h"
#include "raster/lookup.h"

namespace pb {

bool takesOracleMaps(const Technique& technique) {
  return technique.probes == ProbeUse::dynamic && viewsOfProbe(technique) == 6;
}

Technique withGivenMaps(Technique technique) {
  technique.probes = ProbeUse::given;
  return technique;
}

OracleMaps traceMaps(const ProbeViews& views, ReferenceSettings settings, bool withDistances) {
  settings.samplesPerAxis = 1;
  const ReferenceScene scene(views.snapshot);
  OracleMaps maps;
  const std::optional<int> depth = settings.depth;
  for (std::size_t i = 0; i < views.probes.size(); ++i) {
    const ProbeView& view = views.probes[i];
    const Probe probe{.position = view.position, .owners = view.hidden, .zNear = view.zNear};
    if (depth) settings.depth = std::max(*depth - hitsBeforeMap(*views.snapshot, views.snapshot->probes[i].owners), 1);
    maps.faces.push_back(traceProbe(scene, probe, view.resolutionPx, settings, &interruptRequested()));
    maps.distances.emplace_back();
    if (withDistances) maps.distances.back() = traceProbeDistances(scene, probe, view.resolutionPx);
  }
  return maps;
}

Image renderWithMaps(RasterDevice& device, const Technique& given, const Snapshot& snapshot, const ImageSettings& image,
                     const OracleMaps& maps) {
  RasterSequence sequence(device, given, image.widthPx, image.heightPx, image.samplesPerAxis);
  const bool withDistances = needsDistances(given);
  for (std::size_t probe = 0; probe < maps.faces.size(); ++probe)
    sequence.setProbe(static_cast<int>(probe), maps.faces[probe],
                      withDistances ? maps.distances[probe] : std::array<Plane, 6>());
  sequence.renderFrame(snapshot);
  return sequence.readImage();
}

}  // namespace pb
