#include "reference/renderer.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <mutex>

#include "reference/embree_scene.h"
#include "reference/film.h"
#include "reference/integrator.h"
#include "reference/light_sampler.h"
#include "reference/paths_of_ray.h"
#include "reference/ray_log.h"
#include "reference/sampler.h"
#include "scenes/error.h"

namespace pb {
namespace {

void checkSize(int widthPx, int heightPx, int samplesPerAxis) {
  if (widthPx < 1 || heightPx < 1)
    throwInputError("an image needs at least one pixel each way, got {} x {}", widthPx, heightPx);
  if (samplesPerAxis < 1) throwInputError("a pixel needs at least one sample each way, got {}", samplesPerAxis);
}

void checkSampling(const ReferenceSettings& settings) {
  if (settings.spp < 2 || settings.spp % 2 != 0)
    throwInputError("reference.spp must be an even number of at least 2, got {}", settings.spp);
}

void checkDepth(const ReferenceSettings& settings) {
  if (settings.depth && *settings.depth < 1)
    throwInputError("reference.depth must be at least 1 or \"converged\", got {}", *settings.depth);
  if (settings.diffuseDepth && *settings.diffuseDepth < 0)
    throwInputError("reference.diffuse_depth must be at least 0, or left out for no limit, got {}",
                    *settings.diffuseDepth);
}

HiddenInstances hiddenFlags(const Snapshot& snapshot, const std::vector<int>& hidden) {
  if (hidden.empty()) return {};
  HiddenInstances flags(snapshot.instances.size(), 0);
  for (const int instance : hidden) {
    if (instance < 0 || static_cast<std::size_t>(instance) >= flags.size())
      throwInputError("hidden instances must be instances of the scene, 0 to {}, got {}",
                      static_cast<int>(flags.size()) - 1, instance);
    flags[static_cast<std::size_t>(instance)] = 1;
  }
  return flags;
}

// The bits of a number below 2^16 at the even places.
std::uint32_t spreadBits(std::uint32_t v) {
  v = (v | v << 8) & 0x00ff00ffu;
  v = (v | v << 4) & 0x0f0f0f0fu;
  v = (v | v << 2) & 0x33333333u;
  return (v | v << 1) & 0x55555555u;
}

// Interleaved bits of two numbers below 2^16.
std::uint32_t mortonCode(int x, int y) {
  return spreadBits(static_cast<std::uint32_t>(x)) | spreadBits(static_cast<std::uint32_t>(y)) << 1;
}

// Rays through the centres of a regular grid of samples, one a sample of the raster.
class PrimaryRays {
 public:
  PrimaryRays(const shading::View& view, int columns, int rows)
      : view_(withResolution(view, columns)), columns_(columns), rows_(rows) {}

  // The direction's component along the view's axis is 1: distances along the ray are those of the near plane.
  Ray ray(int column, int row) const {
    const auto coordinate = [](int i, int n) {
      return 2.0f * (static_cast<float>(i) + 0.5f) / static_cast<float>(n) - 1.0f;
    };
    return {.origin = glm::vec3(view_.origin),
            .direction = shading::viewDirection(view_, {coordinate(column, columns_), coordinate(row, rows_)}),
            .tNear = view_.origin.w};
  }

  std::uint32_t index(int column, int row) const {
    return static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(columns_) + static_cast<std::uint32_t>(column);
  }

  // Of the pixel that holds samplesPerAxis x samplesPerAxis of the rays.
  std::uint32_t pixelIndex(int x, int y, int samplesPerAxis) const {
    return static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(columns_ / samplesPerAxis) +
           static_cast<std::uint32_t>(x);
  }

  float conePerMetre() const { return view_.forward.w; }

 private:
  shading::View view_;
  int columns_;
  int rows_;
};

// One picture: the scene as this call sees it, the settings, and where the rays start.
template <class RayLog>
struct Rendering {
  TracedScene scene;
  const ReferenceSettings& settings;
  PrimaryRays primaries;
  const SampleMap* samples;  // null: settings.spp everywhere
  [[no_unique_address]] RayLog log{};

