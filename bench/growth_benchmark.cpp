// How costs grow: of frames with triangles, of the reference with triangles, samples and depth. scripts/growth fits the
// exponents; growth with mirrors, iterations and texels comes from frame_benchmark.cpp.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <glm/trigonometric.hpp>

#include "bench/benchmark_clock.h"
#include "raster/renderer.h"
#include "reference/renderer.h"
#include "scenes/builtin.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

constexpr int kWidthPx = 320, kHeightPx = 180;
constexpr int kRuns = 3;

std::shared_ptr<const Snapshot> snapshotOf(std::shared_ptr<const Scene> scene) {
  return makeSnapshot(std::move(scene), 0, "", static_cast<double>(kWidthPx) / kHeightPx);
}

// A matte sphere of about so many triangles.
std::shared_ptr<const Snapshot> sphere(std::int64_t triangles) {
  auto scene = std::make_shared<Scene>();
  scene->environment = makeProceduralSky();
  const int rings = static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 4.0)));
  addInstance(*scene, "sphere", finishMesh(makeSphereMesh(1.0f, 2 * rings, rings)),
              addMaterial(*scene, makeDiffuseMaterial("matte", glm::vec3(0.5f))));
  addCamera(*scene, "camera", {0, 0, 4}, {0, 0, 0}, glm::radians(40.0f), 0.1f);
  finishScene(*scene);
  return snapshotOf(scene);
}

std::shared_ptr<const Snapshot> builtin(const char* name) {
  return snapshotOf(std::make_shared<const Scene>(makeBuiltinScene(parseSpec(name))));
}

// Medians of what `work` takes; it has been run once before.
void measure(benchmark::State& state, const std::function<void()>& work) {
  std::vector<double> wall, cpu;
  for (auto iteration : state) {
    const double wallBefore = wallMs(), cpuBefore = cpuMs();
    work();
    wall.push_back(wallMs() - wallBefore);
    cpu.push_back(cpuMs() - cpuBefore);
    state.SetIterationTime(1e-3 * wall.back());
  }
  state.counters["ms"] = median(wall);
  state.counters["cpu_ms"] = median(cpu);
}

void growthFrame(benchmark::State& state) {
#ifdef PROBEBENCH_OSMESA
  static RasterDevice device(GlBackend::osmesa);
#else
  static RasterDevice device(GlBackend::egl);
#endif
  const auto snapshot = sphere(state.range(0));
  RasterSequence sequence(device, Technique{}, kWidthPx, kHeightPx, 1);
  const auto frame = [&] {
    sequence.renderFrame(*snapshot);
    sequence.finish();
  };
  frame();
  measure(state, frame);
}
constexpr std::int64_t kMillion = 1'000'000;
#define PROBEBENCH_GROWTH(function) \
  BENCHMARK(function)->Iterations(kRuns)->UseManualTime()->Unit(benchmark::kMillisecond)
PROBEBENCH_GROWTH(growthFrame)
    ->ArgName("T")
    ->Arg(kMillion / 100)
    ->Arg(kMillion / 10)
    ->Arg(kMillion)
    ->Arg(10 * kMillion);

void growthBuild(benchmark::State& state) {
  const auto snapshot = sphere(state.range(0));
  measure(state, [&] { const ReferenceScene scene(snapshot); });
}
PROBEBENCH_GROWTH(growthBuild)
    ->ArgName("T")
    ->Arg(kMillion / 100)
    ->Arg(kMillion / 10)
    ->Arg(kMillion)
    ->Arg(10 * kMillion);

void measureReference(benchmark::State& state, const std::shared_ptr<const Snapshot>& snapshot,
                      const ReferenceSettings& settings) {
  const ReferenceScene scene(snapshot);
  const auto render = [&] { scene.render(snapshot->camera, kWidthPx, kHeightPx, settings); };
  measure(state, render);
}

ReferenceSettings tracedSettings(int spp) {
  ReferenceSettings settings;
  settings.samplesPerAxis = 1;
  settings.spp = spp;
  settings.diffuse = DiffuseTransport::traced;
  return settings;
}

void growthTriangles(benchmark::State& state) { measureReference(state, sphere(state.range(0)), tracedSettings(8)); }
PROBEBENCH_GROWTH(growthTriangles)
    ->ArgName("T")
    ->Arg(kMillion / 100)
    ->Arg(kMillion / 10)
    ->Arg(kMillion)
    ->Arg(10 * kMillion);

void growthSamples(benchmark::State& state) {
  measureReference(state, builtin("mirrors?count=5"), tracedSettings(static_cast<int>(state.range(0))));
}
PROBEBENCH_GROWTH(growthSamples)->ArgName("spp")->Arg(4)->Arg(16)->Arg(64);

// In a room of mirrors, where nearly every path is as long as it may be.
void growthDepth(benchmark::State& state) {
  ReferenceSettings settings = tracedSettings(8);
  settings.depth = static_cast<int>(state.range(0));
  settings.diffuse = DiffuseTransport::local;
  measureReference(state, builtin("hall-of-mirrors"), settings);
}
PROBEBENCH_GROWTH(growthDepth)->ArgName("depth")->Arg(2)->Arg(4)->Arg(8)->Arg(16);

}  // namespace
}  // namespace pb
