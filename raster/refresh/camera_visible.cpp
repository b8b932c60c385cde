#include "raster/culling.h"
#include "raster/refresh/policies.h"

namespace pb {
namespace {

std::vector<bool> visibleProbes(const Technique& technique, const Snapshot& snapshot) {
  std::vector<bool> visible(snapshot.probes.size(), false);
  for (std::size_t i = 0; i < snapshot.instances.size(); ++i)
    if (!isOutsideFrustum(snapshot.instances[i].worldBounds, snapshot.camera))
      for (const int probe : probesShownBy(technique, snapshot, static_cast<int>(i)))
        visible[static_cast<std::size_t>(probe)] = true;
  return visible;
}

RefreshPolicy::Function make(const Spec& spec) {
  policyReader(spec).finish();
  return [](const RefreshHistory& history, const Snapshot& snapshot) {
    const std::vector<bool> visible = visibleProbes(history.technique, snapshot);
    std::vector<ProbeFace> faces = capturedFaces(history.technique, snapshot);
    std::erase_if(faces, [&](const ProbeFace& f) { return !visible[static_cast<std::size_t>(f.probe)]; });
    return faces;
  };
}

}  // namespace

RefreshPolicy cameraVisiblePolicy() {
  return {.name = "camera-visible",
          .parameters = "",
          .description =
              "Captures all faces of the probes that something in the camera's field of view shows; those "
              "that are seen in reflections only stay as they are.",
          .source = "engines: reflection captures culled by the camera's view",
          .make = make,
          .cycle = [](const Spec&, int) { return 1; }};
}

}  // namespace pb
