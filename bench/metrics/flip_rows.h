// The steps of FLIP on one row of pixels: pure functions of planar float rows of `width` values, vectorised.
#pragma once

#include <array>

#include "bench/metrics/tone_mapping.h"

namespace pb::flip {

using Row3 = std::array<float*, 3>;
using ConstRow3 = std::array<const float*, 3>;
using ConstRow4 = std::array<const float*, 4>;

// What one image contributes to the error of each pixel: five rows in one block of memory.
inline constexpr int kFeatureCount = 5;

template <class T>
struct FeatureRowOf {
  T* lightness;  // Hunt-adjusted CIELAB after the contrast sensitivity filters
  T* a;
  T* b;
  T* edge;  // magnitudes of the feature detectors
  T* point;

  FeatureRowOf(T* block, int width)
      : lightness(block), a(block + width), b(block + 2 * width), edge(block + 3 * width), point(block + 4 * width) {}
};
using FeatureRow = FeatureRowOf<float>;
using ConstFeatureRow = FeatureRowOf<const float>;

// Interleaved RGB into planes; negatives become 0.
void splitChannels(const float* rgb, int width, const Row3& out);

// Linear RGB times gain, tone-mapped and clamped to [0,1], into the opponent space of flip_color.h.
void clampToOpponent(const ConstRow3& rgb, int width, const Row3& opponent);
void curveToOpponent(const ConstRow3& rgb, float gain, const RationalCurve& curve, int width, const Row3& opponent);
void reinhardToOpponent(const ConstRow3& rgb, float gain, int width, const Row3& opponent);

// Filtered opponent values y, cx and cz, the last as the sum of its two Gaussians' parts, into the colour members of a
// feature row.
void opponentToLab(const ConstRow4& filtered, int width, const FeatureRow& out);

// sqrt(x^2 + y^2)
void magnitude(const float* x, const float* y, int width, float* out);

// Per-pixel FLIP error of two feature rows.
void flipError(const ConstFeatureRow& reference, const ConstFeatureRow& test, int width, float* error);

// Where the error exceeds the largest so far, it takes its place, and `exposure` that of exposureOfLargest.
void keepLargest(const float* error, float exposure, int width, float* largest, float* exposureOfLargest);

}  // namespace pb::flip
