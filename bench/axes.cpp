#include "bench/axes.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "bench/presets.h"
#include "raster/lookup.h"
#include "raster/probe_layout.h"
#include "raster/refresh.h"
#include "scenes/error.h"
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

template <class Enum>
struct Choice {
  std::string_view name;
  Enum value;
};

constexpr Choice<Feedback> kFeedbacks[] = {{"previous-frame", Feedback::previousFrame}, {"sky", Feedback::sky}};
constexpr Choice<BounceOrder> kBounceOrders[] = {{"sequential", BounceOrder::sequential},
                                                 {"simultaneous", BounceOrder::simultaneous}};
constexpr Choice<TextureFilter> kTextureFilters[] = {{"exact", TextureFilter::exact},
                                                     {"hardware", TextureFilter::hardware}};

constexpr Choice<Refraction> kRefractions[] = {{"one-interface", Refraction::oneInterface},
                                               {"two-interface", Refraction::twoInterface},
                                               {"cubemap-backface", Refraction::cubemapBackface},
                                               {"thick-slab", Refraction::thickSlab}};
constexpr Choice<Dispersion> kDispersions[] = {
    {"off", Dispersion::off}, {"rgb-offset", Dispersion::rgbOffset}, {"per-channel-ior", Dispersion::perChannelIor}};
constexpr Choice<ProbeFilter> kProbeFilters[] = {
    {"none", ProbeFilter::none}, {"box-mips", ProbeFilter::boxMips}, {"ggx-prefiltered", ProbeFilter::ggxPrefiltered}};
constexpr Choice<GeometryTerm> kGeometryTerms[] = {{"smith-correlated", GeometryTerm::smithCorrelated},
                                                   {"one", GeometryTerm::one},
                                                   {"smith-k", GeometryTerm::smithK},
                                                   {"cook-torrance", GeometryTerm::cookTorrance}};
constexpr Choice<Coats> kCoats[] = {{"nearest-probe", Coats::nearestProbe},
                                    {"blended-probes", Coats::blendedProbes},
                                    {"environment", Coats::environment},
                                    {"none", Coats::none}};
constexpr Choice<WithoutProbe> kWithoutProbe[] = {{"environment", WithoutProbe::environment},
                                                  {"nearest-probe", WithoutProbe::nearestProbe},
                                                  {"blended-probes", WithoutProbe::blendedProbes}};
constexpr Choice<CapturedFaces> kCapturedFaces[] = {
    {"all", CapturedFaces::all}, {"no-top-bottom", CapturedFaces::noTopBottom}, {"top-half", CapturedFaces::topHalf}};
constexpr Choice<Iterations> kIterations[] = {{"brute-force", Iterations::bruteForce},
                                              {"incremental", Iterations::incremental}};
constexpr Choice<ResolutionScale> kResolutionScales[] = {{"fixed", ResolutionScale::fixed},
                                                         {"distance", ResolutionScale::distance}};
constexpr Choice<ProbeFormat> kProbeFormats[] = {{"rgba16f", ProbeFormat::rgba16f},
                                                 {"r11f-g11f-b10f", ProbeFormat::r11fG11fB10f},
                                                 {"rgb9e5", ProbeFormat::rgb9e5},
                                                 {"rgba8-srgb", ProbeFormat::rgba8Srgb}};
constexpr Choice<Storage> kStorages[] = {
    {"cube", Storage::cube}, {"dual-paraboloid", Storage::dualParaboloid}, {"octahedral", Storage::octahedral}};
constexpr Choice<Placement> kPlacements[] = {{"explicit", Placement::stated},
                                             {"origin", Placement::origin},
                                             {"box-centre", Placement::boxCentre},
                                             {"centroid", Placement::centroid}};
constexpr Choice<SelfReflection> kSelfReflections[] = {{"none", SelfReflection::none},
                                                       {"split-parts", SelfReflection::splitParts}};
constexpr Choice<bool> kSwitches[] = {{"on", true}, {"off", false}};

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

std::string presetNames() {
  std::string names = "none";
  for (const Preset& preset : presets()) names += " | " + preset.name;
  return names;
}

