#include "raster/equal_captures.h"

#include <algorithm>

#include "raster/lookup.h"
#include "raster/lookup_records.h"
#include "raster/prefilter.h"
#include "raster/reflection.h"
#include "raster/refraction.h"

namespace pb {
namespace {

bool isCoat(const Material& material) { return material.constants.kind.x == shading::kSurfaceGlossy; }

bool isMirrorOrGlass(const Material& material) {
  const float kind = material.constants.kind.x;
  return kind == shading::kSurfaceMirror || kind == shading::kSurfaceGlass;
}

bool isAnyWithoutProbe(const Snapshot& snapshot, bool (*isCounted)(const Material&)) {
  return std::ranges::any_of(snapshot.instances, [&](const SnapshotInstance& instance) {
    return instance.probe < 0 && isCounted(snapshot.materialOf(instance));
  });
}

// A map is not shown in captures of its own probe.
bool showsMapOfAnother(const Reflection& reflection, int probe) {
  if (reflection.source != ReflectionSource::probe) return false;
  return reflection.probe != probe || (reflection.second >= 0 && reflection.second != probe);
}

CapturedSurfaces surfaceOf(const Technique& technique, const Snapshot& snapshot, int instance, int probe) {
  const SnapshotInstance& seen = snapshot.instances[static_cast<std::size_t>(instance)];
  const Material& material = snapshot.materialOf(seen);
  if (!isCoat(material) && !isMirrorOrGlass(material)) return {};
  return {.showMaps = showsMapOfAnother(reflectionOf(technique, snapshot, seen), probe),
          .areSpecular = true,
          .areRough = hasRoughLobe(material),
          .refract = isSolidGlass(material),
          .disperse = isSolidGlass(material) && material.constants.kind.w > 0.0f};
}

}  // namespace

bool mayShareCaptures(const Technique& technique, const Scene& scene) {
  const auto isInTheWay = [&](const Material& material) {
    return material.constants.alpha.x == shading::kAlphaBlend || readsBackFaces(technique, material);
  };
  return technique.probes == ProbeUse::dynamic && viewsOfProbe(technique) == 6 &&
         !lookupOf(technique.lookup).isPlanar && !scene.castsShadows &&
         std::ranges::none_of(scene.materials, isInTheWay);
}

CapturedSurfaces& CapturedSurfaces::operator|=(const CapturedSurfaces& other) {
  showMaps = showMaps || other.showMaps;
  areSpecular = areSpecular || other.areSpecular;
  areRough = areRough || other.areRough;
  refract = refract || other.refract;
  disperse = disperse || other.disperse;
  return *this;
}

CapturedSurfaces capturedSurfaces(const Technique& technique, const Snapshot& snapshot) {
  CapturedSurfaces surfaces;
  const ByProbeAndFace<FaceContent> contents = faceContents(technique, snapshot);
  for (std::size_t probe = 0; probe < contents.size(); ++probe)
    for (const FaceContent& face : contents[probe])
      for (const int instance : face.instances)
        surfaces |= surfaceOf(technique, snapshot, instance, static_cast<int>(probe));
  return surfaces;
}

CaptureKeyMaker::CaptureKeyMaker(const Technique& technique, int heightPx)
    : technique_(technique), layout_(technique), schedule_(technique, heightPx) {}

void CaptureKeyMaker::advance(const Snapshot& given) {
  const Snapshot& snapshot = layout_.apply(given);
  due_.push_back(schedule_.advance(snapshot));
  surfaces_ |= capturedSurfaces(technique_, snapshot);
  levels_ = levelFilter(technique_, snapshot);
  haveCoatsWithoutProbe_ = haveCoatsWithoutProbe_ || isAnyWithoutProbe(snapshot, isCoat);
  haveMirrorsWithoutProbe_ = haveMirrorsWithoutProbe_ || isAnyWithoutProbe(snapshot, isMirrorOrGlass);
}

// What stays whatever is seen: where probes stand and what of the scene they draw, the formats, sizes and levels of the
// maps, and how these are filled. Levels are named by what the maps have, unless rough surfaces in captures read those
// of the environment.
CaptureKey CaptureKeyMaker::key() const {
  const Technique defaults;
  Technique technique = technique_;
  technique.preset = defaults.preset;
  technique.refresh = defaults.refresh;
  technique.shadowResolution = defaults.shadowResolution;  // there are no shadows: mayShareCaptures()
  const bool repeats = repeatsLookups(technique_);
  technique.iterations = repeats ? Iterations::incremental : Iterations::bruteForce;
  if (!surfaces_.showMaps) {
    technique.lookup = defaults.lookup;
    technique.feedback = defaults.feedback;
    if (!repeats) technique.bounces = defaults.bounces;
  }
  if (!surfaces_.areSpecular) {
    technique.fresnel = defaults.fresnel;
    technique.geometryTerm = defaults.geometryTerm;
  }
  if (!surfaces_.refract) technique.refraction = defaults.refraction;
  if (!surfaces_.disperse) technique.dispersion = defaults.dispersion;
  if (!surfaces_.areRough) technique.filter = levels_;
  if (!haveCoatsWithoutProbe_) technique.coats = defaults.coats;
  if (!haveMirrorsWithoutProbe_) technique.withoutProbe = defaults.withoutProbe;
  return {std::move(technique), due_};
}

}  // namespace pb
