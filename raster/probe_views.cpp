#include "raster/probe_views.h"

#include "raster/probe_layout.h"
#include "raster/probe_resolution.h"
#include "raster/refraction.h"

namespace pb {

ProbeViews probeViews(const Technique& technique, const std::shared_ptr<const Snapshot>& snapshot, int heightPx) {
  ProbeLayout layout(technique);
  const Snapshot& laidOut = layout.apply(*snapshot);
  ProbeViews views{&laidOut == snapshot.get() ? snapshot : std::make_shared<const Snapshot>(laidOut), {}};
  const std::vector<int> resolutions = probeResolutions(technique, laidOut, heightPx);
  for (std::size_t i = 0; i < laidOut.probes.size(); ++i) {
    const Probe& probe = laidOut.probes[i];
    ProbeView& view = views.probes.emplace_back(ProbeView{probe.position, probe.zNear, {}, resolutions[i]});
    for (const int owner : probe.owners) {
      const SnapshotInstance& instance = laidOut.instances[static_cast<std::size_t>(owner)];
      if (!isCapturedFromInside(technique, laidOut.materialOf(instance))) view.hidden.push_back(owner);
    }
  }
  return views;
}

}  // namespace pb
