#include <algorithm>

#include "raster/refresh/policies.h"

namespace pb {
namespace {

RefreshPolicy::Function make(const Spec& spec) {
  policyReader(spec).finish();
  return [](const RefreshHistory& history, const Snapshot& snapshot) {
    std::vector<ProbeFace> faces = allFaces(snapshot);
    std::vector<bool> changed(snapshot.probes.size());
    for (std::size_t probe = 0; probe < changed.size(); ++probe)
      changed[probe] = probe >= history.contentAtCapture.size() ||
                       history.contentAtCapture[probe] != visibleContentHash(snapshot, static_cast<int>(probe));
    std::erase_if(faces, [&](const ProbeFace& f) { return !changed[static_cast<std::size_t>(f.probe)]; });
    return faces;
  };
}

}  // namespace

RefreshPolicy onChangePolicy() {
  return {.name = "on-change",
          .parameters = "",
          .description =
              "Captures all faces of a probe when the probe, a light or an instance other than its owners "
              "has moved since its last capture.",
          .source = "Unity: Refresh Mode 'Via scripting', with a script that watches for changes",
          .make = make,
          .cycle = [](const Spec&, int) { return 1; }};
}

}  // namespace pb
