#include "bench/bounce_depth.h"

#include <algorithm>

#include "raster/probe_owners.h"
#include "raster/refraction.h"

namespace pb {
namespace {

constexpr int kMostHits = 1'000'000;  // deeper maps than anybody compares, but no overflow

std::size_t indexOf(int i) { return static_cast<std::size_t>(i); }

// Without what neither says which faces are captured nor what they see of each other.
Technique capturesOf(Technique technique) {
  const Technique defaults;
  technique.preset = defaults.preset;
  if (technique.resolutionScale == ResolutionScale::fixed) technique.resolution = defaults.resolution;
  technique.textureFilter = defaults.textureFilter;
  technique.filter = defaults.filter;
  technique.format = defaults.format;
  technique.storage = defaults.storage;
  technique.mips = defaults.mips;
  technique.seamless = defaults.seamless;
  return technique;
}

}  // namespace

int hitsBeforeMap(const Snapshot& snapshot, const std::vector<int>& owners) {
  const bool isCrossed = std::ranges::any_of(
      owners, [&](int owner) { return isSolidGlass(snapshot.materialOf(snapshot.instances[indexOf(owner)])); });
  return isCrossed ? 2 : 1;
}

BounceDepth::BounceDepth(const Technique& technique, int heightPx)
    : technique_(technique), layout_(technique), schedule_(technique, heightPx) {}

int BounceDepth::advance(const Snapshot& given) {
  const Snapshot& snapshot = layout_.apply(given);
  hits_.clear();
  for (const Probe& probe : snapshot.probes) hits_.push_back(hitsBeforeMap(snapshot, probe.owners));
  if (technique_.probes == ProbeUse::dynamic) {
    const std::vector<ProbeFace> due = schedule_.advance(snapshot);
    followProbes();
    depths_.resize(snapshot.probes.size());
    shown_ = isComplete_;
    shown_.resize(snapshot.probes.size(), false);
    if (technique_.feedback == Feedback::sky)
      for (const ProbeFace& f : due) shown_[indexOf(f.probe)] = false;
    for (int b = 0; b < technique_.bounces; ++b) capture(due);
    isComplete_.assign(snapshot.probes.size(), true);
  }
  int deepest = 1;
  for (std::size_t probe = 0; probe < hits_.size(); ++probe)
    deepest = std::max(deepest, hits_[probe] + mapDepth(probe));
  return deepest;
}

// Those with other owners than any in the frame before start anew.
void BounceDepth::followProbes() {
  const std::optional<std::vector<int>>& before = schedule_.probesBefore();
  if (!before) return;
  depths_ = reordered(std::move(depths_), *before, {});
  isComplete_ = reordered(std::move(isComplete_), *before, false);
}

// One iteration. Faces are ordered by probe.
void BounceDepth::capture(const std::vector<ProbeFace>& due) {
  if (technique_.bounceOrder == BounceOrder::simultaneous) return captureProbes(due);
  std::vector<ProbeFace> ofProbe;
  for (std::size_t i = 0; i < due.size(); ++i) {
    ofProbe.push_back(due[i]);
    if (i + 1 < due.size() && due[i + 1].probe == due[i].probe) continue;
    captureProbes(ofProbe);
    ofProbe.clear();
  }
}

// All of the faces see the same maps, and are seen afterwards.
void BounceDepth::captureProbes(const std::vector<ProbeFace>& faces) {
  std::vector<int> seen;
  for (const ProbeFace& f : faces) seen.push_back(depthSeenFrom(indexOf(f.probe)));
  for (std::size_t i = 0; i < faces.size(); ++i) {
    depths_[indexOf(faces[i].probe)][indexOf(faces[i].face)] = seen[i];
    shown_[indexOf(faces[i].probe)] = true;
  }
}

// A probe's own map is not seen in its captures, nor are its owners. Other specular surfaces may be, and show at least
// the environment.
int BounceDepth::depthSeenFrom(std::size_t probe) const {
  int depth = 1;
  for (std::size_t other = 0; other < hits_.size(); ++other)
    if (other != probe) depth = std::max(depth, hits_[other] + (shown_[other] ? mapDepth(other) : 0));
  return std::min(depth, kMostHits);
}

int BounceDepth::mapDepth(std::size_t probe) const {
  return probe < depths_.size() ? *std::ranges::max_element(depths_[probe]) : 0;
}

std::vector<std::vector<int>> bounceDepths(const std::vector<Technique>& techniques, int first, int last,
                                           const SnapshotOfFrame& snapshotOf, int heightPx) {
  std::vector<Technique> distinct;
  std::vector<std::size_t> distinctOf;
  for (const Technique& technique : techniques) {
    const Technique captures = capturesOf(technique);
    const auto found = std::ranges::find(distinct, captures);
    distinctOf.push_back(static_cast<std::size_t>(found - distinct.begin()));
    if (found == distinct.end()) distinct.push_back(captures);
  }
  std::vector<BounceDepth> followed;
  for (const Technique& technique : distinct) followed.emplace_back(technique, heightPx);
  std::vector<std::vector<int>> depths(distinct.size());
  for (int frame = first; frame <= last; ++frame) {
    const std::shared_ptr<const Snapshot> snapshot = snapshotOf(frame);
    for (std::size_t i = 0; i < distinct.size(); ++i) depths[i].push_back(followed[i].advance(*snapshot));
  }
  std::vector<std::vector<int>> result;
  for (const std::size_t i : distinctOf) result.push_back(depths[i]);
  return result;
}

}  // namespace pb
