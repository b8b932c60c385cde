// All settings of the approximation together.
#pragma once

#include <glm/vec4.hpp>

#include "scenes/spec.h"

namespace pb {

enum class Feedback { previousFrame, sky };
enum class BounceOrder { sequential, simultaneous };
enum class TextureFilter { exact, hardware };
enum class Refraction { oneInterface, twoInterface, cubemapBackface, thickSlab };
enum class Dispersion { off, rgbOffset, perChannelIor };
enum class ProbeFilter { none, boxMips, ggxPrefiltered };
enum class GeometryTerm { smithCorrelated, one, smithK, cookTorrance };  // numbered as shading::kGeometry*
enum class Coats { nearestProbe, environment, none };
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
  Refraction refraction = Refraction::oneInterface;
  Spec fresnel{"exact", {}};  // exact, schlick or ratio?bias=&scale=&power=
  Dispersion dispersion = Dispersion::perChannelIor;
  ProbeFilter filter = ProbeFilter::ggxPrefiltered;
  GeometryTerm geometryTerm = GeometryTerm::smithCorrelated;
  Coats coats = Coats::nearestProbe;  // what dielectric coats of surfaces without a probe of their own reflect
  int shadowResolution = 1024;        // texels along the edge of a shadow map's face, for scenes that cast shadows
  ProbeUse probes = ProbeUse::dynamic;

  friend bool operator==(const Technique&, const Technique&) = default;
};

// shading::kFresnel* with its parameters. Throws an input Error for a spec that is none.
glm::vec4 fresnelLaw(const Spec& fresnel);

}  // namespace pb
