// The table of axes and the parsers of values that are no mere choice of a name.
#include <fmt/ranges.h>

#include <bit>
#include <optional>

#include "bench/axes.h"
#include "bench/axis_choices.h"
#include "bench/presets.h"
#include "raster/lookup.h"
#include "raster/probe_layout.h"
#include "raster/refresh.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr int kMinResolution = 8;     // below, the bilinear footprint is wider than a tenth of a face
constexpr int kMaxResolution = 4096;  // 768 MiB a probe in RGBA16F
constexpr int kMaxBounces = 16;

bool parseIntegerIn(std::string_view text, int minimum, int maximum, int& target) {
  const std::optional<long long> value = parseInteger(text);
  if (!value || *value < minimum || *value > maximum) return false;
  target = static_cast<int>(*value);
  return true;
}

bool parseResolution(std::string_view text, int& target) {
  int value = 0;
  if (!parseIntegerIn(text, kMinResolution, kMaxResolution, value) ||
      !std::has_single_bit(static_cast<unsigned>(value)))
    return false;
  target = value;
  return true;
}

// Refuses unknown policies and parameters with the policy's own message.
bool parseRefresh(std::string_view text, Technique& technique) {
  const Spec spec = parseSpec(text);
  refreshPolicy(spec).make(spec);
  technique.refresh = spec;
  return true;
}

bool parseNumberIn(std::string_view text, double minimum, double maximum, float& target) {
  const std::optional<double> value = parseNumber(text);
  if (!value || *value < minimum || *value > maximum) return false;
  target = static_cast<float>(*value);
  return true;
}

// Refuses unknown lookups and parameters with the lookup's own message.
bool parseLookup(std::string_view text, Technique& technique) {
  const Spec spec = parseSpec(text);
  checkLookup(spec);
  technique.lookup = spec;
  return true;
}

// Refuses unknown kinds of sharing and parameters with their own message.
bool parseSharing(std::string_view text, Technique& technique) {
  const Spec spec = parseSpec(text);
  checkSharing(spec);
  technique.sharing = spec;
  return true;
}

// A whole technique: takes the place of all that was set before.
bool parsePreset(std::string_view text, Technique& technique) {
  const Technique* preset = presetTechnique(text);
  if (text != "none" && preset == nullptr) return false;
  technique = preset == nullptr ? Technique() : *preset;
  return true;
}

// Refuses unknown laws and parameters with the law's own message.
bool parseFresnel(std::string_view text, Technique& technique) {
  const Spec spec = parseSpec(text);
  fresnelLaw(spec);
  technique.fresnel = spec;
  return true;
}

// In the order of their table.
template <class Entry>
std::vector<std::string> namesOf(const std::vector<Entry>& table) {
  std::vector<std::string> names;
  for (const Entry& entry : table) names.push_back(entry.name);
  return names;
}

std::vector<std::string> presetNames() {
  std::vector<std::string> names = namesOf(presets());
  names.insert(names.begin(), "none");
  return names;
}

std::string listed(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, " | ")); }

