// The surroundings are a sphere around the probe.
#include <fmt/format.h>

#include "raster/lookup.h"

namespace pb {
namespace {

std::string defines(const Spec& spec) {
  SpecReader reader = lookupReader(spec);
  const double radius = reader.number("radius", 0.001, 1e9, 0.0);
  reader.finish();
  return radius > 0.0 ? fmt::format("#define SPHERE_RADIUS {:#.9g}f\n", radius) : "";
}

constexpr const char* kGlsl = R"glsl(
#ifndef SPHERE_RADIUS
#define SPHERE_RADIUS p.boxLower.w
#endif
vec3 lookupDirection(ProbeConstants p, vec3 from, vec3 d) {
  return sphereProxyDirection(from - vec3(p.position), d, SPHERE_RADIUS);
}
)glsl";

}  // namespace

Lookup sphereProxyLookup() {
  return {.name = "sphere-proxy",
          .parameters = "radius = metres, 0.001 to 1e9, default half the mean edge of the probe's proxy box",
          .description = "where the ray meets a sphere around the probe",
          .source = "Bjorke, \"Image-Based Lighting\", GPU Gems (2004), chapter 19",
          .defines = defines,
          .glsl = kGlsl,
          .keepsDirections = true};
}

}  // namespace pb
