// The surroundings are what the probe captured, at the distances of its depth buffers.
#include <fmt/format.h>

#include "raster/lookup/lookups.h"

namespace pb {

Lookup distanceImpostorLookup() {
  return {.name = "distance-impostor",
          .parameters =
              "steps = samples of the linear search, 0 to 256, default 8; secant = steps of the search between "
              "two of them, 1 to 32, default 6",
          .description = "where the ray goes behind what the probe captured, searched in its depth buffers",
          .source = "Szirmay-Kalos et al., Eurographics 2005",
          .defines =
              [](const Spec& spec) {
                SpecReader reader = lookupReader(spec);
                const int steps = reader.integer("steps", 0, 256, 8);
                const int secant = reader.integer("secant", 1, 32, 6);
                reader.finish();
                return fmt::format("#define DISTANCE_IMPOSTOR {}\n#define SECANT_STEPS {}\n", steps, secant);
              },
          .readsDistances = true,
          .readsProbe = true};
}

}  // namespace pb
