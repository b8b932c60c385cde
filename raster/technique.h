// All settings of the approximation together.
#pragma once

#include "scenes/spec.h"

namespace pb {

enum class Feedback { previousFrame, sky };
enum class BounceOrder { sequential, simultaneous };
enum class TextureFilter { exact, hardware };
enum class ProbeUse {
  dynamic,
  environmentOnly
};  // environmentOnly: no captures, reflections show the environment (a plain frame)

struct Technique {
  int resolution = 256;                         // texels along a cube face's edge
  Spec refresh{"every-frame", {}};              // see raster/refresh.h
  int bounces = 1;                              // bounce iterations a frame, B
  Feedback feedback = Feedback::previousFrame;  // what a due probe shows before its first capture of the frame
  BounceOrder bounceOrder = BounceOrder::sequential;
  TextureFilter textureFilter = TextureFilter::exact;
  ProbeUse probes = ProbeUse::dynamic;

  friend bool operator==(const Technique&, const Technique&) = default;
};

}  // namespace pb