  // The sequences of a pixel's halves.
  using Halves = std::array<SobolScrambles, 2>;
  Halves halvesOf(int x, int y) const {
    const std::uint32_t pixel = primaries.pixelIndex(x, y, settings.samplesPerAxis);
    return {SobolScrambles(settings.seed, pixel, 0), SobolScrambles(settings.seed, pixel, 1)};
  }

  // All samples of one primary point; returns the number of rays. Each half of a pixel is one sequence: a point takes
  // consecutive members, and the points follow each other in Morton's order, so that squares of points, too, are
  // stratified.
  std::int64_t addPoint(int column, int row, int spp, Halves& halves, PixelBatches& pixel) const {
    const int n = settings.samplesPerAxis;
    const std::uint32_t point = primaries.index(column, row);
    const std::uint32_t firstMember =
        mortonCode(column % n, row % n) * std::bit_ceil(static_cast<std::uint32_t>(spp / 2));
    const auto sampler = [&](int half, int i) -> Sampler {
      const auto h = static_cast<std::uint32_t>(half), sample = static_cast<std::uint32_t>(i);
      if (settings.sampling == Sampling::independent) return {settings.seed, point, std::uint64_t{2} * sample + h};
      return {halves[h], firstMember + sample};
    };

    BasicPathsOfRay<RayLog> paths(scene, primaries.ray(column, row), primaries.conePerMetre(), settings, log);
    Sampler firstSampler = sampler(0, 0);
    const PathResult first = paths.trace(firstSampler);
    std::int64_t rays = first.rays;
    if (paths.areCertain()) {
      pixel.addPoint(first.radiance);
      return rays;
    }
    pixel.addPoint(spp, [&](int half, int i) {
      if (half == 0 && i == 0) return first.radiance;
      Sampler next = sampler(half, i);
      const PathResult path = paths.trace(next);
      rays += path.rays;
      return path.radiance;
    });
    return rays;
  }

  std::int64_t addPixel(int x, int y, std::vector<Image>& batches) const {
    const int n = settings.samplesPerAxis;
    const int spp = samples != nullptr ? (*samples)(x, y) : settings.spp;
    PixelBatches pixel(static_cast<int>(batches.size()));
    Halves halves = halvesOf(x, y);
    std::int64_t rays = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) rays += addPoint(x * n + i, y * n + j, spp, halves, pixel);
    for (std::size_t b = 0; b < batches.size(); ++b) batches[b](x, y) = pixel.batch(static_cast<int>(b));
    return rays;
  }

  std::int64_t addTile(const Tile& tile, std::vector<Image>& batches) const {
    std::int64_t rays = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) rays += addPixel(x, y, batches);
    return rays;
  }
};

}  // namespace

struct ReferenceScene::Impl {
  explicit Impl(std::shared_ptr<const Snapshot> snapshot_)
      : snapshot(std::move(snapshot_)), embree(*snapshot), dark(findDarkInstances(*snapshot)) {}

  TracedScene without(const std::vector<int>& hidden, const std::vector<int>& hiddenFromPrimary) const {
    std::vector<int> all = hidden;
    all.insert(all.end(), hiddenFromPrimary.begin(), hiddenFromPrimary.end());
    return {*snapshot, embree, hiddenFlags(*snapshot, hidden), hiddenFlags(*snapshot, all)};
  }

  // The scene where paths will look for light; what that takes is made when it is first needed.
  TracedScene litFor(const ReferenceSettings& settings) const {
    std::call_once(lightsMade, [&] { lights = std::make_unique<LightSampler>(*snapshot); });
    TracedScene scene = without(settings.hiddenInstances, settings.hiddenFromPrimary);
    if (!lights->empty()) scene.lights = lights.get();
    scene.dark = dark;
    scene.isAllDark = std::ranges::all_of(dark, [](unsigned char d) { return d != 0; });
    return scene;
  }

