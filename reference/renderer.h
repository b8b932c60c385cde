// The truth: an Embree multi-bounce ray tracer on all cores. The same inputs give bit-identical results for any number
// of threads: every random number is a function of (seed, pixel, sample, dimension), every sum has a fixed order.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/image.h"
#include "scenes/snapshot.h"

namespace pb {

// Light that diffuse surfaces get: that of their hit point alone, or all that paths bring (global illumination).
enum class DiffuseTransport { local, traced };

// Where the numbers of paths come from: Owen-scrambled Sobol sequences, or, for comparison, independent random numbers.
enum class Sampling { sobol, independent };

struct ReferenceSettings {
  int samplesPerAxis = 4;      // S: S x S primary points on a regular grid in each pixel, box filter
  int spp = 16;                // samples of the other dimensions per primary point, even, at least 2
  std::optional<int> depth{};  // K: specular hits before a path takes the environment, unoccluded; none: converged
  DiffuseTransport diffuse = DiffuseTransport::local;
  std::optional<int> diffuseDepth{};  // N, of traced paths: diffuse bounces after which diffuse surfaces only get
                                      // direct light and the occluded sky; none: unlimited
  std::uint64_t seed = 1;
  Sampling sampling = Sampling::sobol;
  std::vector<int> hiddenInstances{};    // left out of the scene for every ray
  std::vector<int> hiddenFromPrimary{};  // for rays from the viewer, until they are reflected, refracted or scattered

  friend bool operator==(const ReferenceSettings&, const ReferenceSettings&) = default;
};

// Version of the integrator: changes whenever a picture may change. Part of the store's keys.
inline constexpr int kIntegratorVersion = 7;

// Independent batches of samples (at most kMaxBatches, min(spp, kMaxBatches) of them, an even number), each the mean of
// its samples.
inline constexpr int kMaxBatches = 16;

// Samples per primary point, by pixel.
using SampleMap = Grid<int>;

struct RecordedRays;  // reference/ray_log.h

struct ReferenceImage {
  std::vector<Image> batches;
  std::int64_t raysTraced = 0;

  Image mean() const;           // of all batches, in fixed order
  Image half(int which) const;  // mean of the even (0) or the odd (1) batches
};

class ReferenceScene {
 public:
  // Builds the acceleration structure. Throws an environment Error if Embree can't.
  explicit ReferenceScene(std::shared_ptr<const Snapshot> snapshot);
  ~ReferenceScene();
  ReferenceScene(const ReferenceScene&) = delete;
  ReferenceScene& operator=(const ReferenceScene&) = delete;

  // Any view: the snapshot's camera, or a cube face. Called from any thread; uses TBB inside.
  // Throws Error(Failure::interrupted) soon after `cancelled` (if given) becomes true. `samples` (if given) takes the
  // place of settings.spp, of which its numbers must be multiples.
  ReferenceImage render(const shading::View& view, int widthPx, int heightPx, const ReferenceSettings& settings,
                        const std::atomic<bool>* cancelled = nullptr, const SampleMap* samples = nullptr) const;

  // Appends the rays with which render() looks for surfaces, tile by tile as one thread does it. For measuring.
  void recordRays(const shading::View& view, int widthPx, int heightPx, const ReferenceSettings& settings,
                  RecordedRays& rays) const;

  // What each primary sample shows: (width * S) x (height * S).
  Grid<SampleId> renderIds(const shading::View& view, int widthPx, int heightPx, int samplesPerAxis) const;

  // Distances in metres along the view's axis to what rays through the pixels' centres meet, which are surfaces with
  // any coverage, except for the hidden instances; infinity: nothing.
  Plane renderDistances(const shading::View& view, int widthPx, int heightPx,
                        const std::vector<int>& hiddenInstances) const;

  // Radiance along one ray; for tests of closed forms. `direction` need not be normalised.
  glm::vec3 radiance(glm::vec3 origin, glm::vec3 direction, const ReferenceSettings& settings,
                     std::uint64_t sample) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

std::string embreeVersion();

}  // namespace pb
