// Time of each metric on one core, as seconds per megapixel (10^6 pixels), on a picture of the size of the quick suite.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>

#include "bench/metrics/error_sums.h"
#include "bench/metrics/metrics.h"
#include "bench/metrics/ssim.h"

namespace pb {
namespace {

constexpr int kWidth = 640, kHeight = 360;

// A sky-like gradient with structure at several scales and luminances from 1e-3 to 1e3, so that HDR-FLIP picks as many
// exposures as for a typical picture of a scene under the sun.
Image scenePicture(float shift, int height = kHeight) {
  Image image(kWidth, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float u = (static_cast<float>(x) + shift) / kWidth, v = static_cast<float>(y) / kHeight;
      const float detail = std::sin(40.0f * u) * std::cos(31.0f * v) + 0.3f * std::sin(211.0f * u + 97.0f * v);
      const float luminance = std::exp2(20.0f * (u * v - 0.5f) + detail);
      image(x, y) = luminance * glm::vec3(1.0f, 0.5f + 0.5f * v, 1.0f - 0.5f * u);
    }
  }
  return image;
}

struct Pair {
  Image reference = scenePicture(0), test = scenePicture(0.7f);
};

const Pair& pair() {
  static const Pair pair;
  return pair;
}

template <class Function>
void measure(benchmark::State& state, Function function) {
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  for (auto iteration : state) benchmark::DoNotOptimize(function());
  const double megapixels = 1e-6 * kWidth * kHeight;
  state.counters["s_per_Mpixel"] = benchmark::Counter(static_cast<double>(state.iterations()) * megapixels,
                                                      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void errorSums(benchmark::State& state) {
  measure(state, [] { return computeErrorSums(pair().reference, pair().test); });
}
BENCHMARK(errorSums)->Unit(benchmark::kMillisecond);

void ssim(benchmark::State& state) {
  measure(state, [] { return computeSsim(pair().reference, pair().test); });
}
BENCHMARK(ssim)->Unit(benchmark::kMillisecond);

void msSsim(benchmark::State& state) {
  // Sides of multiples of 16, which MS-SSIM asks for.
  static const Image reference(kWidth, 352, glm::vec3(0.5f)), test(kWidth, 352, glm::vec3(0.6f));
  measure(state, [] { return computeMsSsim(reference, test); });
}
BENCHMARK(msSsim)->Unit(benchmark::kMillisecond);

// All but FLIP, of one of many test images: error sums, SSIM and MS-SSIM, the reference's side kept.
void sumsAndSsimOfPreparedReference(benchmark::State& state) {
  static const Pair cropped{.reference = scenePicture(0, 352), .test = scenePicture(0.7f, 352)};
  static const ssim::SsimReference reference(cropped.reference, ssim::Scales::all, ssim::Reuse::ifSmall);
  measure(state, [] {
    const ErrorSums sums = errorSumsOf(cropped.reference, cropped.test, nullptr);
    return sums.mse + reference.compare(cropped.test, nullptr).msSsim.value();
  });
}
BENCHMARK(sumsAndSsimOfPreparedReference)->Unit(benchmark::kMillisecond);

void flipLdr(benchmark::State& state) {
  measure(state, [] { return computeFlipLdr(pair().reference, pair().test); });
}
BENCHMARK(flipLdr)->Unit(benchmark::kMillisecond);

void flipHdr(benchmark::State& state) {
  measure(state, [] { return computeFlipHdr(pair().reference, pair().test); });
  state.counters["exposures"] = computeFlipHdr(pair().reference, pair().test).numExposures;
}
BENCHMARK(flipHdr)->Unit(benchmark::kMillisecond);

void pooling(benchmark::State& state) {
  static const Plane map = computeFlipLdr(pair().reference, pair().test).map;
  measure(state, [] { return poolFlip(map); });
}
BENCHMARK(pooling)->Unit(benchmark::kMillisecond);

void allMetrics(benchmark::State& state) {
  measure(state, [] { return computeMetrics({.reference = pair().reference, .test = pair().test}); });
}
BENCHMARK(allMetrics)->Unit(benchmark::kMillisecond);

void allMetricsOfPreparedReference(benchmark::State& state) {
  static const MetricsReference reference(pair().reference);
  measure(state, [] { return reference.compare(pair().test); });
}
BENCHMARK(allMetricsOfPreparedReference)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pb

BENCHMARK_MAIN();
