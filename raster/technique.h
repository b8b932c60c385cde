// All settings of the approximation together.
#pragma once

#include <glm/vec4.hpp>
#include <string>

#include "scenes/spec.h"

namespace pb {

enum class Feedback { previousFrame, sky };
enum class BounceOrder { sequential, simultaneous };
enum class TextureFilter { exact, hardware };
enum class Refraction { oneInterface, twoInterface, cubemapBackface, thickSlab };
enum class Dispersion { off, rgbOffset, perChannelIor };
enum class ProbeFilter { none, boxMips, ggxPrefiltered };
enum class GeometryTerm { smithCorrelated, one, smithK, cookTorrance };  // numbered as shading::kGeometry*
enum class Coats { nearestProbe, blendedProbes, environment, none };
enum class WithoutProbe { environment, nearestProbe, blendedProbes };
enum class CapturedFaces { all, noTopBottom, topHalf };
enum class Iterations { bruteForce, incremental };
enum class ResolutionScale { fixed, distance };
enum class ProbeFormat { rgba16f, r11fG11fB10f, rgb9e5, rgba8Srgb };
enum class Storage { cube, dualParaboloid, octahedral };
enum class Placement { stated, origin, boxCentre, centroid };
enum class SelfReflection { none, splitParts };
enum class ProbeUse {
  dynamic,
  environmentOnly,  // no captures, reflections show the environment (a plain frame)
  given             // no captures, RasterSequence::setProbe() says what the probes' maps show
};

struct Technique {
  std::string preset = "none";                  // what this began with, a name of bench/presets.h; no renderer reads it
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
  WithoutProbe withoutProbe = WithoutProbe::environment;  // what mirrors and glass without one of their own show
  int shadowResolution = 1024;  // texels along the edge of a shadow map's face, for scenes that cast shadows
  Spec lookup{"infinite", {}};  // from a point and a direction to a texel: see raster/lookup.h
  CapturedFaces faces = CapturedFaces::all;  // what is not captured shows the environment
  Iterations iterations = Iterations::bruteForce;
  ResolutionScale resolutionScale = ResolutionScale::fixed;
  ProbeFormat format = ProbeFormat::rgba16f;
  Storage storage = Storage::cube;
  bool mips = false;        // of level 0 for smooth lobes, by the width of the pixel's cone
  bool seamless = true;     // filtering across the edges of faces
  float hysteresis = 0.0f;  // share of a map's earlier content that a capture keeps, [0, 1)
  bool captureTextures = true;
  float captureLod = 1.0f;  // share of the triangles that captures draw, (0, 1]
  float captureFar = 0.0f;  // metres from a probe beyond which captures show the environment; 0: no such limit
  bool captureLights = true;
  Placement placement = Placement::stated;  // where probes stand; the value `explicit`
  Spec sharing{"none", {}};                 // none, distance?metres= or count?probes=
  SelfReflection selfReflection = SelfReflection::none;
  ProbeUse probes = ProbeUse::dynamic;

  friend bool operator==(const Technique&, const Technique&) = default;
};

// shading::kFresnel* with its parameters. Throws an input Error for a spec that is none.
glm::vec4 fresnelLaw(const Spec& fresnel);

}  // namespace pb