  std::shared_ptr<const Snapshot> snapshot;
  EmbreeScene embree;
  std::vector<unsigned char> dark;
  mutable std::once_flag lightsMade;
  mutable std::unique_ptr<LightSampler> lights;
};

ReferenceScene::ReferenceScene(std::shared_ptr<const Snapshot> snapshot)
    : impl_(std::make_unique<Impl>(std::move(snapshot))) {}
ReferenceScene::~ReferenceScene() = default;

ReferenceImage ReferenceScene::render(const shading::View& view, int widthPx, int heightPx,
                                      const ReferenceSettings& settings, const std::atomic<bool>* cancelled,
                                      const SampleMap* samples) const {
  checkSize(widthPx, heightPx, settings.samplesPerAxis);
  checkSampling(settings);
  checkDepth(settings);
  assert(samples == nullptr || (samples->width() == widthPx && samples->height() == heightPx));
  const int n = settings.samplesPerAxis;
  const Rendering<NoRayLog> rendering{impl_->litFor(settings), settings, PrimaryRays(view, widthPx * n, heightPx * n),
                                      samples};
  ReferenceImage image;
  image.batches.assign(static_cast<std::size_t>(std::min(settings.spp, kMaxBatches)), Image(widthPx, heightPx));
  std::atomic<std::int64_t> rays = 0;  // of whole numbers: the order of adding doesn't matter
  forEachTile(widthPx, heightPx, cancelled, [&](const Tile& tile) { rays += rendering.addTile(tile, image.batches); });
  image.raysTraced = rays;
  return image;
}

void ReferenceScene::recordRays(const shading::View& view, int widthPx, int heightPx, const ReferenceSettings& settings,
                                RecordedRays& rays) const {
  const int n = settings.samplesPerAxis;
  const Rendering<RayLog> rendering{impl_->litFor(settings), settings, PrimaryRays(view, widthPx * n, heightPx * n),
                                    nullptr, RayLog{&rays}};
  std::vector<Image> batches(static_cast<std::size_t>(std::min(settings.spp, kMaxBatches)), Image(widthPx, heightPx));
  tbb::task_arena(1).execute(
      [&] { forEachTile(widthPx, heightPx, nullptr, [&](const Tile& tile) { rendering.addTile(tile, batches); }); });
}

Grid<SampleId> ReferenceScene::renderIds(const shading::View& view, int widthPx, int heightPx,
                                         int samplesPerAxis) const {
  checkSize(widthPx, heightPx, samplesPerAxis);
  const TracedScene scene = impl_->without({}, {});
  Grid<SampleId> ids(widthPx * samplesPerAxis, heightPx * samplesPerAxis);
  const PrimaryRays primaries(view, ids.width(), ids.height());
  forEachTile(ids.width(), ids.height(), nullptr, [&](const Tile& tile) {
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x)
        ids(x, y) = identify(scene, primaries.ray(x, y), primaries.conePerMetre());
  });
  return ids;
}

Plane ReferenceScene::renderDistances(const shading::View& view, int widthPx, int heightPx,
                                      const std::vector<int>& hiddenInstances) const {
  checkSize(widthPx, heightPx, 1);
  const TracedScene scene = impl_->without(hiddenInstances, {});
  Plane distances(widthPx, heightPx);
  const PrimaryRays primaries(view, widthPx, heightPx);
  forEachTile(widthPx, heightPx, nullptr, [&](const Tile& tile) {
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x)
        distances(x, y) = distanceAlong(scene, primaries.ray(x, y), primaries.conePerMetre());
  });
  return distances;
}

glm::vec3 ReferenceScene::radiance(glm::vec3 origin, glm::vec3 direction, const ReferenceSettings& settings,
                                   std::uint64_t sample) const {
  checkDepth(settings);
  Sampler sampler(settings.seed, 0, sample);
  return tracePath(impl_->litFor(settings), {origin, direction}, 0.0f, settings, sampler).radiance;
}

}  // namespace pb
