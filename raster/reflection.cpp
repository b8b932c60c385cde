#include "raster/reflection.h"

#include "raster/prefilter.h"

namespace pb {

Reflection reflectionOf(const Technique& technique, const Snapshot& snapshot, const SnapshotInstance& instance) {
  const bool hasCoat = snapshot.materialOf(instance).constants.kind.x == shading::kSurfaceGlossy;
  if (instance.probe < 0 && hasCoat && technique.coats == Coats::none) return {ReflectionSource::nothing};
  if (technique.probes == ProbeUse::environmentOnly) return {ReflectionSource::environment};
  if (instance.probe >= 0) return {ReflectionSource::probe, instance.probe};
  if (hasCoat && technique.coats == Coats::nearestProbe && instance.nearestProbe >= 0)
    return {ReflectionSource::probe, instance.nearestProbe};
  return {ReflectionSource::environment};
}

std::vector<bool> probesOfRoughLobes(const Technique& technique, const Snapshot& snapshot) {
  std::vector<bool> looked(snapshot.probes.size(), false);
  for (const SnapshotInstance& instance : snapshot.instances) {
    const Reflection reflection = reflectionOf(technique, snapshot, instance);
    if (reflection.source == ReflectionSource::probe && hasRoughLobe(snapshot.materialOf(instance)))
      looked[static_cast<std::size_t>(reflection.probe)] = true;
  }
  return looked;
}

CoatSources coatSources(const Technique& technique, const Snapshot& snapshot) {
  CoatSources sources{std::vector<int>(snapshot.probes.size(), 0), 0};
  for (const SnapshotInstance& instance : snapshot.instances) {
    const bool hasCoat = snapshot.materialOf(instance).constants.kind.x == shading::kSurfaceGlossy;
    if (instance.probe >= 0 || !hasCoat) continue;
    const Reflection reflection = reflectionOf(technique, snapshot, instance);
    if (reflection.source == ReflectionSource::probe) ++sources.ofProbes[static_cast<std::size_t>(reflection.probe)];
    if (reflection.source == ReflectionSource::environment) ++sources.fromEnvironment;
  }
  return sources;
}

}  // namespace pb
