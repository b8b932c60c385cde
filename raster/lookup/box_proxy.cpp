// The surroundings are a box: Probe::proxyBox, or the bounds of everything but the probe's owners.
#include "raster/lookup.h"

namespace pb {

Lookup boxProxyLookup() {
  return {.name = "box-proxy",
          .parameters = "",
          .description = "where the ray leaves the probe's proxy box",
          .source = "Lagarde and Zanuttini, SIGGRAPH 2012; Unreal, Unity, Godot",
          .glsl = R"glsl(
vec3 lookupDirection(ProbeConstants p, vec3 from, vec3 d) {
  return boxProxyDirection(from, d, vec3(p.boxLower), vec3(p.boxUpper), vec3(p.position));
}
)glsl",
          .keepsDirections = true};
}

}  // namespace pb
