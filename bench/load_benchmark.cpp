// Time from a glTF file to the first picture: file, scene, Embree's hierarchy, buffers of the rasteriser.
#include <benchmark/benchmark.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>

#include "bench/benchmark_clock.h"
#include "raster/renderer.h"
#include "reference/renderer.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/files.h"
#include "scenes/gltf_save.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

constexpr int kWidthPx = 64, kHeightPx = 36;  // small, as shading is not what is measured

enum Kind { mirror, glass, bumpy };  // glass is looked at for holes, bumpy surfaces get tangents

RasterDevice& device() {
#ifdef PROBEBENCH_OSMESA
  static RasterDevice device(GlBackend::osmesa);
#else
  static RasterDevice device(GlBackend::egl);
#endif
  return device;
}

Material materialOf(Kind kind, Scene& scene) {
  if (kind == mirror) return makeMirrorMaterial("mirror");
  if (kind == glass) return makeGlassMaterial("glass", 1.5f);
  Material material = makeMirrorMaterial("bumpy");
  material.normalTexture = addTexture(scene, makeTexture("flat", ImageRgba(2, 2, {0.5f, 0.5f, 1.0f, 1.0f})));
  material.constants.normalSlot.offset.w = 1.0f;
  return material;
}

// One sphere of about so many triangles, with normals and texture coordinates.
void saveSphere(Kind kind, std::int64_t triangles, const std::string& path) {
  Scene scene;
  scene.environment = makeProceduralSky();
  const int rings = static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 4.0)));
  const int material = addMaterial(scene, materialOf(kind, scene));
  addInstance(scene, "sphere", finishMesh(makeSphereMesh(1.0f, 2 * rings, rings)), material);
  addCamera(scene, "camera", {0, 0, 4}, {0, 0, 0}, glm::radians(40.0f), 0.1f);
  saveGlb(scene, path);
}

// Medians of the stages' times, and of their sum.
class Stages {
 public:
  void add(const std::string& name, double ms) { times_[name].push_back(ms); }
  void report(benchmark::State& state) const {
    for (const auto& [name, ms] : times_) state.counters[name] = median(ms);
  }

 private:
  std::map<std::string, std::vector<double>> times_;
};

void load(benchmark::State& state) {
  const TemporaryFolder folder;
  const std::string path = folder.file("sphere.glb");
  saveSphere(static_cast<Kind>(state.range(0)), state.range(1), path);
  device();
  Stages stages;
  for (auto iteration : state) {
    const double cpu = cpuMs(), start = wallMs();
    const std::shared_ptr<const Scene> scene = loadScene(path);
    const std::shared_ptr<const Snapshot> snapshot =
        makeSnapshot(scene, 0, "", static_cast<double>(kWidthPx) / kHeightPx);
    const double loaded = wallMs();
    const ReferenceScene reference(snapshot);
    const double built = wallMs();
    RasterSequence sequence(device(), Technique{}, kWidthPx, kHeightPx, 1);
    sequence.renderFrame(*snapshot);
    sequence.finish();
    const double rendered = wallMs();
    stages.add("scene_ms", loaded - start);
    stages.add("embree_ms", built - loaded);
    stages.add("frame_ms", rendered - built);
    stages.add("ms", rendered - start);
    stages.add("cpu_ms", cpuMs() - cpu);
    state.SetIterationTime(1e-3 * (rendered - start));
  }
  stages.report(state);
}
BENCHMARK(load)
    ->ArgNames({"kind", "T"})
    ->ArgsProduct({{mirror, glass, bumpy}, {100'000, 1'000'000}})
    ->Iterations(5)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pb
