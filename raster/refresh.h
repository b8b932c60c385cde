// Refresh policies: which (probe, face) pairs are captured in a frame. Pure functions, tested without GL.
//
// Adding one: a file in raster/refresh/ with a RefreshPolicy, and a line in the table of refresh.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenes/snapshot.h"
#include "scenes/spec.h"

namespace pb {

struct ProbeFace {
  int probe;
  int face;
  friend bool operator==(const ProbeFace&, const ProbeFace&) = default;
};

// What has been captured so far. Frames count rendered frames of this sequence from 0.
struct RefreshHistory {
  std::int64_t frame = 0;                                      // the frame about to be rendered
  std::vector<std::array<std::int64_t, 6>> lastCapturedFrame;  // per probe and face, -1 for never
  std::vector<std::uint64_t> contentAtCapture;                 // per probe: visibleContentHash() when last captured
};

// Hash of everything a probe's capture depends on: all instances but its owners, its position, lights, the
// time that screens show, environment.
std::uint64_t visibleContentHash(const Snapshot& snapshot, int probe);

// Faces to capture in this frame, ordered by probe, then face. Every face of a probe that was never captured is due in
// any policy: a technique starts from complete maps, as engines do at load.
std::vector<ProbeFace> dueFaces(const Spec& policy, const RefreshHistory& history, const Snapshot& snapshot);

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
  // Frames after which the policy's work repeats, for `probes` probes (1 for every-frame): what a cost measurement must
  // cover.
  int (*cycle)(const Spec&, int probes);
};

const std::vector<RefreshPolicy>& refreshPolicies();

// Throws an input Error for an unknown policy or parameter.
const RefreshPolicy& refreshPolicy(const Spec& spec);

}  // namespace pb