// Refuses unknown laws and parameters with the law's own message.
bool parseFresnel(std::string_view text, Technique& technique) {
  const Spec spec = parseSpec(text);
  fresnelLaw(spec);
  technique.fresnel = spec;
  return true;
}

// Parser and printer of a member that is one of a few named values.
template <auto Member, const auto& Choices>
bool parseChoice(std::string_view text, Technique& technique) {
  const auto* found = std::ranges::find_if(Choices, [&](const auto& choice) { return choice.name == text; });
  if (found == std::end(Choices)) return false;
  technique.*Member = found->value;
  return true;
}

template <auto Member, const auto& Choices>
std::string printChoice(const Technique& technique) {
  return std::string(
      std::ranges::find_if(Choices, [&](const auto& choice) { return choice.value == technique.*Member; })->name);
}

std::string refreshNames() {
  std::string names;
  for (const RefreshPolicy& policy : refreshPolicies()) names += (names.empty() ? "" : " | ") + policy.name;
  return names;
}

std::string lookupNames() {
  std::string names;
  for (const Lookup& lookup : lookups()) names += (names.empty() ? "" : " | ") + lookup.name;
  return names;
}

std::vector<std::string> axisNames() {
  std::vector<std::string> names;
  for (const Axis& axis : axisTable()) names.push_back(axis.name);
  return names;
}

