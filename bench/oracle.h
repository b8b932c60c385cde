// Oracle probes in the raster's pictures: here the reference's cube maps meet the raster's lookups.
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include "bench/suite.h"
#include "raster/probe_views.h"
#include "raster/renderer.h"
#include "reference/probe.h"

namespace pb {

// What the maps of all probes show.
struct OracleMaps {
  std::vector<std::array<Image, 6>> faces;      // by probe
  std::vector<std::array<Plane, 6>> distances;  // by probe, empty where lookups read none
};

// Whether traced maps can take the place of the technique's: it keeps cube maps.
bool takesOracleMaps(const Technique& technique);

// The technique with maps that are given, and everything else as it is.
Technique withGivenMaps(Technique technique);

// One ray a texel, through its centre, as captures have. `settings.depth` is that of pictures that show the maps: the
// maps' own rays have one hit less, two less where the owner is of solid glass, in and out, but at least one.
OracleMaps traceMaps(const ProbeViews& views, ReferenceSettings settings, bool withDistances);

// The final image of a technique whose maps are given; with distances, if its lookup reads them.
Image renderWithMaps(RasterDevice& device, const Technique& given, const Snapshot& snapshot, const ImageSettings& image,
                     const OracleMaps& maps);

}  // namespace pb
