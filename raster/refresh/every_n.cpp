#include "raster/refresh/policies.h"

namespace pb {
namespace {

struct Settings {
  int n;
  bool together;
};

Settings read(const Spec& spec) {
  SpecReader reader = policyReader(spec);
  const Settings settings = {reader.integer("n", 1, 1000, 4), reader.integer("together", 0, 1, 0) == 1};
  reader.finish();
  return settings;
}

RefreshPolicy::Function make(const Spec& spec) {
  return [settings = read(spec)](const RefreshHistory& history, const Snapshot& snapshot) {
    std::vector<ProbeFace> faces = capturedFaces(history.technique, snapshot);
    std::erase_if(faces, [&](const ProbeFace& f) {
      return (history.frame + (settings.together ? 0 : f.probe)) % settings.n != 0;
    });
    return faces;
  };
}

}  // namespace

RefreshPolicy everyNPolicy() {
  return {.name = "every-n",
          .parameters =
              "n = frames between a probe's captures, 1 to 1000, default 4; together = 1: all probes in the "
              "same frames, default 0",
          .description = "Captures all faces of a probe in every n-th frame, another probe in each frame.",
          .source = "Unity: a probe's RenderProbe() called by a script every few frames",
          .make = make,
          .cycle = [](const Spec& spec, int) { return read(spec).n; }};
}

}  // namespace pb
