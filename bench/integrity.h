// Integrity of a technique's cube maps, whatever a view shows of them: their edges, the places and turns of their
// faces, and their energy. What the numbers mean: docs/integrity.md.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/results.h"
#include "raster/probe_views.h"
#include "raster/renderer.h"

namespace pb {

// Six faces in GL order.
using CubeFaces = std::array<Image, 6>;

// Mean absolute step between the texels on both sides of the 12 edges, over the mean of the steps next to them inside
// the faces: near 1 for a map whose faces belong together. Steps are of r / (1 + r), so that highlights don't decide. 1
// for maps without any step. At least 2 texels along an edge.
double edgeStepRatio(const CubeFaces& faces);

// Of the texels of one face, steradians; all faces have the same.
Grid<double> texelSolidAngles(int resolution);

// |sum of the texels' solid angles / (4 pi) - 1|.
double solidAngleError(const Grid<double>& solidAngles);

// Mean radiance over the sphere and the channels, by the texels' solid angles.
double meanRadiance(const CubeFaces& faces, const Grid<double>& solidAngles);

// Number of faces that look more like another face of `expected`, or like their own mirrored or turned, than like their
// own. Faces of any one size each; compared at the smaller one, which must divide the other.
int misplacedFaces(const CubeFaces& faces, const CubeFaces& expected);

// The names and values of one technique at one frame, after that frame was rendered: "probes", "misplaced_faces",
// "solid_angle_error", and by level "edge_step_mip0", .. (largest of all probes) and "radiance_mip0", .. (mean of all
// probes). Empty without cube maps.
class IntegrityMeter {
 public:
  MetricValues measure(RasterSequence& sequence, const Technique& technique,
                       const std::shared_ptr<const Snapshot>& snapshot, int heightPx);

 private:
  // What the probes ought to see, traced, in a few texels.
  const std::vector<CubeFaces>& expectedFaces(const ProbeViews& views);

  const Grid<double>& solidAngles(int resolution);

  std::map<int, Grid<double>> solidAngles_;                 // by resolution
  std::map<std::string, std::vector<CubeFaces>> expected_;  // of the last snapshot, by where its probes stand
  std::weak_ptr<const Snapshot> snapshot_;
};

}  // namespace pb
