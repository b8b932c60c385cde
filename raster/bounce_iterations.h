// A frame's captures in their bounce iterations: brute force, which draws all due faces in each of them, or
// incremental, which draws them once and then repeats the lookups of what they show of other probes
// (raster/lookup_records.h).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "raster/capture_history.h"
#include "raster/frame_work.h"
#include "raster/lookup_records.h"
#include "raster/probe_maps.h"
#include "raster/scene_pass.h"

namespace pb {

// Brings the levels of the wanted probes up to date.
void filterLevels(ProbeMaps& maps, const std::vector<bool>& wanted, FrameWork& work);

class BounceIterations {
 public:
  // For that many probes, with the technique's largest resolution. Everything must outlive it.
  BounceIterations(RasterDevice::Impl& device, const Technique& technique, ScenePass& scenePass, ProbeMaps& maps,
                   int probes);

  // Captures the due faces, ordered by probe, in all iterations. shown, by probe: what lookups read (ShownProbes),
  // which grows as maps are published. levels, by probe: whether filtered levels are read; maps are filtered as soon as
  // they are published.
  void run(const std::vector<ProbeFace>& due, std::vector<bool>& shown, const std::vector<bool>& levels,
           FrameWork& work);

  // Follows probes that are numbered anew, of which there may be more or fewer; see probesBefore().
  void reorder(const std::vector<int>& before);

  // Of the records that it keeps.
  std::int64_t bytes() const { return records_ ? records_->bytes() : 0; }

 private:
  // What later bounce iterations have to do for a face's capture to be that of brute force.
  enum class Redo { nothing, lookups, everything };

  // Of one call of run().
  struct Run {
    std::vector<bool>& shown;
    const std::vector<bool>& levels;
    FrameWork& work;
    bool isLast = false;  // of the iterations
  };

  void makeRecords(std::size_t probes);
  void begin(const std::vector<ProbeFace>& due, std::size_t probes);
  void iterate(const std::vector<ProbeFace>& due, Run& run);
  void capture(const std::vector<ProbeFace>& faces, Run& run);
  std::vector<ProbeFace> facesTo(Redo what, const std::vector<ProbeFace>& faces) const;
  void drawProbe(const std::vector<ProbeFace>& faces, Run& run);
  std::vector<CaptureLookups> planProbe(const std::vector<ProbeFace>& faces, const Run& run);
  void publish(const std::vector<ProbeFace>& faces, Run& run);
  ShownProbes shownProbes(int hidden, const Run& run) const;
  Redo& redoOf(const ProbeFace& f) {
    return redo_[static_cast<std::size_t>(f.probe)][static_cast<std::size_t>(f.face)];
  }

  RasterDevice::Impl& device_;
  const Technique& technique_;
  ScenePass& scenePass_;
  ProbeMaps& maps_;
  std::optional<CaptureHistory> history_;  // with hysteresis
  std::optional<LookupRecords> records_;   // of techniques that repeat lookups
  std::vector<std::array<Redo, 6>> redo_;  // by probe
  std::vector<MapState> states_;           // by probe
};

}  // namespace pb
