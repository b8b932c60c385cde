// The image side of FLIP: what each pixel's surroundings look like to a viewer, for a band of rows of one image.
#pragma once

#include <optional>
#include <vector>

#include "bench/metrics/flip_kernels.h"
#include "bench/metrics/flip_rows.h"
#include "bench/metrics/tap_sums.h"
#include "scenes/image.h"

namespace pb::flip {

// How linear values become displayed ones in [0,1]: LDR-FLIP only clamps, HDR-FLIP exposes and tone-maps first.
struct Display {
  std::optional<ToneMapper> toneMapper;
  float gain = 1;
};

// Filters that reach beyond the border see the edge pixel repeated.
class BandFeatures {
 public:
  // Rows [firstRow, endRow) of the image; both references must outlive the object.
  BandFeatures(const Kernels& kernels, const Image& image, int firstRow, int endRow);

  // Chooses what computeRow() looks at.
  void setDisplay(const Display& display);

  // Features of row y of the band, a block of kFeatureCount * width values.
  void computeRow(int y, float* block);

 private:
  // An opponent channel of an image row; y may lie outside of the image.
  const float* opponentRow(int channel, int y) const;
  float* paddedRow(int name) { return &padded_[static_cast<std::size_t>(name) * paddedWidth_ + padding_]; }
  float* scratchRow(int index) { return &scratch_[static_cast<std::size_t>(index) * width_]; }
  Row3 rowsOf(std::vector<float>& planes, int index) const;

  void filterColumns(int y);
  void extendBorders();
  void computeColors(const FeatureRow& out);
  void filterPadded(KernelName source, KernelName kernel, float* out);
  void computeGradient(KernelName derivative, float* out);
  template <class RowAt>
  void filter(const Kernel& kernel, RowAt rowAt, float* out);

  const Kernels& kernels_;
  std::size_t width_, padding_, paddedWidth_;
  int imageHeight_;
  int firstStoredRow_, endStoredRow_;
  std::vector<float> linear_, opponent_;  // stored rows, each as three planar channels
  std::vector<float> padded_;             // one row per kernel: filtered along columns, edge pixels repeated
  std::vector<float> scratch_;            // four rows
  std::vector<TapPair<float>> taps_;
};

}  // namespace pb::flip
