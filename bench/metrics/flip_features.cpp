#include "bench/metrics/flip_features.h"

#include <algorithm>
#include <array>

namespace pb::flip {
namespace {

// The opponent channel that each kernel filters: y, cx, cz.
constexpr std::array<int, kKernelCount> kChannelOf{0, 1, 2, 2, 0, 0, 0};

}  // namespace

BandFeatures::BandFeatures(const Kernels& kernels, const Image& image, int firstRow, int endRow)
    : kernels_(kernels),
      width_(static_cast<std::size_t>(image.width())),
      padding_(static_cast<std::size_t>(kernels.radius)),
      paddedWidth_(width_ + 2 * padding_),
      imageHeight_(image.height()),
      firstStoredRow_(std::max(firstRow - kernels.radius, 0)),
      endStoredRow_(std::min(endRow + kernels.radius, image.height())) {
  const auto rows = static_cast<std::size_t>(endStoredRow_ - firstStoredRow_);
  linear_.resize(3 * rows * width_);
  opponent_.resize(3 * rows * width_);
  padded_.resize(kKernelCount * paddedWidth_);
  scratch_.resize(4 * width_);
  for (int y = firstStoredRow_; y < endStoredRow_; ++y) {
    splitChannels(&image(0, y).x, image.width(), rowsOf(linear_, y - firstStoredRow_));
  }
}

Row3 BandFeatures::rowsOf(std::vector<float>& planes, int index) const {
  float* const row = &planes[3 * static_cast<std::size_t>(index) * width_];
  return {row, row + width_, row + 2 * width_};
}

const float* BandFeatures::opponentRow(int channel, int y) const {
  const int row = std::clamp(y, 0, imageHeight_ - 1) - firstStoredRow_;
  return &opponent_[(3 * static_cast<std::size_t>(row) + static_cast<std::size_t>(channel)) * width_];
}

void BandFeatures::setDisplay(const Display& display) {
  const int width = static_cast<int>(width_);
  for (int row = 0; row < endStoredRow_ - firstStoredRow_; ++row) {
    const Row3 in = rowsOf(linear_, row);
    const ConstRow3 rgb{in[0], in[1], in[2]};
    const Row3 out = rowsOf(opponent_, row);
    if (!display.toneMapper) {
      clampToOpponent(rgb, width, out);
    } else if (*display.toneMapper == ToneMapper::reinhard) {
      reinhardToOpponent(rgb, display.gain, width, out);
    } else {
      curveToOpponent(rgb, display.gain, toneCurve(*display.toneMapper), width, out);
    }
  }
}

// rowAt(i) is the row of values at offset i from the filtered ones.
template <class RowAt>
void BandFeatures::filter(const Kernel& kernel, RowAt rowAt, float* out) {
  taps_.clear();
  int offset = kernel.firstOffset;
  for (const float weight : kernel.weights) {
    taps_.push_back({rowAt(-offset), rowAt(offset), weight});
    ++offset;
  }
  const int width = static_cast<int>(width_);
  switch (kernel.symmetry) {
    case Symmetry::even:
      return sumEvenTaps(taps_, width, out);
    case Symmetry::odd:
      return sumOddTaps(taps_, width, out);
    case Symmetry::curvature:
      return sumCurvatureTaps(taps_, rowAt(0), width, out);
  }
}

void BandFeatures::computeRow(int y, float* block) {
  const FeatureRow out(block, static_cast<int>(width_));
  filterColumns(y);
  extendBorders();
  computeColors(out);
  computeGradient(kEdge, out.edge);
  computeGradient(kPoint, out.point);
}

void BandFeatures::filterColumns(int y) {
  for (int name = 0; name < kKernelCount; ++name) {
    const int channel = kChannelOf[static_cast<std::size_t>(name)];
    filter(
        kernels_.kernels[static_cast<std::size_t>(name)], [&](int i) { return opponentRow(channel, y + i); },
        paddedRow(name));
  }
}

void BandFeatures::extendBorders() {
  for (int name = 0; name < kKernelCount; ++name) {
    float* const first = paddedRow(name);
    float* const end = first + width_;
    std::fill(first - padding_, first, *first);
    std::fill(end, end + padding_, *(end - 1));
  }
}

void BandFeatures::filterPadded(KernelName source, KernelName kernel, float* out) {
  const float* const row = paddedRow(source);
  filter(
      kernels_[kernel], [row](int i) { return row + i; }, out);
}

void BandFeatures::computeColors(const FeatureRow& out) {
  for (const KernelName name : {kAchromatic, kRedGreen, kBlueYellow1, kBlueYellow2}) {
    filterPadded(name, name, scratchRow(name));
  }
  opponentToLab({scratchRow(kAchromatic), scratchRow(kRedGreen), scratchRow(kBlueYellow1), scratchRow(kBlueYellow2)},
                static_cast<int>(width_), out);
}

// Derivative along one direction and smoothing along the other, for both directions.
void BandFeatures::computeGradient(KernelName derivative, float* out) {
  filterPadded(kSmooth, derivative, scratchRow(0));
  filterPadded(derivative, kSmooth, scratchRow(1));
  magnitude(scratchRow(0), scratchRow(1), static_cast<int>(width_), out);
}

}  // namespace pb::flip
