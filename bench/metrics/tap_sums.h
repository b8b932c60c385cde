// Weighted sums over symmetric pairs of filter taps: the inner loop of every filter of FLIP. The taps of a
// vertical pass are rows of an image, those of a horizontal pass one row at several offsets.
#pragma once

#include <span>

namespace pb {

template <class T>
struct TapPair {
  const T* before;
  const T* after;
  T weight;
};

// out[x] = sum over taps of weight * (before[x] + after[x]), in the order of the taps, of which there is at least one.
void sumEvenTaps(std::span<const TapPair<float>> taps, int width, float* out);

// out[x] = sum over taps of weight * (before[x] - after[x])
void sumOddTaps(std::span<const TapPair<float>> taps, int width, float* out);

// out[x] = sum over taps of weight * (before[x] + after[x] - 2 centre[x])
void sumCurvatureTaps(std::span<const TapPair<float>> taps, const float* centre, int width, float* out);

}  // namespace pb
