// The truth of one scene at one frame: what every cell of that frame is scored against.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bench/metrics/metrics.h"
#include "bench/object_errors.h"
#include "bench/results.h"
#include "bench/store.h"
#include "bench/suite.h"

namespace pb {

// The truth with a limited number of bounces.
struct TruncatedTruth {
  bool converged = false;  // nothing is missing: it is Truth::mean, and the rest is empty
  Image mean{};
  MetricValues floor{}, maskFloor{};
  MetricsSettings display{};
  std::optional<MetricsReference> prepared{};  // of small images, which it is kept for

  MetricsResult compare(const Image& test, const Mask* mask) const;
};

struct Truth {
  std::shared_ptr<const Snapshot> snapshot;
  Image halfA, halfB, mean;
  double noise = 0;               // relMSE of the floor
  Grid<int> materials;            // see materialMap()
  Mask mask;                      // specular-dominant objects; empty if there are none in sight
  MetricValues floor, maskFloor;  // "mse" and "relmse" of the mean's own noise
  MetricsReference metrics;       // scores images against `mean`
  ObjectMap objects{};
  std::map<int, TruncatedTruth> truncated{};  // by depth, of those that were asked for
  std::int64_t raysTraced = 0;                // for halfA and halfB, those of earlier, noisier pictures left out
};

// Noise floor of the mean of two independent halves, ((A-B)/2)^2, as "mse" and "relmse".
MetricValues computeFloor(const Image& mean, const Image& halfA, const Mask* mask = nullptr);

// Samples per primary point that a pixel gets at most for max_noise: spp doubled as long as kMaxSpp allows.
int mostSpp(const TruthSettings& settings);

// A sentence for each reference that doesn't meet max_noise. From the cells, so that those of an earlier, interrupted
// run count too.
std::vector<std::string> describeNoisyReferences(const std::vector<CellResult>& cells, const TruthSettings& settings);

class TruthMaker {
 public:
  // `rasterIds` gives the raster's object ids of a snapshot; it is called on the thread that calls make().
  using RasterIds = std::function<Grid<SampleId>(const Snapshot&)>;

  TruthMaker(const ReferenceStore& store, const ImageSettings& image, const TruthSettings& settings,
             RasterIds rasterIds)
      : store_(store), image_(image), settings_(settings), rasterIds_(std::move(rasterIds)) {}

  // Takes the reference from the store or renders it and stores it. With max_noise a picture that is noisier only tells
  // where a new one, of other random numbers, needs how many samples (planSamples()), until one is quiet enough or all
  // pixels have mostSpp(). The truncated ones likewise, for depths that differ from it. `warnings` gets what went wrong
  // with stored references.
  std::shared_ptr<const Truth> make(std::shared_ptr<const Snapshot> snapshot, double exposure,
                                    std::vector<std::string>& warnings, const std::set<int>& depths = {}) const;

  // The reference of make() with all its batches.
  ReferenceImage reference(const std::shared_ptr<const Snapshot>& snapshot, std::vector<std::string>& warnings) const;

  // Whether the store has the first picture of that depth; with max_noise there may be more to render.
  bool isStored(const std::shared_ptr<const Snapshot>& snapshot, std::optional<int> depth) const;

 private:
  ReferenceRequest firstRequest(const std::shared_ptr<const Snapshot>& snapshot) const;
  ReferenceImage obtain(const ReferenceRequest& request, const ReferenceScene& scene,
                        std::vector<std::string>& warnings) const;
  ReferenceImage obtainQuietEnough(const std::shared_ptr<const Snapshot>& snapshot, const ReferenceScene& scene,
                                   std::optional<int> depth, std::vector<std::string>& warnings) const;
  std::map<int, TruncatedTruth> makeTruncated(const Truth& truth, const ReferenceScene& scene,
                                              const MetricsSettings& display, const std::set<int>& depths,
                                              std::vector<std::string>& warnings) const;
  Mask makeMask(const Snapshot& snapshot, const Grid<SampleId>& referenceIds, const Grid<SampleId>& rasterIds) const;
  ObjectMap makeObjectMap(const Snapshot& snapshot, const ReferenceScene& scene, const Grid<SampleId>& referenceIds,
                          const Grid<SampleId>& rasterIds) const;

  const ReferenceStore& store_;
  ImageSettings image_;
  TruthSettings settings_;
  RasterIds rasterIds_;
};

}  // namespace pb
