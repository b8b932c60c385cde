#include <algorithm>

#include "raster/refresh/policies.h"

namespace pb {
namespace {

// By face: what it shows has changed since its capture.
ByProbeAndFace<bool> changedFaces(const RefreshHistory& history, const ByProbeAndFace<FaceContent>& contents) {
  ByProbeAndFace<bool> changed(contents.size());
  for (std::size_t probe = 0; probe < contents.size(); ++probe)
    for (std::size_t face = 0; face < 6; ++face)
      changed[probe][face] = probe >= history.contentAtCapture.size() ||
                             history.contentAtCapture[probe][face] != contents[probe][face].hash;
  return changed;
}

// Marks the faces that see the map of a probe of which a face is marked, until there are no more of them.
void markReflections(const Technique& technique, const Snapshot& snapshot, const ByProbeAndFace<FaceContent>& contents,
                     ByProbeAndFace<bool>& marked) {
  const auto isMarked = [&](int probe) {
    const std::array<bool, 6>& faces = marked[static_cast<std::size_t>(probe)];
    return std::ranges::find(faces, true) != faces.end();
  };
  const auto showsMarked = [&](int instance) {
    return std::ranges::any_of(probesShownBy(technique, snapshot, instance), isMarked);
  };
  for (bool grows = true; grows;) {
    grows = false;
    for (std::size_t probe = 0; probe < contents.size(); ++probe)
      for (std::size_t face = 0; face < 6; ++face)
        if (!marked[probe][face] && std::ranges::any_of(contents[probe][face].instances, showsMarked))
          grows = marked[probe][face] = true;
  }
}

RefreshPolicy::Function make(const Spec& spec) {
  policyReader(spec).finish();
  return [](const RefreshHistory& history, const Snapshot& snapshot) {
    const ByProbeAndFace<FaceContent> contents = faceContents(history.technique, snapshot);
    ByProbeAndFace<bool> due = changedFaces(history, contents);
    markReflections(history.technique, snapshot, contents, due);
    std::vector<ProbeFace> faces = capturedFaces(history.technique, snapshot);
    std::erase_if(faces, [&](const ProbeFace& f) {
      return !due[static_cast<std::size_t>(f.probe)][static_cast<std::size_t>(f.face)];
    });
    return faces;
  };
}

}  // namespace

RefreshPolicy onChangePolicy() {
  return {.name = "on-change",
          .parameters = "",
          .description =
              "Captures the faces in whose view something has changed since their capture: instances other "
              "than the owners, screens, lights, the environment, the probe's place, or another probe's map.",
          .source = "Unity: Refresh Mode 'Via scripting', with a script that watches for changes",
          .make = make,
          .cycle = [](const Spec&, int) { return 1; }};
}

}  // namespace pb
