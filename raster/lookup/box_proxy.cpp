// The surroundings are a box: Probe::proxyBox, or the bounds of everything but the probe's owners.
#include "raster/lookup/lookups.h"

namespace pb {

Lookup boxProxyLookup() {
  return {.name = "box-proxy",
          .parameters = "",
          .description = "where the ray leaves the probe's proxy box",
          .source = "Lagarde and Zanuttini, SIGGRAPH 2012; Unreal, Unity, Godot",
          .defines =
              [](const Spec& spec) {
                lookupReader(spec).finish();
                return std::string("#define BOX_PROXY\n");
              },
          .readsProbe = true,
          .keepsDirections = true};
}

}  // namespace pb
