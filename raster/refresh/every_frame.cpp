#include "raster/refresh/policies.h"

namespace pb {
namespace {

RefreshPolicy::Function make(const Spec& spec) {
  policyReader(spec).finish();
  return [](const RefreshHistory& history, const Snapshot& snapshot) {
    return capturedFaces(history.technique, snapshot);
  };
}

}  // namespace

RefreshPolicy everyFramePolicy() {
  return {.name = "every-frame",
          .parameters = "",
          .description = "Captures all faces of all probes in every frame.",
          .source = "three.js CubeCamera.update() called once a frame; Unity: Refresh Mode 'Every frame'",
          .make = make,
          .cycle = [](const Spec&, int) { return 1; }};
}

}  // namespace pb
