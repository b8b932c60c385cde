// Flat reflectors show the scene from the mirrored camera (raster/planar.h); cube maps are looked up for what is seen
// through them and where they are seen in other reflectors.
#include "raster/lookup.h"

namespace pb {

Lookup planarLookup() {
  return {.name = "planar",
          .parameters = "",
          .description =
              "flat reflectors only: the scene drawn from the camera mirrored at their plane, once for each plane",
          .source = "course slides, Introduction to Computer Graphics; Unreal, Unity HDRP",
          .isPlanar = true};
}

}  // namespace pb
