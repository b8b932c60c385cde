#include "raster/refresh.h"

#include <xxhash.h>

#include <algorithm>

#include "raster/captured_faces.h"
#include "raster/culling.h"
#include "raster/probe_owners.h"
#include "raster/reflection.h"
#include "raster/refraction.h"
#include "raster/refresh/policies.h"
#include "scenes/error.h"

namespace pb {

#define REFRESH_POLICY(function) RefreshPolicy function();
#include "raster/refresh/policies.def"
#undef REFRESH_POLICY

namespace {

constexpr std::array<std::int64_t, 6> kNeverCaptured = {-1, -1, -1, -1, -1, -1};

// Chains one value's bytes to a hash.
template <class T>
void mixIn(std::uint64_t& hash, const T& value) {
  hash = XXH3_64bits_withSeed(&value, sizeof value, hash);
}

template <class T>
T& at(ByProbeAndFace<T>& values, const ProbeFace& f) {
  return values[static_cast<std::size_t>(f.probe)][static_cast<std::size_t>(f.face)];
}

bool neverCaptured(const RefreshHistory& history, const ProbeFace& f) {
  const auto probe = static_cast<std::size_t>(f.probe);
  return probe >= history.lastCapturedFrame.size() ||
         history.lastCapturedFrame[probe][static_cast<std::size_t>(f.face)] < 0;
}

// What all captures show.
std::uint64_t commonHash(const Snapshot& snapshot, const std::vector<std::uint64_t>& instances) {
  std::uint64_t hash = 0;
  for (const shading::Light& light : snapshot.lights) mixIn(hash, light);
  for (const shading::AreaLight& light : snapshot.areaLights) mixIn(hash, light);
  // What throws a shadow into a picture may stand anywhere.
  if (snapshot.scene->castsShadows && !snapshot.lights.empty())
    for (const std::uint64_t instance : instances) mixIn(hash, instance);
  mixIn(hash, snapshot.environmentIndex);
  mixIn(hash, snapshot.environment().sky);
  mixIn(hash, snapshot.environment().ambient);
  return hash;
}

bool isHidden(const Technique& technique, const Snapshot& snapshot, const Probe& probe, int instance) {
  if (std::ranges::find(probe.owners, instance) == probe.owners.end()) return false;
  return !isCapturedFromInside(technique, snapshot.materialOf(snapshot.instances[static_cast<std::size_t>(instance)]));
}

// By the largest of the three distances along the axes: never more than what a far plane, or a far sphere, goes by.
bool isTooFar(const Technique& technique, const glm::vec3& origin, const Bounds& box) {
  const glm::vec3 offset = glm::abs(glm::clamp(origin, box.lower, box.upper) - origin);
  return technique.captureFar > 0.0f && std::max({offset.x, offset.y, offset.z}) > technique.captureFar;
}

std::vector<int> instancesSeen(const Technique& technique, const Snapshot& snapshot, const ProbeFace& f) {
  const Probe& probe = snapshot.probes[static_cast<std::size_t>(f.probe)];
  const shading::View view = cubeFaceView(probe.position, f.face, probe.zNear);
  const FacePart part = capturedPart(technique, f.face);
  std::vector<int> seen;
  for (int i = 0; i < static_cast<int>(snapshot.instances.size()); ++i) {
    const Bounds& box = snapshot.instances[static_cast<std::size_t>(i)].worldBounds;
    if (!isOutsidePart(box, probe.position, part) && !isOutsideFrustum(box, view) &&
        !isTooFar(technique, probe.position, box) && !isHidden(technique, snapshot, probe, i))
      seen.push_back(i);
  }
  return seen;
}

std::vector<std::uint64_t> instanceHashes(const Snapshot& snapshot) {
  std::vector<std::uint64_t> hashes;
  for (const SnapshotInstance& instance : snapshot.instances) hashes.push_back(instanceHash(snapshot, instance));
  return hashes;
}

// By instance: of which probes' maps it shows. The nearest ones of those without one of their own may become others,
// when only the probes move. Probes are known by their owners: their numbers change when others are joined.
std::vector<std::uint64_t> shownMapHashes(const Technique& technique, const Snapshot& snapshot) {
  const std::vector<std::vector<int>> owners = ownersOfProbes(snapshot);
  const auto mixInProbe = [&](std::uint64_t& hash, int probe) {
    mixIn(hash, probe >= 0);
    if (probe < 0) return;
    for (const int owner : owners[static_cast<std::size_t>(probe)]) mixIn(hash, owner);
  };
  std::vector<std::uint64_t> hashes;
  for (const SnapshotInstance& instance : snapshot.instances) {
    const Reflection reflection = reflectionOf(technique, snapshot, instance);
    std::uint64_t& hash = hashes.emplace_back(0);
    mixInProbe(hash, reflection.probe);
    mixInProbe(hash, reflection.second);
    mixIn(hash, reflection.secondWeight);
  }
  return hashes;
}

}  // namespace

std::uint64_t instanceHash(const Snapshot& snapshot, const SnapshotInstance& instance) {
  std::uint64_t hash = 0;
  mixIn(hash, instance.mesh->contentHash);
  mixIn(hash, instance.material);
  mixIn(hash, instance.worldFromObject);
  if (snapshot.materialOf(instance).screen >= 0) mixIn(hash, snapshot.timeSeconds);
  return hash;
}

ByProbeAndFace<FaceContent> faceContents(const Technique& technique, const Snapshot& snapshot) {
  const std::vector<std::uint64_t> hashes = instanceHashes(snapshot);
  const std::uint64_t common = commonHash(snapshot, hashes);
  const std::vector<std::uint64_t> shown = shownMapHashes(technique, snapshot);
  ByProbeAndFace<FaceContent> contents(snapshot.probes.size());
  for (const ProbeFace& f : capturedFaces(technique, snapshot)) {
    FaceContent& content = at(contents, f);
    content.instances = instancesSeen(technique, snapshot, f);
    content.hash = common;
    mixIn(content.hash, snapshot.probes[static_cast<std::size_t>(f.probe)].position);
    mixIn(content.hash, snapshot.probes[static_cast<std::size_t>(f.probe)].zNear);
    for (const int instance : content.instances) {
      mixIn(content.hash, instance);
      mixIn(content.hash, hashes[static_cast<std::size_t>(instance)]);
      mixIn(content.hash, shown[static_cast<std::size_t>(instance)]);
    }
  }
  return contents;
}

std::vector<ProbeFace> allFaces(const Snapshot& snapshot) {
  std::vector<ProbeFace> faces;
  for (int probe = 0; probe < static_cast<int>(snapshot.probes.size()); ++probe)
    for (int face = 0; face < 6; ++face) faces.push_back({probe, face});
  return faces;
}

std::vector<ProbeFace> capturedFaces(const Technique& technique, const Snapshot& snapshot) {
  std::vector<ProbeFace> faces = allFaces(snapshot);
  std::erase_if(faces, [&](const ProbeFace& f) { return capturedPart(technique, f.face) == FacePart::nothing; });
  return faces;
}

Bounds boundsOfOwners(const Snapshot& snapshot, const Probe& probe) {
  Bounds bounds;
  for (const int owner : probe.owners) bounds.include(snapshot.instances[static_cast<std::size_t>(owner)].worldBounds);
  if (bounds.empty()) bounds.include(probe.position);
  return bounds;
}

std::vector<int> probesShownBy(const Technique& technique, const Snapshot& snapshot, int instance) {
  const Reflection reflection =
      reflectionOf(technique, snapshot, snapshot.instances[static_cast<std::size_t>(instance)]);
  std::vector<int> probes;
  for (const int probe : {reflection.probe, reflection.second})
    if (probe >= 0) probes.push_back(probe);
  return probes;
}

std::int64_t ageOf(const RefreshHistory& history, const ProbeFace& face) {
  if (neverCaptured(history, face)) return history.frame;
  return history.frame -
         history.lastCapturedFrame[static_cast<std::size_t>(face.probe)][static_cast<std::size_t>(face.face)];
}

SpecReader policyReader(const Spec& spec) { return {spec, "refresh '" + printSpec(spec) + "'"}; }

std::vector<ProbeFace> dueFaces(const Spec& policy, const RefreshHistory& history, const Snapshot& snapshot) {
  ByProbeAndFace<bool> chosen(snapshot.probes.size());
  for (const ProbeFace& f : refreshPolicy(policy).make(policy)(history, snapshot)) at(chosen, f) = true;
  std::vector<ProbeFace> due = capturedFaces(history.technique, snapshot);
  std::erase_if(due, [&](const ProbeFace& f) { return !at(chosen, f) && !neverCaptured(history, f); });
  return due;
}

void reorder(RefreshHistory& history, const std::vector<int>& before) {
  history.lastCapturedFrame = reordered(std::move(history.lastCapturedFrame), before, kNeverCaptured);
  history.contentAtCapture = reordered(std::move(history.contentAtCapture), before, {});
}

void advance(RefreshHistory& history, const std::vector<ProbeFace>& faces, const Snapshot& snapshot) {
  history.lastCapturedFrame.resize(snapshot.probes.size(), kNeverCaptured);
  history.contentAtCapture.resize(snapshot.probes.size());
  const ByProbeAndFace<FaceContent> contents = faceContents(history.technique, snapshot);
  for (const ProbeFace& f : faces) {
    at(history.lastCapturedFrame, f) = history.frame;
    at(history.contentAtCapture, f) =
        contents[static_cast<std::size_t>(f.probe)][static_cast<std::size_t>(f.face)].hash;
  }
  std::vector<std::uint64_t> instances = instanceHashes(snapshot);
  history.instances.resize(instances.size());
  history.lastChangedFrame.resize(instances.size());
  for (std::size_t i = 0; i < instances.size(); ++i)
    if (instances[i] != history.instances[i]) history.lastChangedFrame[i] = history.frame;
  history.instances = std::move(instances);
  ++history.frame;
}

const std::vector<RefreshPolicy>& refreshPolicies() {
  static const std::vector<RefreshPolicy> table = {
#define REFRESH_POLICY(function) function(),
#include "raster/refresh/policies.def"
#undef REFRESH_POLICY
  };
  return table;
}

const RefreshPolicy& refreshPolicy(const Spec& spec) {
  const auto found = std::ranges::find(refreshPolicies(), spec.name, &RefreshPolicy::name);
  if (found == refreshPolicies().end()) {
    std::vector<std::string> names;
    for (const RefreshPolicy& policy : refreshPolicies()) names.push_back(policy.name);
    throwInputError("refresh policy {}", unknownMessage(spec.name, names));
  }
  found->make(spec);  // refuses bad parameters
  return *found;
}

}  // namespace pb
