// The surroundings are a sphere around the probe.
#include <fmt/format.h>

#include "raster/lookup/lookups.h"

namespace pb {

Lookup sphereProxyLookup() {
  return {.name = "sphere-proxy",
          .parameters = "radius = metres, 0.001 to 1e9, default half the mean edge of the probe's proxy box",
          .description = "where the ray meets a sphere around the probe",
          .source = "Bjorke, \"Image-Based Lighting\", GPU Gems (2004), chapter 19",
          .defines =
              [](const Spec& spec) {
                SpecReader reader = lookupReader(spec);
                const double radius = reader.number("radius", 0.001, 1e9, 0.0);
                reader.finish();
                std::string defines = "#define SPHERE_PROXY\n";
                if (radius > 0.0) defines += fmt::format("#define SPHERE_RADIUS {:#.9g}f\n", radius);
                return defines;
              },
          .readsProbe = true,
          .keepsDirections = true};
}

}  // namespace pb
