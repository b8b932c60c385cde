// Axes that are members of Technique with a few named values: their names, parsers and printers.
#pragma once

#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "bench/axes.h"

namespace pb {

template <class Enum>
struct Choice {
  std::string_view name;
  Enum value;
};

inline constexpr Choice<Feedback> kFeedbacks[] = {{"previous-frame", Feedback::previousFrame}, {"sky", Feedback::sky}};
inline constexpr Choice<BounceOrder> kBounceOrders[] = {{"sequential", BounceOrder::sequential},
                                                        {"simultaneous", BounceOrder::simultaneous}};
inline constexpr Choice<TextureFilter> kTextureFilters[] = {{"exact", TextureFilter::exact},
                                                            {"hardware", TextureFilter::hardware}};

inline constexpr Choice<Refraction> kRefractions[] = {{"one-interface", Refraction::oneInterface},
                                                      {"two-interface", Refraction::twoInterface},
                                                      {"cubemap-backface", Refraction::cubemapBackface},
                                                      {"thick-slab", Refraction::thickSlab}};
inline constexpr Choice<Dispersion> kDispersions[] = {
    {"off", Dispersion::off}, {"rgb-offset", Dispersion::rgbOffset}, {"per-channel-ior", Dispersion::perChannelIor}};
inline constexpr Choice<ProbeFilter> kProbeFilters[] = {
    {"none", ProbeFilter::none}, {"box-mips", ProbeFilter::boxMips}, {"ggx-prefiltered", ProbeFilter::ggxPrefiltered}};
inline constexpr Choice<GeometryTerm> kGeometryTerms[] = {{"smith-correlated", GeometryTerm::smithCorrelated},
                                                          {"one", GeometryTerm::one},
                                                          {"smith-k", GeometryTerm::smithK},
                                                          {"cook-torrance", GeometryTerm::cookTorrance}};
inline constexpr Choice<Coats> kCoats[] = {{"nearest-probe", Coats::nearestProbe},
                                           {"blended-probes", Coats::blendedProbes},
                                           {"environment", Coats::environment},
                                           {"none", Coats::none}};
inline constexpr Choice<WithoutProbe> kWithoutProbe[] = {{"environment", WithoutProbe::environment},
                                                         {"nearest-probe", WithoutProbe::nearestProbe},
                                                         {"blended-probes", WithoutProbe::blendedProbes}};
inline constexpr Choice<CapturedFaces> kCapturedFaces[] = {
    {"all", CapturedFaces::all}, {"no-top-bottom", CapturedFaces::noTopBottom}, {"top-half", CapturedFaces::topHalf}};
inline constexpr Choice<Iterations> kIterations[] = {{"brute-force", Iterations::bruteForce},
                                                     {"incremental", Iterations::incremental}};
inline constexpr Choice<ResolutionScale> kResolutionScales[] = {{"fixed", ResolutionScale::fixed},
                                                                {"distance", ResolutionScale::distance}};
inline constexpr Choice<ProbeFormat> kProbeFormats[] = {{"rgba16f", ProbeFormat::rgba16f},
                                                        {"r11f-g11f-b10f", ProbeFormat::r11fG11fB10f},
                                                        {"rgb9e5", ProbeFormat::rgb9e5},
                                                        {"rgba8-srgb", ProbeFormat::rgba8Srgb}};
inline constexpr Choice<Storage> kStorages[] = {
    {"cube", Storage::cube}, {"dual-paraboloid", Storage::dualParaboloid}, {"octahedral", Storage::octahedral}};
inline constexpr Choice<Placement> kPlacements[] = {{"explicit", Placement::stated},
                                                    {"origin", Placement::origin},
                                                    {"box-centre", Placement::boxCentre},
                                                    {"centroid", Placement::centroid}};
inline constexpr Choice<SelfReflection> kSelfReflections[] = {{"none", SelfReflection::none},
                                                              {"split-parts", SelfReflection::splitParts}};
// In the order of lists: what an axis stands at by default comes first.
inline constexpr Choice<bool> kOnOff[] = {{"on", true}, {"off", false}};
inline constexpr Choice<bool> kOffOn[] = {{"off", false}, {"on", true}};

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

template <auto Member, const auto& Choices>
Axis choiceAxis(const char* name, const char* description, const char* source) {
  std::vector<std::string> names;
  for (const auto& choice : Choices) names.emplace_back(choice.name);
  const std::string values = fmt::format("{}", fmt::join(names, " | "));
  return {name, values, description, source, parseChoice<Member, Choices>, printChoice<Member, Choices>, names};
}

}  // namespace pb
