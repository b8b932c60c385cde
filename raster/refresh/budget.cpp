#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

#include "raster/culling.h"
#include "raster/probe_resolution.h"
#include "raster/refresh/policies.h"

namespace pb {
namespace {

// Weight of what is not seen, or stands still, beside that of what fills the view.
constexpr float kLeast = 0.125f;
// Rounds that a face waits for at most before it comes first, whatever its weight. A round is the time in which every
// face could be captured once.
constexpr std::int64_t kPatience = 4;

int readFaces(const Spec& spec) {
  SpecReader reader = policyReader(spec);
  const int faces = reader.integer("faces", 1, 10000, 6);
  reader.finish();
  return faces;
}

// Height of the owners' bounding sphere in the final image, as a share of the image's height; 0 outside of the image.
float screenSize(const Snapshot& snapshot, const Probe& probe) {
  const Bounds bounds = boundsOfOwners(snapshot, probe);
  return isOutsideFrustum(bounds, snapshot.camera) ? 0.0f : std::min(projectedSize(snapshot, bounds), 1.0f);
}

bool hasChanged(const RefreshHistory& history, const Snapshot& snapshot, std::size_t instance, std::int64_t since) {
  return instance >= history.instances.size() || history.lastChangedFrame[instance] > since ||
         history.instances[instance] != instanceHash(snapshot, snapshot.instances[instance]);
}

// Share of a face's solid angle, 4 pi / 6, that bounding spheres of instances cover which have changed since the
// capture: pi r^2 / d^2 each, 1 at most. What has left the face's view counts as the least, and an owner that
// moves, with its probe, as all.
float motion(const RefreshHistory& history, const Snapshot& snapshot, const ProbeFace& f, const FaceContent& content) {
  const auto probe = static_cast<std::size_t>(f.probe);
  const auto face = static_cast<std::size_t>(f.face);
  if (history.contentAtCapture[probe][face] == content.hash) return 0.0f;
  const auto hasChangedSinceCapture = [&](int i) {
    return hasChanged(history, snapshot, static_cast<std::size_t>(i), history.lastCapturedFrame[probe][face]);
  };
  if (std::ranges::any_of(snapshot.probes[probe].owners, hasChangedSinceCapture)) return 1.0f;
  float share = kLeast;
  for (const int i : content.instances) {
    if (!hasChangedSinceCapture(i)) continue;
    const SnapshotInstance& instance = snapshot.instances[static_cast<std::size_t>(i)];
    const float radius = 0.5f * glm::length(instance.worldBounds.extent());
    const float distance = glm::distance(instance.worldBounds.centre(), snapshot.probes[probe].position);
    share += 1.5f * radius * radius / std::max({distance * distance, radius * radius, 1e-30f});
  }
  return std::min(share, 1.0f);
}

struct Candidate {
  ProbeFace face;
  bool isOverdue;
  float priority;
};

// Overdue faces come first, the oldest of them before the others: what becomes overdue later stands behind, so that a
// face waits for less than one more round. No face gets older than (kPatience + 1) rounds.
RefreshPolicy::Function make(const Spec& spec) {
  return [budget = readFaces(spec)](const RefreshHistory& history, const Snapshot& snapshot) {
    std::vector<ProbeFace> faces = capturedFaces(history.technique, snapshot);
    const auto count = static_cast<std::int64_t>(faces.size());
    if (history.contentAtCapture.size() != snapshot.probes.size() || count <= budget) return faces;
    const std::int64_t round = (count + budget - 1) / budget;
    const ByProbeAndFace<FaceContent> contents = faceContents(history.technique, snapshot);
    std::vector<Candidate> candidates;
    for (const ProbeFace& f : faces) {
      const auto probe = static_cast<std::size_t>(f.probe);
      const auto age = ageOf(history, f);
      const float weight = (kLeast + screenSize(snapshot, snapshot.probes[probe])) *
                           (kLeast + motion(history, snapshot, f, contents[probe][static_cast<std::size_t>(f.face)]));
      const bool isOverdue = age >= kPatience * round;
      candidates.push_back({f, isOverdue, static_cast<float>(age) * (isOverdue ? 1.0f : weight)});
    }
    // Of equals those come first whose turn it would be if all were equal.
    std::ranges::rotate(candidates, candidates.begin() + budget * (history.frame - 1) % count);
    std::ranges::stable_sort(candidates, std::greater(),
                             [](const Candidate& c) { return std::tuple(c.isOverdue, c.priority); });
    candidates.resize(static_cast<std::size_t>(budget));
    faces.clear();
    for (const Candidate& candidate : candidates) faces.push_back(candidate.face);
    return faces;
  };
}

// While nothing moves and all owners are equally large: round robin.
int cycle(const Spec& spec, int allFaces) {
  const int faces = std::max(allFaces, 1);
  return faces / std::gcd(faces, std::min(readFaces(spec), faces));
}

}  // namespace

RefreshPolicy budgetPolicy() {
  return {.name = "budget",
          .parameters = "faces = faces a frame over all probes together, 1 to 10000, default 6",
          .description =
              "Captures the faces that need it most: by age, size of the owners in the picture, and how much "
              "of the view has changed; each at least once in five rounds over all faces.",
          .source = "engines: time-sliced queues of captures, by priority",
          .make = make,
          .cycle = cycle};
}

}  // namespace pb
