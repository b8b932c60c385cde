#include "bench/metrics/tap_sums.h"

#include <cstddef>
#include <utility>

#include "bench/metrics/vector_clones.h"

// Everything below is inlined into the clones, so that it is compiled for their instruction sets.
#define PB_INLINE [[gnu::always_inline]] inline

namespace pb {
namespace {

template <class T, class Combine, std::size_t... i>
PB_INLINE void addGroup(const TapPair<T>* taps, int width, T* __restrict out, Combine combine,
                        std::index_sequence<i...>) {
  // Copies, because the compiler can't know that `out` leaves the taps alone.
  const T* const before[] = {taps[i].before...};
  const T* const after[] = {taps[i].after...};
  const T weight[] = {taps[i].weight...};
  for (int x = 0; x < width; ++x) {
    out[x] = (out[x] + ... + (weight[i] * combine(before[i][x], after[i][x], x)));
  }
}

// Four taps a pass over the row: few enough for the pointers to stay in registers.
template <class T, class Combine>
PB_INLINE void addTaps(std::span<const TapPair<T>> taps, int width, T* out, Combine combine) {
  std::size_t first = 0;
  for (; first + 4 <= taps.size(); first += 4) {
    addGroup(taps.data() + first, width, out, combine, std::make_index_sequence<4>());
  }
  const TapPair<T>* const rest = taps.data() + first;
  switch (taps.size() - first) {
    case 3:
      return addGroup(rest, width, out, combine, std::make_index_sequence<3>());
    case 2:
      return addGroup(rest, width, out, combine, std::make_index_sequence<2>());
    case 1:
      return addGroup(rest, width, out, combine, std::make_index_sequence<1>());
    default:
      return;
  }
}

}  // namespace

PB_VECTOR_CLONES void addEvenTaps(std::span<const TapPair<float>> taps, int width, float* out) {
  addTaps(taps, width, out, [](float before, float after, int) { return before + after; });
}

PB_VECTOR_CLONES void addEvenTaps(std::span<const TapPair<double>> taps, int width, double* out) {
  addTaps(taps, width, out, [](double before, double after, int) { return before + after; });
}

PB_VECTOR_CLONES void addOddTaps(std::span<const TapPair<float>> taps, int width, float* out) {
  addTaps(taps, width, out, [](float before, float after, int) { return before - after; });
}

PB_VECTOR_CLONES void addCurvatureTaps(std::span<const TapPair<float>> taps, const float* centre, int width,
                                       float* out) {
  addTaps(taps, width, out, [centre](float before, float after, int x) { return (before + after) - 2.0f * centre[x]; });
}

}  // namespace pb
