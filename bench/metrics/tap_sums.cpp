#include "bench/metrics/tap_sums.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "bench/metrics/vector_clones.h"

// Everything below is inlined into the clones, so that it is compiled for their instruction sets.
#define PB_INLINE [[gnu::always_inline]] inline

namespace pb {
namespace {

// The first group of taps of a sum starts it, others add to it.
template <bool isFirst, class T, class Combine, std::size_t... i>
PB_INLINE void sumGroup(const TapPair<T>* taps, int width, T* __restrict out, Combine combine,
                        std::index_sequence<i...>) {
  // Copies, because the compiler can't know that `out` leaves the taps alone.
  const T* const before[] = {taps[i].before...};
  const T* const after[] = {taps[i].after...};
  const T weight[] = {taps[i].weight...};
  for (int x = 0; x < width; ++x) {
    if constexpr (isFirst) {
      out[x] = (... + (weight[i] * combine(before[i][x], after[i][x], x)));
    } else {
      out[x] = (out[x] + ... + (weight[i] * combine(before[i][x], after[i][x], x)));
    }
  }
}

template <bool isFirst, class T, class Combine>
PB_INLINE void sumUpToFour(const TapPair<T>* taps, std::size_t count, int width, T* out, Combine combine) {
  switch (count) {
    case 1:
      return sumGroup<isFirst>(taps, width, out, combine, std::make_index_sequence<1>());
    case 2:
      return sumGroup<isFirst>(taps, width, out, combine, std::make_index_sequence<2>());
    case 3:
      return sumGroup<isFirst>(taps, width, out, combine, std::make_index_sequence<3>());
    default:
      return sumGroup<isFirst>(taps, width, out, combine, std::make_index_sequence<4>());
  }
}

// Four taps a pass over the row: few enough for the pointers to stay in registers.
template <class T, class Combine>
PB_INLINE void sumTaps(std::span<const TapPair<T>> taps, int width, T* out, Combine combine) {
  sumUpToFour<true>(taps.data(), std::min<std::size_t>(taps.size(), 4), width, out, combine);
  for (std::size_t first = 4; first < taps.size(); first += 4) {
    sumUpToFour<false>(taps.data() + first, std::min<std::size_t>(taps.size() - first, 4), width, out, combine);
  }
}

}  // namespace

PB_VECTOR_CLONES void sumEvenTaps(std::span<const TapPair<float>> taps, int width, float* out) {
  sumTaps(taps, width, out, [](float before, float after, int) { return before + after; });
}

PB_VECTOR_CLONES void sumOddTaps(std::span<const TapPair<float>> taps, int width, float* out) {
  sumTaps(taps, width, out, [](float before, float after, int) { return before - after; });
}

PB_VECTOR_CLONES void sumCurvatureTaps(std::span<const TapPair<float>> taps, const float* centre, int width,
                                       float* out) {
  sumTaps(taps, width, out, [centre](float before, float after, int x) { return (before + after) - 2.0f * centre[x]; });
}

}  // namespace pb
