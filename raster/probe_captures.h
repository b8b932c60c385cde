// The maps of a sequence's probes from frame to frame: what is captured, what is given instead, and what lookups read.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "raster/bounce_iterations.h"
#include "raster/frame_work.h"
#include "raster/probe_maps.h"
#include "raster/probe_owners.h"
#include "raster/refresh.h"
#include "raster/scene_pass.h"

namespace pb {

// What a probe's map shall show; see RasterSequence::setProbe().
struct GivenProbe {
  std::array<Image, 6> faces;
  std::array<Plane, 6> distances;  // empty ones: none given
};

class ProbeCaptures {
 public:
  // For images of so many pixels and samples. Everything must outlive it. Throws an input Error for a technique whose
  // probes don't fit the device.
  ProbeCaptures(RasterDevice::Impl& device, const Technique& technique, ScenePass& scenePass, int widthPx, int heightPx,
                int samplesPerAxis);

  // From the next frame on.
  void give(int probe, GivenProbe content);

  // Makes the maps what the frame wants of them, before ScenePass::beginFrame(): allocated, in their resolutions, with
  // what is given; decides which faces are due. The snapshot's probes are the technique's, and it lives until
  // endFrame(). Throws input Errors for maps that don't fit the device, and for given ones that don't fit the probes.
  void beginFrame(const Snapshot& snapshot);

  const std::vector<int>& resolutions() const { return resolutions_; }  // by probe, of this frame
  std::vector<gpu::PassConstants> passes() const;                       // by capturePass()
  void capture(FrameWork& work);                                        // what is due, and filters it
  ShownProbes shown() const;                                            // by passes of the frame that follow
  void endFrame();                                                      // counts the captures as done

  // Per probe and face: frames since its capture, at the frame that ended last; see FrameStats.
  std::vector<std::array<std::int64_t, 6>> faceAges() const;

  // Memory of the maps and of what fills them, for a technique whose captures are those of the last frame
  // (raster/equal_captures.h). The snapshot's probes are the technique's.
  std::int64_t bytesOf(const Technique& technique, const Snapshot& snapshot) const;
  // What capturing the last frame took, or had taken with so many bounce iterations, at most those that there were;
  // without memory.
  FrameCounters countersOf(int bounces) const;

  // As RasterSequence's.
  std::array<Image, 6> read(int probe, int level) const;
  std::array<Plane, 6> readDistances(int probe) const;

 private:
  bool hasMaps() const { return technique_.probes != ProbeUse::environmentOnly && areLookedUp_; }
  bool isCaptured() const { return technique_.probes == ProbeUse::dynamic && areLookedUp_; }
  void followProbes();
  void allocate();
  void resize();
  void showGiven();
  void checkGiven(std::size_t probe, const GivenProbe& content) const;
  std::vector<bool> mapsShownAtFirst() const;
  void prepare(FrameWork& work);
  void fillMissingFaces(FrameWork& work);
  void requireMap(int probe) const;

  RasterDevice::Impl& device_;
  const Technique technique_;
  ScenePass& scenePass_;
  const int widthPx_;
  const int heightPx_;
  const int samplesPerAxis_;
  std::optional<ProbeMaps> maps_;
  std::optional<BounceIterations> iterations_;
  RefreshHistory history_;
  std::map<int, GivenProbe> given_;  // for the next frame, by probe
  ProbeFollower probes_;
  std::vector<bool> isGiven_;        // by probe: its map, in its resolution
  std::vector<bool> isComplete_;     // by probe: its map has been captured
  std::vector<std::size_t> filled_;  // by probe: 1 + the environment that faces show which are never captured; 0: none
  std::vector<float> nears_;         // by probe, metres
  // Of this frame.
  const Snapshot* snapshot_ = nullptr;
  bool areLookedUp_ = true;  // maps, by anything
  std::vector<int> resolutions_;
  std::vector<ProbeFace> due_;
  std::vector<bool> shown_;                    // by probe: lookups read its map, not the environment
  std::vector<bool> levels_;                   // by probe: lookups read its filtered levels
  FrameCounters before_, after_;               // capture()
  std::vector<FrameCounters> afterIteration_;  // likewise
};

}  // namespace pb