std::vector<Axis> makeAxisTable() {
  return {
      {"preset", listed(presetNames()), "a whole technique: sets every axis, those named with it come after",
       "see `probebench axes info preset`", parsePreset, [](const Technique& t) { return t.preset; }, presetNames()},
      {"resolution", fmt::format("powers of two from {} to {}", kMinResolution, kMaxResolution),
       "texels along the edge of a cube map's face", "GTA V captures at 128",
       [](std::string_view text, Technique& t) { return parseResolution(text, t.resolution); },
       [](const Technique& t) { return std::to_string(t.resolution); }},
      {"refresh", listed(namesOf(refreshPolicies())), "which faces of which probes are captured in a frame",
       "engines: Unity's realtime probes (every frame, on awake, time slicing), Unreal's scene captures", parseRefresh,
       [](const Technique& t) { return printSpec(t.refresh); }, namesOf(refreshPolicies())},
      {"bounces", fmt::format("integers from 1 to {}", kMaxBounces),
       "times per frame that all due faces are captured in turn: each pass adds one reflection of a reflection",
       "student work and course documents on mutually reflecting objects",
       [](std::string_view text, Technique& t) { return parseIntegerIn(text, 1, kMaxBounces, t.bounces); },
       [](const Technique& t) { return std::to_string(t.bounces); }},
      choiceAxis<&Technique::feedback, kFeedbacks>(
          "feedback", "what a capture sees of probes that were not yet captured in this frame",
          "previous-frame: engines, reflections of reflections for free; sky: the first frame of any engine"),
      choiceAxis<&Technique::bounceOrder, kBounceOrders>(
          "bounce_order",
          "sequential: each capture sees the newest maps; simultaneous: those of the previous iteration",
          "sequential: three.js; simultaneous: radiosity's Jacobi iteration"),
      choiceAxis<&Technique::textureFilter, kTextureFilters>(
          "texture_filter",
          "exact: texture filtering as the reference computes it; hardware: the driver's own samplers",
          "hardware: every engine"),
      choiceAxis<&Technique::refraction, kRefractions>(
          "refraction", "where a ray that enters a transmitting object leaves it, and in which direction",
          "one-interface: course documents; two-interface: Wyman 2005; thick-slab: glTF viewers"),
      {"fresnel",
       "exact | schlick | ratio?bias=B&scale=S&power=P",
       "reflectance of interfaces by angle",
       "schlick: every engine; ratio: bias + scale (1 - cos)^power, course documents",
       parseFresnel,
       [](const Technique& t) { return printSpec(t.fresnel); },
       {"exact", "schlick", "ratio"}},
      choiceAxis<&Technique::dispersion, kDispersions>("dispersion", "how refracted colours part",
                                                       "rgb-offset: course documents; per-channel-ior: glTF viewers"),
      choiceAxis<&Technique::filter, kProbeFilters>(
          "filter", "what rough surfaces look up in their probe",
          "box-mips: glGenerateMipmap; ggx-prefiltered: the split sum of Karis 2013"),
      choiceAxis<&Technique::geometryTerm, kGeometryTerms>("geometry_term", "masking and shadowing of microfacets",
                                                           "smith-k: Unreal Engine 4; cook-torrance: course documents"),
      choiceAxis<&Technique::coats, kCoats>("coats",
                                            "what dielectric coats of objects without a probe of their own reflect",
                                            "nearest-probe: every engine"),
      choiceAxis<&Technique::withoutProbe, kWithoutProbe>(
          "without_probe", "what mirrors and glass without a probe of their own show",
          "nearest-probe: Unity's 'Simple', blended-probes: its 'Blend Probes'; environment: its 'Off'"),
      {"shadow_resolution", fmt::format("powers of two from {} to {}", kMinResolution, kMaxResolution),
       "texels along the edge of a shadow map's face, in scenes that cast shadows", "every engine: 512 to 4096",
       [](std::string_view text, Technique& t) { return parseResolution(text, t.shadowResolution); },
       [](const Technique& t) { return std::to_string(t.shadowResolution); }},
      {"lookup", listed(namesOf(lookups())), "which texel a point sees in a direction",
       "infinite: every textbook; box-proxy: Lagarde and Zanuttini 2012; distance-impostor: Szirmay-Kalos et al. 2005",
       parseLookup, [](const Technique& t) { return printSpec(t.lookup); }, namesOf(lookups())},
      choiceAxis<&Technique::faces, kCapturedFaces>(
          "faces", "which parts of a cube are captured; the environment fills the rest", "top-half: GTA V"),
      choiceAxis<&Technique::iterations, kIterations>(
          "iterations",
          "what bounce iterations after the first draw: everything again, or only what shows other probes",
          "brute-force: course documents"),
      choiceAxis<&Technique::resolutionScale, kResolutionScales>(
          "resolution_scale", "whether probes farther from the camera have fewer texels than `resolution`",
          "engines: reflection quality by distance"),
      choiceAxis<&Technique::format, kProbeFormats>(
          "format", "texels of cube maps",
          "rgba16f: Unity, Unreal; r11f-g11f-b10f: GTA V; rgba8-srgb: course documents"),
      choiceAxis<&Technique::storage, kStorages>("storage", "what a captured cube is converted to for lookups",
                                                 "dual-paraboloid: GTA V"),
      choiceAxis<&Technique::mips, kOffOn>(
          "mips", "whether smooth surfaces read mipmaps where they show a map smaller than it is",
          "on: course documents"),
      choiceAxis<&Technique::seamless, kOnOff>("seamless", "whether texels are filtered across the edges of faces",
                                               "off: hardware before OpenGL 3.2"),
      {"hysteresis", "numbers from 0 to 0.99", "share of its earlier content that a map keeps when it is captured",
       "engines: temporal blending of probes",
       [](std::string_view text, Technique& t) { return parseNumberIn(text, 0.0, 0.99, t.hysteresis); },
       [](const Technique& t) { return fmt::format("{:g}", t.hysteresis); }},
      choiceAxis<&Technique::captureTextures, kOnOff>(
          "capture_textures", "whether captures read the textures of surfaces", "wished for in course documents"),
      {"capture_lod", "numbers from 0.01 to 1", "share of their triangles that meshes have in captures",
       "GTA V: low levels of detail in reflections",
       [](std::string_view text, Technique& t) { return parseNumberIn(text, 0.01, 1.0, t.captureLod); },
       [](const Technique& t) { return fmt::format("{:g}", t.captureLod); }},
      {"capture_far", "numbers from 0 to 1e9",
       "metres from a probe beyond which captures show the environment; 0: everywhere",
       "engines: clip planes of reflection probes",
       [](std::string_view text, Technique& t) { return parseNumberIn(text, 0.0, 1e9, t.captureFar); },
       [](const Technique& t) { return fmt::format("{:g}", t.captureFar); }},
      choiceAxis<&Technique::captureLights, kOnOff>("capture_lights", "whether captures show light of lights",
                                                    "engines: lights left out of reflections"),
      choiceAxis<&Technique::placement, kPlacements>(
          "placement",
          "where probes stand; explicit: where the scene says, else the centre of the box around the owner",
          "origin: engines' scripts; box-centre: Unity's gizmo"),
      {"sharing",
       "none | distance?metres=D | count?probes=N",
       "which neighbours share one probe",
       "course documents; engines: hand-placed probes serve many objects",
       parseSharing,
       [](const Technique& t) { return printSpec(t.sharing); },
       {"none", "distance", "count"}},
      choiceAxis<&Technique::selfReflection, kSelfReflections>(
          "self_reflection", "split-parts: each connected part of a mesh has a probe of its own", "course documents"),
  };
}

}  // namespace

const std::vector<Axis>& axisTable() {
  static const std::vector<Axis> table = makeAxisTable();
  return table;
}

}  // namespace pb
