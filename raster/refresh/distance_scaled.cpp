#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "raster/refresh/policies.h"

namespace pb {
namespace {

struct Settings {
  double near;
  unsigned longest;  // a power of two
};

Settings read(const Spec& spec) {
  SpecReader reader = policyReader(spec);
  const Settings settings = {reader.number("near", 0.01, 1e6, 4.0),
                             std::bit_floor(static_cast<unsigned>(reader.integer("longest", 1, 1024, 16)))};
  reader.finish();
  return settings;
}

// Frames between captures: 1 up to the distance `near`, then doubled with each doubling of the distance.
unsigned period(const Settings& settings, const Snapshot& snapshot, const Probe& probe) {
  const Bounds bounds = boundsOfOwners(snapshot, probe);
  const double diameter = glm::length(bounds.extent());
  const double distance = glm::distance(bounds.centre(), glm::vec3(snapshot.camera.origin));
  const double steps = std::ceil(std::log2(std::max(distance / std::max(settings.near * diameter, 1e-30), 1.0)));
  return std::min(1u << static_cast<unsigned>(std::min(steps, 10.0)), settings.longest);
}

// All periods are powers of two, so that a period that changes delays a capture by less than the new one.
RefreshPolicy::Function make(const Spec& spec) {
  return [settings = read(spec)](const RefreshHistory& history, const Snapshot& snapshot) {
    std::vector<ProbeFace> faces = capturedFaces(history.technique, snapshot);
    std::erase_if(faces, [&](const ProbeFace& f) {
      const Probe& probe = snapshot.probes[static_cast<std::size_t>(f.probe)];
      return (history.frame + f.probe) % period(settings, snapshot, probe) != 0;
    });
    return faces;
  };
}

}  // namespace

RefreshPolicy distanceScaledPolicy() {
  return {.name = "distance-scaled",
          .parameters =
              "near = distance from the camera up to which a probe is captured in every frame, in diameters "
              "of its owners, 0.01 to 1e6, default 4; longest = frames between captures at most, 1 to 1024, "
              "rounded down to a power of two, default 16",
          .description =
              "Captures all faces of a probe every 2^n frames, n growing by one with each doubling of its "
              "distance from the camera.",
          .source = "engines: update rates by distance, as of animations and reflections",
          .make = make,
          .cycle = [](const Spec& spec, int) { return static_cast<int>(read(spec).longest); }};
}

}  // namespace pb
