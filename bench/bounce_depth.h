// How many bounces a technique shows: which truncated truth its frames are matched to. Pure; why it is so:
// docs/results.md, "Bounces".
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "raster/probe_layout.h"
#include "raster/scheduled_faces.h"
#include "raster/technique.h"
#include "scenes/snapshot.h"

namespace pb {

// Beyond so many hits a truncated truth is taken for the converged one: mirrors that reflect 90 % have 0.1 % left.
inline constexpr int kMaxMatchedDepth = 64;

// Hits of light on the owners of a probe before their map is seen: 2 of solid glass, which is looked through, in and
// out.
int hitsBeforeMap(const Snapshot& snapshot, const std::vector<int>& owners);

// Follows the captures of a sequence. A map is as deep as the specular hits on the longest path that it shows before
// the environment: one more than the deepest of the other maps that its capture saw. Where maps are of several depths
// (orders, faces of several ages), the deepest counts.
class BounceDepth {
 public:
  // heightPx: of the image, which decides when probes of Technique::resolutionScale change their resolution.
  BounceDepth(const Technique& technique, int heightPx);

  // Goes on to the next frame of the sequence. Returns the number of hits after which the truth that matches this
  // frame's image shows the environment, at least 1.
  int advance(const Snapshot& snapshot);

 private:
  void followProbes();
  void capture(const std::vector<ProbeFace>& due);
  void captureProbes(const std::vector<ProbeFace>& faces);
  int depthSeenFrom(std::size_t probe) const;
  int mapDepth(std::size_t probe) const;

  Technique technique_;
  ProbeLayout layout_;
  ScheduledFaces schedule_;
  std::vector<int> hits_;         // by probe: hitsBeforeMap()
  std::vector<bool> isComplete_;  // by probe: its map was captured in an earlier frame
  std::vector<bool> shown_;       // by probe: whether lookups see its map
  ByProbeAndFace<int> depths_;    // of what the maps hold
};

// advance() of the frames `first` to `last` for each of the techniques: [technique][frame - first]. Techniques that
// capture alike share the work.
using SnapshotOfFrame = std::function<std::shared_ptr<const Snapshot>(int)>;
std::vector<std::vector<int>> bounceDepths(const std::vector<Technique>& techniques, int first, int last,
                                           const SnapshotOfFrame& snapshotOf, int heightPx);

}  // namespace pb
