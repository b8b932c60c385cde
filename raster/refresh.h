// Refresh policies: which (probe, face) pairs are captured in a frame. Pure functions, tested without GL.
//
// Adding one: a file in raster/refresh/ with a RefreshPolicy, and its line in raster/refresh/policies.def.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "raster/technique.h"
#include "scenes/snapshot.h"
#include "scenes/spec.h"

namespace pb {

struct ProbeFace {
  int probe;
  int face;
  friend bool operator==(const ProbeFace&, const ProbeFace&) = default;
};

template <class T>
using ByProbeAndFace = std::vector<std::array<T, 6>>;

// What has been captured so far. Frames count rendered frames of this sequence from 0.
struct RefreshHistory {
  Technique technique;                             // which says what captures show at all, and who shows them
  std::int64_t frame = 0;                          // the frame about to be rendered
  ByProbeAndFace<std::int64_t> lastCapturedFrame;  // -1 for never
  ByProbeAndFace<std::uint64_t> contentAtCapture;  // FaceContent::hash when last captured
  std::vector<std::uint64_t> instances;            // instanceHash() in the frame before
  std::vector<std::int64_t> lastChangedFrame;      // per instance: when that was last another one than before
};

// What a capture of a face shows.
struct FaceContent {
  // Of everything that the picture depends on, but for what other probes' maps show: position of the probe, the
  // instances that the face sees and which maps they show, lights, environment; in scenes that cast shadows, all
  // instances.
  std::uint64_t hash = 0;
  std::vector<int> instances;  // whose bounds the captured part of the face sees, in order
};
ByProbeAndFace<FaceContent> faceContents(const Technique& technique, const Snapshot& snapshot);

// Of an instance's shape, place, and the time that its screen shows.
std::uint64_t instanceHash(const Snapshot& snapshot, const SnapshotInstance& instance);

// Faces to capture in this frame, ordered by probe, then face. Every face of a probe that was never captured is due in
// any policy: a technique starts from complete maps, as engines do at load. Faces that the technique never captures are
// never due.
std::vector<ProbeFace> dueFaces(const Spec& policy, const RefreshHistory& history, const Snapshot& snapshot);

// Follows probes that are numbered anew; see probesBefore(). New ones were never captured.
void reorder(RefreshHistory& history, const std::vector<int>& before);

// Records the capture of `faces` and moves on to the next frame.
void advance(RefreshHistory& history, const std::vector<ProbeFace>& faces, const Snapshot& snapshot);

struct RefreshPolicy {
  std::string name;
  std::string parameters;   // for `axes info`: "n = frames between captures, 1 to 1000, default 4"
  std::string description;  // one sentence
  std::string source;       // who does it like that
  // Validates the parameters and makes the pure function; throws an input Error.
  using Function = std::function<std::vector<ProbeFace>(const RefreshHistory&, const Snapshot&)>;
  Function (*make)(const Spec&);
  // Frames after which the policy's work repeats, for that many faces in all that are ever captured (1 for
  // every-frame): what a cost measurement must cover.
  int (*cycle)(const Spec&, int faces);
};

const std::vector<RefreshPolicy>& refreshPolicies();

// Throws an input Error for an unknown policy or parameter.
const RefreshPolicy& refreshPolicy(const Spec& spec);

}  // namespace pb
