#include "bench/axes.h"

#include <algorithm>
#include <bit>
#include <optional>

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
constexpr Choice<Coats> kCoats[] = {
    {"nearest-probe", Coats::nearestProbe}, {"environment", Coats::environment}, {"none", Coats::none}};

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

std::vector<std::string> axisNames() {
  std::vector<std::string> names;
  for (const Axis& axis : axisTable()) names.push_back(axis.name);
  return names;
}

std::vector<Axis> makeAxisTable() {
  return {
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
      {"coats", "nearest-probe | environment | none",
       "what dielectric coats of objects without a probe of their own reflect", "nearest-probe: every engine",
       parseChoice<&Technique::coats, kCoats>, printChoice<&Technique::coats, kCoats>},
      {"shadow_resolution", fmt::format("powers of two from {} to {}", kMinResolution, kMaxResolution),
       "texels along the edge of a shadow map's face, in scenes that cast shadows", "every engine: 512 to 4096",
       [](std::string_view text, Technique& t) { return parseResolution(text, t.shadowResolution); },
       [](const Technique& t) { return std::to_string(t.shadowResolution); }},
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
