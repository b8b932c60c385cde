// One picture of a single direction instead of a cube map, and a mapping of texture coordinates and reflected
// direction.
#include "raster/lookup/lookups.h"

namespace pb {

Lookup singleViewLookup() {
  return {.name = "single-view",
          .parameters = "",
          .description =
              "one view of 90 degrees from the probe along its owners' mean normal, by texture coordinates and "
              "the reflected direction in tangent space",
          .source = "report of a heap of CRT monitors",
          .defines =
              [](const Spec& spec) {
                lookupReader(spec).finish();
                return std::string("#define SINGLE_VIEW\n");
              },
          .readsProbe = true,
          .isSingleView = true};
}

}  // namespace pb
