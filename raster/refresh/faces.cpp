#include <algorithm>
#include <numeric>

#include "raster/refresh/policies.h"

namespace pb {
namespace {

int readK(const Spec& spec) {
  SpecReader reader = policyReader(spec);
  const int k = reader.integer("k", 1, 10000, 1);
  reader.finish();
  return k;
}

// k faces from where the frame before stopped; frame 0 captures everything, so frame 1 begins with the first face.
RefreshPolicy::Function make(const Spec& spec) {
  return [k = readK(spec)](const RefreshHistory& history, const Snapshot& snapshot) {
    std::vector<ProbeFace> faces = capturedFaces(history.technique, snapshot);
    if (history.frame == 0 || static_cast<std::size_t>(k) >= faces.size()) return faces;
    const auto start = static_cast<std::size_t>(k * (history.frame - 1)) % faces.size();
    std::ranges::rotate(faces, faces.begin() + static_cast<std::ptrdiff_t>(start));
    faces.resize(static_cast<std::size_t>(k));
    return faces;
  };
}

int cycle(const Spec& spec, int allFaces) {
  const int faces = std::max(allFaces, 1);
  const int k = std::min(readK(spec), faces);
  return faces / std::gcd(faces, k);
}

}  // namespace

RefreshPolicy facesPolicy() {
  return {.name = "faces",
          .parameters = "k = faces a frame over all probes together, 1 to 10000, default 1",
          .description = "Captures k faces a frame, round robin over the faces of all probes.",
          .source = "Unity: Time Slicing 'Individual faces'",
          .make = make,
          .cycle = cycle};
}

}  // namespace pb
