#include "raster/refresh.h"

#include <xxhash.h>

#include <algorithm>

#include "raster/refresh/policies.h"
#include "scenes/error.h"

namespace pb {
namespace {

// Chains one value's bytes to a hash.
template <class T>
void mixIn(std::uint64_t& hash, const T& value) {
  hash = XXH3_64bits_withSeed(&value, sizeof value, hash);
}

bool owns(const Probe& probe, std::size_t instance) {
  return std::ranges::find(probe.owners, static_cast<int>(instance)) != probe.owners.end();
}

bool neverCaptured(const RefreshHistory& history, const ProbeFace& f) {
  const auto probe = static_cast<std::size_t>(f.probe);
  return probe >= history.lastCapturedFrame.size() ||
         history.lastCapturedFrame[probe][static_cast<std::size_t>(f.face)] < 0;
}

}  // namespace

std::uint64_t visibleContentHash(const Snapshot& snapshot, int probe) {
  const Probe& captured = snapshot.probes[static_cast<std::size_t>(probe)];
  std::uint64_t hash = 0;
  mixIn(hash, captured.position);
  mixIn(hash, captured.zNear);
  for (std::size_t i = 0; i < snapshot.instances.size(); ++i) {
    if (owns(captured, i)) continue;
    const SnapshotInstance& instance = snapshot.instances[i];
    mixIn(hash, i);
    mixIn(hash, instance.mesh->contentHash);
    mixIn(hash, instance.material);
    mixIn(hash, instance.worldFromObject);
  }
  for (const shading::Light& light : snapshot.lights) mixIn(hash, light);
  for (const shading::AreaLight& light : snapshot.areaLights) mixIn(hash, light);
  if (!snapshot.screens.empty()) mixIn(hash, snapshot.timeSeconds);
  mixIn(hash, snapshot.environmentIndex);
  mixIn(hash, snapshot.environment().sky);
  mixIn(hash, snapshot.environment().ambient);
  return hash;
}

std::vector<ProbeFace> allFaces(const Snapshot& snapshot) {
  std::vector<ProbeFace> faces;
  for (int probe = 0; probe < static_cast<int>(snapshot.probes.size()); ++probe)
    for (int face = 0; face < 6; ++face) faces.push_back({probe, face});
  return faces;
}

SpecReader policyReader(const Spec& spec) { return {spec, "refresh '" + printSpec(spec) + "'"}; }

std::vector<ProbeFace> dueFaces(const Spec& policy, const RefreshHistory& history, const Snapshot& snapshot) {
  std::vector<std::array<bool, 6>> chosen(snapshot.probes.size());
  for (const ProbeFace& f : refreshPolicy(policy).make(policy)(history, snapshot))
    chosen[static_cast<std::size_t>(f.probe)][static_cast<std::size_t>(f.face)] = true;
  std::vector<ProbeFace> due = allFaces(snapshot);
  std::erase_if(due, [&](const ProbeFace& f) {
    return !chosen[static_cast<std::size_t>(f.probe)][static_cast<std::size_t>(f.face)] && !neverCaptured(history, f);
  });
  return due;
}

void advance(RefreshHistory& history, const std::vector<ProbeFace>& faces, const Snapshot& snapshot) {
  constexpr std::array<std::int64_t, 6> kNever = {-1, -1, -1, -1, -1, -1};
  history.lastCapturedFrame.resize(snapshot.probes.size(), kNever);
  history.contentAtCapture.resize(snapshot.probes.size(), 0);
  int hashed = -1;
  for (const ProbeFace& f : faces) {
    const auto probe = static_cast<std::size_t>(f.probe);
    history.lastCapturedFrame[probe][static_cast<std::size_t>(f.face)] = history.frame;
    if (f.probe != hashed) history.contentAtCapture[probe] = visibleContentHash(snapshot, f.probe);
    hashed = f.probe;
  }
  ++history.frame;
}

const std::vector<RefreshPolicy>& refreshPolicies() {
  static const std::vector<RefreshPolicy> table = {everyFramePolicy(), everyNPolicy(), facesPolicy(), onChangePolicy(),
                                                   staticPolicy()};
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
