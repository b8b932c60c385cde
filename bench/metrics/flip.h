// FLIP of many test images against one reference.
#pragma once

#include <vector>

#include "bench/metrics/flip_features.h"
#include "bench/metrics/metrics.h"
#include "scenes/image.h"

namespace pb::flip {

enum class Mode { ldr, hdr };

// Whether the features of the reference are kept for further test images; the results are the same bits.
enum class Reuse { never, ifSmall };

class FlipReference {
 public:
  // The image must outlive the object.
  FlipReference(const Image& reference, Mode mode, const FlipSettings& settings, Reuse reuse);

  FlipResult compare(const Image& test) const;

 private:
  struct Band {
    int firstRow, endRow;
  };
  template <class Body>
  void forEachBand(Body body) const;

  int exposureCount() const { return mode_ == Mode::hdr ? exposures_.count : 1; }
  Display displayAt(int exposure) const;
  float exposureFraction(int exposure) const;
  std::size_t featureIndex(int exposure, int y) const;
  void keepFeatures();
  void compareBand(const Band& band, const Image& test, FlipResult& result) const;

  const Image& reference_;
  Mode mode_;
  FlipSettings settings_;
  Kernels kernels_;
  ExposureRange exposures_;
  std::vector<float> features_;  // rows of kFeatureCount * width values, by exposure and row; empty if not kept
};

}  // namespace pb::flip