std::vector<Axis> makeAxisTable() {
  return {
      {"preset", presetNames(), "a whole technique: sets every axis, those named with it come after",
       "see `probebench axes info preset`", parsePreset, [](const Technique& t) { return t.preset; }},
      {"resolution", fmt::format("powers of two from {} to {}", kMinResolution, kMaxResolution),
       "texels along the edge of a cube map's face", "GTA V captures at 128",
       [](std::string_view text, Technique& t) { return parseResolution(text, t.resolution); },
       [](const Technique& t) { return std::to_string(t.resolution); }},
      {"refresh", refreshNames(), "which faces of which probes are captured in a frame",
       "engines: Unity's realtime probes (every frame, on awake, time slicing), Unreal's scene captures", parseRefresh,
       [](const Technique& t) { return printSpec(t.refresh); }},
      {"bounces", fmt::format("integers from 1 to {}", kMaxBounces),
       "times per frame that all due faces are captured in turn: each pass adds one reflection of a reflection",
       "student work and course documents on mutually reflecting objects",
       [](std::string_view text, Technique& t) { return parseIntegerIn(text, 1, kMaxBounces, t.bounces); },
       [](const Technique& t) { return std::to_string(t.bounces); }},
      {"feedback", "previous-frame | sky", "what a capture sees of probes that were not yet captured in this frame",
       "previous-frame: engines, reflections of reflections for free; sky: the first frame of any engine",
       parseChoice<&Technique::feedback, kFeedbacks>, printChoice<&Technique::feedback, kFeedbacks>},
      {"bounce_order", "sequential | simultaneous",
       "sequential: each capture sees the newest maps; simultaneous: those of the previous iteration",
       "sequential: three.js; simultaneous: radiosity's Jacobi iteration",
       parseChoice<&Technique::bounceOrder, kBounceOrders>, printChoice<&Technique::bounceOrder, kBounceOrders>},
      {"texture_filter", "exact | hardware",
       "exact: texture filtering as the reference computes it; hardware: the driver's own samplers",
       "hardware: every engine", parseChoice<&Technique::textureFilter, kTextureFilters>,
       printChoice<&Technique::textureFilter, kTextureFilters>},
      {"refraction", "one-interface | two-interface | cubemap-backface | thick-slab",
       "where a ray that enters a transmitting object leaves it, and in which direction",
       "one-interface: course documents; two-interface: Wyman 2005; thick-slab: glTF viewers",
       parseChoice<&Technique::refraction, kRefractions>, printChoice<&Technique::refraction, kRefractions>},
      {"fresnel", "exact | schlick | ratio?bias=B&scale=S&power=P", "reflectance of interfaces by angle",
       "schlick: every engine; ratio: bias + scale (1 - cos)^power, course documents", parseFresnel,
       [](const Technique& t) { return printSpec(t.fresnel); }},
      {"dispersion", "off | rgb-offset | per-channel-ior", "how refracted colours part",
       "rgb-offset: course documents; per-channel-ior: glTF viewers", parseChoice<&Technique::dispersion, kDispersions>,
       printChoice<&Technique::dispersion, kDispersions>},
      {"filter", "none | box-mips | ggx-prefiltered", "what rough surfaces look up in their probe",
       "box-mips: glGenerateMipmap; ggx-prefiltered: the split sum of Karis 2013",
       parseChoice<&Technique::filter, kProbeFilters>, printChoice<&Technique::filter, kProbeFilters>},
      {"geometry_term", "smith-correlated | one | smith-k | cook-torrance", "masking and shadowing of microfacets",
       "smith-k: Unreal Engine 4; cook-torrance: course documents",
       parseChoice<&Technique::geometryTerm, kGeometryTerms>, printChoice<&Technique::geometryTerm, kGeometryTerms>},
      {"coats", "nearest-probe | blended-probes | environment | none",
       "what dielectric coats of objects without a probe of their own reflect", "nearest-probe: every engine",
       parseChoice<&Technique::coats, kCoats>, printChoice<&Technique::coats, kCoats>},
      {"without_probe", "environment | nearest-probe | blended-probes",
       "what mirrors and glass without a probe of their own show",
       "nearest-probe: Unity's 'Simple', blended-probes: its 'Blend Probes'; environment: its 'Off'",
       parseChoice<&Technique::withoutProbe, kWithoutProbe>, printChoice<&Technique::withoutProbe, kWithoutProbe>},
      {"shadow_resolution", fmt::format("powers of two from {} to {}", kMinResolution, kMaxResolution),
       "texels along the edge of a shadow map's face, in scenes that cast shadows", "every engine: 512 to 4096",
       [](std::string_view text, Technique& t) { return parseResolution(text, t.shadowResolution); },
       [](const Technique& t) { return std::to_string(t.shadowResolution); }},
      {"lookup", lookupNames(), "which texel a point sees in a direction",
       "infinite: every textbook; box-proxy: Lagarde and Zanuttini 2012; distance-impostor: Szirmay-Kalos et al. 2005",
       parseLookup, [](const Technique& t) { return printSpec(t.lookup); }},
      {"faces", "all | no-top-bottom | top-half", "which parts of a cube are captured; the environment fills the rest",
       "top-half: GTA V", parseChoice<&Technique::faces, kCapturedFaces>,
       printChoice<&Technique::faces, kCapturedFaces>},
      {"iterations", "brute-force | incremental",
       "what bounce iterations after the first draw: everything again, or only what shows other probes",
       "brute-force: course documents", parseChoice<&Technique::iterations, kIterations>,
       printChoice<&Technique::iterations, kIterations>},
      {"resolution_scale", "fixed | distance",
       "whether probes farther from the camera have fewer texels than `resolution`",
       "engines: reflection quality by distance", parseChoice<&Technique::resolutionScale, kResolutionScales>,
       printChoice<&Technique::resolutionScale, kResolutionScales>},
      {"format", "rgba16f | r11f-g11f-b10f | rgb9e5 | rgba8-srgb", "texels of cube maps",
       "rgba16f: Unity, Unreal; r11f-g11f-b10f: GTA V; rgba8-srgb: course documents",
       parseChoice<&Technique::format, kProbeFormats>, printChoice<&Technique::format, kProbeFormats>},
      {"storage", "cube | dual-paraboloid | octahedral", "what a captured cube is converted to for lookups",
       "dual-paraboloid: GTA V", parseChoice<&Technique::storage, kStorages>,
       printChoice<&Technique::storage, kStorages>},
      {"mips", "off | on", "whether smooth surfaces read mipmaps where they show a map smaller than it is",
       "on: course documents", parseChoice<&Technique::mips, kSwitches>, printChoice<&Technique::mips, kSwitches>},
      {"seamless", "on | off", "whether texels are filtered across the edges of faces",
       "off: hardware before OpenGL 3.2", parseChoice<&Technique::seamless, kSwitches>,
       printChoice<&Technique::seamless, kSwitches>},
      {"hysteresis", "numbers from 0 to 0.99", "share of its earlier content that a map keeps when it is captured",
       "engines: temporal blending of probes",
       [](std::string_view text, Technique& t) { return parseNumberIn(text, 0.0, 0.99, t.hysteresis); },
       [](const Technique& t) { return fmt::format("{:g}", t.hysteresis); }},
      {"capture_textures", "on | off", "whether captures read the textures of surfaces",
       "wished for in course documents", parseChoice<&Technique::captureTextures, kSwitches>,
       printChoice<&Technique::captureTextures, kSwitches>},
      {"capture_lod", "numbers from 0.01 to 1", "share of their triangles that meshes have in captures",
       "GTA V: low levels of detail in reflections",
       [](std::string_view text, Technique& t) { return parseNumberIn(text, 0.01, 1.0, t.captureLod); },
       [](const Technique& t) { return fmt::format("{:g}", t.captureLod); }},
      {"capture_far", "numbers from 0 to 1e9",
       "metres from a probe beyond which captures show the environment; 0: everywhere",
       "engines: clip planes of reflection probes",
       [](std::string_view text, Technique& t) { return parseNumberIn(text, 0.0, 1e9, t.captureFar); },
       [](const Technique& t) { return fmt::format("{:g}", t.captureFar); }},
      {"capture_lights", "on | off", "whether captures show light of lights", "engines: lights left out of reflections",
       parseChoice<&Technique::captureLights, kSwitches>, printChoice<&Technique::captureLights, kSwitches>},
      {"placement", "explicit | origin | box-centre | centroid",
       "where probes stand; explicit: where the scene says, else the centre of the box around the owner",
       "origin: engines' scripts; box-centre: Unity's gizmo", parseChoice<&Technique::placement, kPlacements>,
       printChoice<&Technique::placement, kPlacements>},
      {"sharing", "none | distance?metres=D | count?probes=N", "which neighbours share one probe",
       "course documents; engines: hand-placed probes serve many objects", parseSharing,
       [](const Technique& t) { return printSpec(t.sharing); }},
      {"self_reflection", "none | split-parts", "split-parts: each connected part of a mesh has a probe of its own",
       "course documents", parseChoice<&Technique::selfReflection, kSelfReflections>,
       printChoice<&Technique::selfReflection, kSelfReflections>},
  };
}

}  // namespace

