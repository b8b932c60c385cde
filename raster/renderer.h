// The approximation: a rasteriser with dynamic cube maps on OpenGL 4.5 core. Everything runs on the calling thread.
//
// Maps of probes may also come from elsewhere, an oracle's for example: with Technique::probes = ProbeUse::given
// nothing is captured; RasterSequence::setProbe() gives each probe its six faces, before the first frame and again
// whenever they change, and renderFrame() looks them up in the technique's format, storage and filtered levels. Where
// the probes of a technique stand, how many texels they want and what their captures leave out says probeViews() in
// raster/probe_views.h.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "raster/reflection.h"
#include "raster/refresh.h"
#include "raster/technique.h"
#include "scenes/image.h"
#include "scenes/snapshot.h"

namespace pb {

enum class GlBackend { osmesa, egl };

struct GlInfo {
  std::string backend;   // "osmesa" or "egl"
  std::string renderer;  // GL_RENDERER
  std::string vendor;
  std::string version;  // GL_VERSION, which names the driver's version
  bool software;        // llvmpipe, softpipe, swrast: frame time is wall time with glFinish
};

// Deterministic work of one frame.
struct FrameCounters {
  std::int64_t facesCaptured = 0;  // face renders, all bounce iterations, and mirrored views
  std::int64_t draws = 0;
  std::int64_t triangles = 0;   // of what is drawn, those included that are dropped unseen (raster/triangle_lists.h)
  std::int64_t fragments = 0;   // samples that passed the depth test; 0 unless counting was asked for
  std::int64_t probeBytes = 0;  // memory of the cube maps, of their filtered levels and of the filter, of the
                                // distances that lookups read, and of mirrored views
  std::int64_t texelsFiltered = 0;  // written by the filter of the cube maps, its own copies included

  FrameCounters& operator+=(const FrameCounters& other);  // probeBytes: the larger
  FrameCounters& operator-=(const FrameCounters& other);  // what came after `other`; probeBytes stays
  friend bool operator==(const FrameCounters&, const FrameCounters&) = default;
};

// Milliseconds by pass; wall time between glFinish calls on software GL, timer queries on a GPU.
struct PassTimes {
  std::vector<double> captureMs;  // by bounce iteration; mirrored views count to the last one
  double shadowMs = 0.0;          // shadow maps, drawn once a frame
  double prefilterMs = 0.0;       // all bounce iterations
  double finalMs = 0.0;
};

struct FrameStats {
  FrameCounters counters;
  std::vector<std::array<std::int64_t, 6>>
      faceAgeFrames;      // per probe and face: frames since its capture (0: this frame), -1 if it is never captured
  LookupSources coats;    // of instances without a probe of their own, in the final image
  LookupSources mirrors;  // the same of mirrors and glass
};

// A GL context with the compiled programs. Contexts of both backends may exist in one process.
class RasterDevice {
 public:
  // Throws an environment Error if the backend or OpenGL 4.5 core is not to be had.
  explicit RasterDevice(GlBackend backend);
  ~RasterDevice();
  RasterDevice(const RasterDevice&) = delete;
  RasterDevice& operator=(const RasterDevice&) = delete;

  const GlInfo& info() const;

  struct Impl;
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// A technique rendering a sequence of frames of one scene. Keeps its cube maps between frames. The device must outlive
// it.
class RasterSequence {
 public:
  // Throws the input Errors with which a sequence would refuse its first frame: settings that don't go together or
  // don't fit the scene, memory.
  static void check(RasterDevice& device, const Technique& technique, const Snapshot& snapshot, int widthPx,
                    int heightPx, int samplesPerAxis);

  // Throws an input Error when the probes would not fit the device (size of a cube map, memory).
  RasterSequence(RasterDevice& device, const Technique& technique, int widthPx, int heightPx, int samplesPerAxis);
  ~RasterSequence();
  RasterSequence(const RasterSequence&) = delete;
  RasterSequence& operator=(const RasterSequence&) = delete;

  // Renders the next frame of the sequence: due captures in their bounce iterations, then the final image. All
  // snapshots of a sequence must be of the same scene. The image stays on the device.
  FrameStats renderFrame(const Snapshot& snapshot, bool countFragments = false);

  // As renderFrame, with the time of each pass; slower than renderFrame because passes are kept apart.
  PassTimes renderFrameTimed(const Snapshot& snapshot);

  // Blocks until the device is idle.
  void finish();

  // The last frame: S x S samples averaged in fixed order, linear Rec.709, row 0 on top.
  Image readImage();

  // What each primary sample of the snapshot shows: (width * S) x (height * S), row 0 on top.
  Grid<SampleId> renderIds(const Snapshot& snapshot);

  // The map of a probe (index into probeViews().probes), looked up from the next frame on, for ProbeUse::given. faces:
  // GL order, row 0 first in memory, linear radiance, as readProbe() returns them, of the probe's number of texels.
  // distances, for lookups that read them: of what the faces show, metres along the axis of the face (not along the
  // ray), at least the probe's zNear, infinity where nothing is. Throws an input Error unless the probes are given; the
  // next frame throws one for a probe that isn't there, for faces or distances of another size, and for a map that is
  // missing.
  void setProbe(int probe, const std::array<Image, 6>& faces, const std::array<Plane, 6>& distances = {});

  // The six faces of a level of a probe's cube map as they are now, GL order, row 0 first in memory.
  std::array<Image, 6> readProbe(int probe, int level = 0);
  // The distances of the same, as given to setProbe(). Throws an input Error if the technique's lookup reads none.
  std::array<Plane, 6> readProbeDistances(int probe);

  struct Impl;
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace pb
