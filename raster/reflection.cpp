#include "raster/reflection.h"

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <numeric>

#include "raster/lookup.h"
#include "raster/prefilter.h"

namespace pb {
namespace {

// Inverse metres; a probe nearer than a micrometre counts as so near.
float closeness(const Probe& probe, const glm::vec3& p) {
  return 1.0f / std::max(glm::distance(probe.position, p), 1e-6f);
}

Reflection blendOfNearest(const Snapshot& snapshot, const SnapshotInstance& instance) {
  const glm::vec3 centre = instance.worldBounds.centre();
  std::vector<int> order(snapshot.probes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto closenessOf = [&](int probe) {
    return closeness(snapshot.probes[static_cast<std::size_t>(probe)], centre);
  };
  std::ranges::stable_sort(order, std::ranges::greater(), closenessOf);
  if (order.size() == 1) return {ReflectionSource::probe, order[0]};
  const float third = order.size() > 2 ? closenessOf(order[2]) : 0.0f;
  const float first = closenessOf(order[0]) - third;
  const float second = closenessOf(order[1]) - third;
  // All three at one distance.
  if (first <= 0.0f) return {ReflectionSource::probe, order[0], order[1], 0.5f};
  return {ReflectionSource::probe, order[0], order[1], second / (first + second)};
}

bool hasCoat(const Snapshot& snapshot, const SnapshotInstance& instance) {
  return snapshot.materialOf(instance).constants.kind.x == shading::kSurfaceGlossy;
}

bool looksSomethingUp(const Snapshot& snapshot, const SnapshotInstance& instance) {
  const float kind = snapshot.materialOf(instance).constants.kind.x;
  return kind == shading::kSurfaceGlossy || kind == shading::kSurfaceMirror || kind == shading::kSurfaceGlass;
}

LookupSources sourcesOf(const Technique& technique, const Snapshot& snapshot,
                        bool (*isCounted)(const Snapshot&, const SnapshotInstance&)) {
  LookupSources sources{std::vector<int>(snapshot.probes.size(), 0), 0};
  for (const SnapshotInstance& instance : snapshot.instances) {
    if (instance.probe >= 0 || !isCounted(snapshot, instance)) continue;
    const Reflection reflection = reflectionOf(technique, snapshot, instance);
    if (reflection.source == ReflectionSource::probe) ++sources.ofProbes[static_cast<std::size_t>(reflection.probe)];
    if (reflection.source == ReflectionSource::environment) ++sources.fromEnvironment;
  }
  return sources;
}

// By probe: whether a surface of a wanted material looks it up.
std::vector<bool> probesLookedUp(const Technique& technique, const Snapshot& snapshot,
                                 bool (*isWanted)(const Material&)) {
  std::vector<bool> looked(snapshot.probes.size(), false);
  for (const SnapshotInstance& instance : snapshot.instances) {
    const Reflection reflection = reflectionOf(technique, snapshot, instance);
    if (reflection.source != ReflectionSource::probe || !isWanted(snapshot.materialOf(instance))) continue;
    for (const int probe : {reflection.probe, reflection.second})
      if (probe >= 0) looked[static_cast<std::size_t>(probe)] = true;
  }
  return looked;
}

}  // namespace

Reflection reflectionOf(const Technique& technique, const Snapshot& snapshot, const SnapshotInstance& instance) {
  const bool isCoat = hasCoat(snapshot, instance);
  if (instance.probe < 0 && isCoat && technique.coats == Coats::none) return {ReflectionSource::nothing};
  if (technique.probes == ProbeUse::environmentOnly) return {ReflectionSource::environment};
  if (instance.probe >= 0) return {ReflectionSource::probe, instance.probe};
  if (!looksSomethingUp(snapshot, instance) || snapshot.probes.empty()) return {ReflectionSource::environment};
  const bool showsNearest = isCoat ? technique.coats == Coats::nearestProbe  //
                                   : technique.withoutProbe == WithoutProbe::nearestProbe;
  const bool showsBlend = isCoat ? technique.coats == Coats::blendedProbes  //
                                 : technique.withoutProbe == WithoutProbe::blendedProbes;
  if (showsNearest && instance.nearestProbe >= 0) return {ReflectionSource::probe, instance.nearestProbe};
  if (showsBlend) return blendOfNearest(snapshot, instance);
  return {ReflectionSource::environment};
}

ProbeFilter levelFilter(const Technique& technique, const Snapshot& snapshot) {
  const auto any = [](const std::vector<bool>& probes) { return std::ranges::find(probes, true) != probes.end(); };
  if (any(probesLookedUp(technique, snapshot, hasRoughLobe)) && mapFilter(technique) != ProbeFilter::none)
    return mapFilter(technique);
  return technique.mips && any(probesWithLevels(technique, snapshot)) ? ProbeFilter::boxMips : ProbeFilter::none;
}

std::vector<bool> probesWithLevels(const Technique& technique, const Snapshot& snapshot) {
  if (technique.mips) return probesLookedUp(technique, snapshot, [](const Material&) { return true; });
  return probesLookedUp(technique, snapshot, hasRoughLobe);
}

LookupSources coatSources(const Technique& technique, const Snapshot& snapshot) {
  return sourcesOf(technique, snapshot, hasCoat);
}

LookupSources mirrorSources(const Technique& technique, const Snapshot& snapshot) {
  return sourcesOf(technique, snapshot, [](const Snapshot& s, const SnapshotInstance& instance) {
    return looksSomethingUp(s, instance) && !hasCoat(s, instance);
  });
}

}  // namespace pb
