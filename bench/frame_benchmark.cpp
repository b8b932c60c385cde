// Time of frames on llvmpipe or a GPU: what is compared is rendered in turns, frame by frame, and medians are taken of
// the ratios of frames that follow each other, so that other programs on the machine disturb both sides alike.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "bench/benchmark_clock.h"
#include "raster/renderer.h"
#include "scenes/builtin.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

constexpr int kFrames = 11;

struct ImageSize {
  int widthPx, heightPx;
  double aspect() const { return static_cast<double>(widthPx) / heightPx; }
};
constexpr ImageSize kSmall = {640, 360};
constexpr ImageSize kLarge = {1280, 720};

RasterDevice& device() {
#ifdef PROBEBENCH_OSMESA
  static RasterDevice device(GlBackend::osmesa);
#else
  static RasterDevice device(GlBackend::egl);
#endif
  return device;
}

// Of a frame's time to that of the other side's frame before it.
double medianRatio(std::vector<double> times, const std::vector<double>& others) {
  std::ranges::transform(times, others, times.begin(), std::divides());
  return median(std::move(times));
}

std::shared_ptr<const Snapshot> mirrors(std::int64_t count, const ImageSize& size) {
  const auto scene = std::make_shared<const Scene>(makeBuiltinScene(parseSpec(fmt::format("mirrors?count={}", count))));
  return makeSnapshot(scene, 0, "", size.aspect());
}

Technique techniqueOf(std::int64_t bounces, std::int64_t resolution, Iterations iterations) {
  Technique technique;
  technique.bounces = static_cast<int>(bounces);
  technique.resolution = static_cast<int>(resolution);
  technique.iterations = iterations;
  return technique;
}

// Frames of a technique, with the time of each.
class TimedFrames {
 public:
  TimedFrames(const Technique& technique, std::shared_ptr<const Snapshot> snapshot, const ImageSize& size)
      : snapshot_(std::move(snapshot)), sequence_(device(), technique, size.widthPx, size.heightPx, 1) {
    // The first frame compiles shaders and fills maps, the second one sees all of them for the first time.
    for (int warmup = 0; warmup < 2; ++warmup) sequence_.renderFrame(*snapshot_);
    sequence_.finish();
  }

  // Returns the frame's wall time.
  double render() {
    const double wallBefore = wallMs(), cpuBefore = cpuMs();
    sequence_.renderFrame(*snapshot_);
    sequence_.finish();
    wallMs_.push_back(wallMs() - wallBefore);
    cpuMs_.push_back(cpuMs() - cpuBefore);
    return wallMs_.back();
  }

  const std::vector<double>& wallTimesMs() const { return wallMs_; }
  const std::vector<double>& cpuTimesMs() const { return cpuMs_; }

 private:
  std::shared_ptr<const Snapshot> snapshot_;
  RasterSequence sequence_;
  std::vector<double> wallMs_, cpuMs_;
};

// B incremental iterations against one iteration, which records nothing: `ratio` is what is promised to stay below 1.35
// for 8 mirrors, 3 iterations and 256 texels or more.
void incremental(benchmark::State& state) {
  const std::int64_t count = state.range(0), bounces = state.range(1), resolution = state.range(2);
  const auto snapshot = mirrors(count, kSmall);
  TimedFrames once(techniqueOf(1, resolution, Iterations::bruteForce), snapshot, kSmall);
  TimedFrames repeated(techniqueOf(bounces, resolution, Iterations::incremental), snapshot, kSmall);
  for (auto iteration : state) {
    once.render();
    state.SetIterationTime(1e-3 * repeated.render());
  }
  state.counters["ratio"] = medianRatio(repeated.wallTimesMs(), once.wallTimesMs());
  state.counters["ratio_cpu"] = medianRatio(repeated.cpuTimesMs(), once.cpuTimesMs());
  state.counters["ms"] = median(repeated.wallTimesMs());
  state.counters["cpu_ms"] = median(repeated.cpuTimesMs());
  state.counters["once_ms"] = median(once.wallTimesMs());
  state.counters["once_cpu_ms"] = median(once.cpuTimesMs());
}
BENCHMARK(incremental)
    ->ArgNames({"N", "B", "R"})
    ->ArgsProduct({{5, 8}, {2, 3}, {64, 128, 256, 512, 1024}})
    ->Iterations(kFrames)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

// A frame of N mirrors that see each other, in B iterations, with maps of R x R texels a face that are all captured
// anew: the work that a browser does with a cube camera for each mirror.
void frame(benchmark::State& state) {
  Technique technique = techniqueOf(state.range(1), state.range(2), Iterations::incremental);
  technique.textureFilter = TextureFilter::hardware;
  TimedFrames frames(technique, mirrors(state.range(0), kLarge), kLarge);
  for (auto iteration : state) state.SetIterationTime(1e-3 * frames.render());
  state.counters["ms"] = median(frames.wallTimesMs());
  state.counters["cpu_ms"] = median(frames.cpuTimesMs());
}
BENCHMARK(frame)
    ->ArgNames({"N", "B", "R"})
    ->ArgsProduct({{1, 3, 5, 8}, {1, 2, 3}, {64, 128, 256, 512}})
    ->Iterations(kFrames)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pb

BENCHMARK_MAIN();
