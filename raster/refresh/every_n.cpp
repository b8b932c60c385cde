#include "raster/refresh/policies.h"

namespace pb {
namespace {

int readN(const Spec& spec) {
  SpecReader reader = policyReader(spec);
  const int n = reader.integer("n", 1, 1000, 4);
  reader.finish();
  return n;
}

RefreshPolicy::Function make(const Spec& spec) {
  return [n = readN(spec)](const RefreshHistory& history, const Snapshot& snapshot) {
    return history.frame % n == 0 ? allFaces(snapshot) : std::vector<ProbeFace>{};
  };
}

}  // namespace

RefreshPolicy everyNPolicy() {
  return {.name = "every-n",
          .parameters = "n = frames between captures, 1 to 1000, default 4",
          .description = "Captures all faces of all probes together in every n-th frame, nothing in between.",
          .source = "Unity: a probe's RenderProbe() called by a script every few frames",
          .make = make,
          .cycle = [](const Spec& spec, int) { return readN(spec); }};
}

}  // namespace pb
