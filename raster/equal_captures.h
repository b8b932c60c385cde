// Which techniques have equal captures, so that what is captured for one of them can be shown by all: pure.
//
// A lookup, a law of Fresnel or a refraction changes the final image, and it changes captures only as far as these show
// surfaces that it acts on. A technique without what never acts in the captures of a sequence is their key: sequences
// with equal keys have equal captures, in every bit.
#pragma once

#include <vector>

#include "raster/probe_layout.h"
#include "raster/scheduled_faces.h"
#include "raster/technique.h"
#include "scenes/snapshot.h"

namespace pb {

struct CaptureKey {
  // What acts on captures; the rest stands at its default. Of captures that show no probe's map, `bounces` is 1: all
  // iterations of a frame capture the same.
  Technique technique;
  std::vector<std::vector<ProbeFace>> due;  // by frame: what `refresh` comes to

  friend bool operator==(const CaptureKey&, const CaptureKey&) = default;
};

// Cubes that are captured, without mirrored views. Not of scenes with blended surfaces: for want of room their layers
// are drawn twice at times, and then what was drawn before shows in the count of fragments. Nor where the final image
// has large targets of its own, of which each technique would hold a set: shadow maps, in scenes that cast shadows, and
// the back faces that two-interface refraction reads.
bool mayShareCaptures(const Technique& technique, const Scene& scene);

// What the captures of a sequence have that settings of a technique act on.
struct CapturedSurfaces {
  bool showMaps = false;     // of other probes than their own
  bool areSpecular = false;  // anything that reflects or refracts
  bool areRough = false;     // of lobes wider than a mirror's
  bool refract = false;      // glass with a volume behind it
  bool disperse = false;

  CapturedSurfaces& operator|=(const CapturedSurfaces& other);
};
// Of one frame, whose probes are the technique's. Every surface whose bounds a face sees counts, hidden or not.
CapturedSurfaces capturedSurfaces(const Technique& technique, const Snapshot& snapshot);

// Makes the key of a technique that may share captures, from the frames of a sequence in order.
class CaptureKeyMaker {
 public:
  // heightPx: of the image; see ScheduledFaces.
  CaptureKeyMaker(const Technique& technique, int heightPx);

  void advance(const Snapshot& snapshot);
  CaptureKey key() const;

 private:
  Technique technique_;
  ProbeLayout layout_;
  ScheduledFaces schedule_;
  std::vector<std::vector<ProbeFace>> due_;
  CapturedSurfaces surfaces_;
  // Of all frames.
  ProbeFilter levels_ = ProbeFilter::none;  // that maps have
  bool haveCoatsWithoutProbe_ = false;
  bool haveMirrorsWithoutProbe_ = false;  // or glass
};

}  // namespace pb
