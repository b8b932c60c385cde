// What the reference spends on rays beside what Embree alone needs for the same ones: scene A of the peers,
// builtin:mirrors-ring, with global illumination. One thread; medians of rounds in which the picture is rendered and
// its recorded rays are traced one after the other, so that other programs on the machine disturb both sides alike.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "bench/benchmark_clock.h"
#include "reference/ray_log.h"
#include "reference/renderer.h"
#include "scenes/builtin.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

constexpr int kRounds = 7;
constexpr int kWidthPx = 320, kHeightPx = 180;
constexpr std::array<const char*, kRayKinds> kNames = {"primary", "mirrored", "diffuse", "later"};
constexpr std::array<int, 3> kPacketWidths = {1, 8, 16};

ReferenceSettings settingsOf(std::int64_t samplesPerAxis, std::int64_t spp) {
  ReferenceSettings settings;
  settings.samplesPerAxis = static_cast<int>(samplesPerAxis);
  settings.spp = static_cast<int>(spp);
  settings.diffuse = DiffuseTransport::traced;
  settings.depth = 8;
  settings.diffuseDepth = 8;
  return settings;
}

double secondsToRender(const ReferenceScene& scene, const Snapshot& snapshot, const ReferenceSettings& settings) {
  return tbb::task_arena(1).execute([&] {
    const double startMs = cpuMs();
    scene.render(snapshot.camera, kWidthPx, kHeightPx, settings);
    return 1e-3 * (cpuMs() - startMs);
  });
}

// Of one kind of rays, by packet width.
using Seconds = std::array<double, kPacketWidths.size()>;

Seconds secondsToTrace(const EmbreeScene& triangles, const std::vector<Ray>& rays, bool coherent) {
  Seconds seconds{};
  for (std::size_t w = 0; w < seconds.size(); ++w)
    seconds[w] = triangles.secondsToIntersect(rays, kPacketWidths[w], coherent);
  return seconds;
}

// `share` is what is promised: rays per second, shading included, over those of Embree alone with single rays;
// `share_of_best` is the same beside the best packet width of each kind.
void intersect(benchmark::State& state) {
  const auto scene = std::make_shared<const Scene>(makeBuiltinScene(parseSpec("mirrors-ring")));
  const auto snapshot = makeSnapshot(scene, 0, "", static_cast<double>(kWidthPx) / kHeightPx);
  const ReferenceSettings settings = settingsOf(state.range(0), state.range(1));
  const ReferenceScene reference(snapshot);
  const EmbreeScene triangles(*snapshot);
  RecordedRays recorded;
  reference.recordRays(snapshot->camera, kWidthPx, kHeightPx, settings, recorded);

  std::vector<double> shares, sharesOfBest, rendered;
  std::array<std::array<std::vector<double>, kPacketWidths.size()>, kRayKinds> traced;
  for (auto iteration : state) {
    rendered.push_back(secondsToRender(reference, *snapshot, settings));
    state.SetIterationTime(rendered.back());
    double single = 0.0, best = 0.0;
    for (std::size_t kind = 0; kind < kRayKinds; ++kind) {
      const Seconds seconds = secondsToTrace(triangles, recorded.ofKind[kind], kind == 0);
      for (std::size_t w = 0; w < seconds.size(); ++w) traced[kind][w].push_back(seconds[w]);
      single += seconds[0];
      best += *std::ranges::min_element(seconds);
    }
    shares.push_back(single / rendered.back());
    sharesOfBest.push_back(best / rendered.back());
  }

  double rays = 0.0;
  for (std::size_t kind = 0; kind < kRayKinds; ++kind) {
    const auto count = static_cast<double>(recorded.ofKind[kind].size());
    rays += count;
    state.counters[fmt::format("{}_rays", kNames[kind])] = count;
    for (std::size_t w = 0; w < kPacketWidths.size(); ++w)
      state.counters[fmt::format("{}_{}_Mrays_per_s", kNames[kind], kPacketWidths[w])] =
          1e-6 * count / median(traced[kind][w]);
  }
  state.counters["Mrays_per_s"] = 1e-6 * rays / median(rendered);
  state.counters["share"] = median(shares);
  state.counters["share_of_best"] = median(sharesOfBest);
}
BENCHMARK(intersect)
    ->ArgNames({"S", "spp"})
    ->Args({4, 4})
    ->Args({2, 16})
    ->Iterations(kRounds)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pb
