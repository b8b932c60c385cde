// The surroundings are infinitely far away: only the direction matters.
#include "raster/lookup.h"

namespace pb {

Lookup infiniteLookup() {
  return {.name = "infinite",
          .parameters = "",
          .description = "the direction itself, as if everything were infinitely far away",
          .source = "Greene 1986, and every textbook since",
          .keepsDirections = true};
}

}  // namespace pb