const std::vector<Axis>& axisTable() {
  static const std::vector<Axis> table = makeAxisTable();
  return table;
}

const Axis& axisNamed(std::string_view name) {
  const auto axis = std::ranges::find(axisTable(), name, &Axis::name);
  if (axis == axisTable().end()) throwInputError("axis {}", unknownMessage(name, axisNames()));
  return *axis;
}

void setAxis(Technique& technique, std::string_view name, std::string_view value) {
  const Axis& axis = axisNamed(name);
  if (!axis.parse(value, technique)) throwInputError("axis '{}' wants {}, got {}", name, axis.values, value);
}

std::string canonicalAxisValue(std::string_view axis, std::string_view value) {
  Technique technique;
  setAxis(technique, axis, value);
  return axisNamed(axis).print(technique);
}

std::vector<std::pair<std::string, std::string>> describe(const Technique& technique) {
  std::vector<std::pair<std::string, std::string>> values;
  for (const Axis& axis : axisTable()) values.emplace_back(axis.name, axis.print(technique));
  return values;
}

std::pair<std::string, std::vector<std::string>> parseAxisValues(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0)
    throwInputError("--set is written AXIS=VALUE or AXIS=VALUE,VALUE, got '{}'", text);
  std::pair<std::string, std::vector<std::string>> result{std::string(text.substr(0, equals)), {}};
  for (std::size_t begin = equals + 1; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    result.second.push_back(canonicalAxisValue(result.first, text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return result;
}

}  // namespace pb
