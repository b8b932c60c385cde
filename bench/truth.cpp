#include "bench/truth.h"

#include <algorithm>
#include <cmath>

#include "bench/bounce_depth.h"
#include "bench/instance_map.h"
#include "bench/interrupt.h"
#include "bench/mask.h"

namespace pb {
namespace {

// Above it what MetricsReference keeps of each depth would fill the memory: 200 bytes a pixel at ten exposures.
constexpr std::size_t kMostPreparedPixels = 256 * 1024;

// relMSE of the noise of a reference's mean.
double noiseOf(const ReferenceImage& image) { return computeErrorSums(image.mean(), image.half(0)).relmse; }

bool anyInside(const Mask& mask) {
  return std::ranges::any_of(mask, [](unsigned char inside) { return inside != 0; });
}

}  // namespace

// The mean M is (A+B)/2, so A - M is (A-B)/2: the error of A against M is the floor of M.
MetricValues computeFloor(const Image& mean, const Image& halfA, const Mask* mask) {
  const ErrorSums sums = computeErrorSums(mean, halfA, mask);
  return {{"mse", sums.mse}, {"relmse", sums.relmse}};
}

int mostSpp(const TruthSettings& settings) {
  int spp = settings.spp;
  while (2 * spp <= kMaxSpp) spp *= 2;
  return spp;
}

std::vector<std::string> describeNoisyReferences(const std::vector<CellResult>& cells, const TruthSettings& settings) {
  std::vector<std::string> sentences;
  for (const NoisyReference& noisy : findNoisyReferences(cells, settings.maxNoise))
    sentences.push_back(
        fmt::format("max_noise is {:g}, but the reference of {} frame {} has {:.3g} at up to {} samples",
                    *settings.maxNoise, noisy.scene, noisy.frame, noisy.noise, mostSpp(settings)));
  return sentences;
}

MetricsResult TruncatedTruth::compare(const Image& test, const Mask* mask) const {
  return (prepared ? *prepared : MetricsReference(mean, display)).compare(test, mask);
}

std::shared_ptr<const Truth> TruthMaker::make(std::shared_ptr<const Snapshot> snapshot, double exposure,
                                              std::vector<std::string>& warnings, const std::set<int>& depths) const {
  const ReferenceScene scene(snapshot);
  const ReferenceImage image = obtainQuietEnough(snapshot, scene, settings_.depth, warnings);
  const Image mean = image.mean();
  const Image halfA = image.half(0);
  const Grid<SampleId> ids = scene.renderIds(snapshot->camera, image_.widthPx, image_.heightPx, image_.samplesPerAxis);
  const Grid<SampleId> rasterIds = rasterIds_(*snapshot);
  Mask mask = makeMask(*snapshot, ids, rasterIds);
  MetricValues maskFloor;
  if (!mask.empty()) maskFloor = computeFloor(mean, halfA, &mask);
  const MetricsSettings display{.exposure = exposure, .clampForDisplay = true};
  Grid<int> materials = materialMap(*snapshot, ids, image_.samplesPerAxis);
  auto truth = std::make_shared<Truth>(Truth{snapshot, halfA, image.half(1), mean, noiseOf(image), std::move(materials),
                                             std::move(mask), computeFloor(mean, halfA), std::move(maskFloor),
                                             MetricsReference(mean, display)});
  truth->objects = makeObjectMap(*snapshot, scene, ids, rasterIds);
  truth->raysTraced = image.raysTraced;
  truth->truncated = makeTruncated(*truth, scene, display, depths, warnings);
  return truth;
}

ReferenceImage TruthMaker::reference(const std::shared_ptr<const Snapshot>& snapshot,
                                     std::vector<std::string>& warnings) const {
  return obtainQuietEnough(snapshot, ReferenceScene(snapshot), settings_.depth, warnings);
}

bool TruthMaker::isStored(const std::shared_ptr<const Snapshot>& snapshot, std::optional<int> depth) const {
  ReferenceRequest request = firstRequest(snapshot);
  request.settings.depth = depth;
  return store_.contains(request);
}

ReferenceRequest TruthMaker::firstRequest(const std::shared_ptr<const Snapshot>& snapshot) const {
  ReferenceRequest request{snapshot, image_.widthPx, image_.heightPx, {}};
  request.settings.samplesPerAxis = image_.samplesPerAxis;
  request.settings.depth = settings_.depth;
  request.settings.diffuse = settings_.diffuse;
  request.settings.diffuseDepth = settings_.diffuseDepth;
  request.settings.spp = settings_.spp;
  return request;
}

// Depths rise: as soon as one has all that the converged truth has, those beyond it do.
std::map<int, TruncatedTruth> TruthMaker::makeTruncated(const Truth& truth, const ReferenceScene& scene,
                                                        const MetricsSettings& display, const std::set<int>& depths,
                                                        std::vector<std::string>& warnings) const {
  std::map<int, TruncatedTruth> truncated;
  bool converged = false;
  for (const int depth : depths) {
    TruncatedTruth& made = truncated[depth];
    converged = converged || depth >= settings_.depth.value_or(kMaxMatchedDepth + 1);
    if (!converged) {
      const ReferenceImage image = obtainQuietEnough(truth.snapshot, scene, depth, warnings);
      made.mean = image.mean();
      converged = made.mean == truth.mean;
      if (!converged) {
        made.floor = computeFloor(made.mean, image.half(0));
        if (!truth.mask.empty()) made.maskFloor = computeFloor(made.mean, image.half(0), &truth.mask);
        made.display = display;
        if (made.mean.size() <= kMostPreparedPixels) made.prepared.emplace(made.mean, display);
      }
    }
    made.converged = converged;
    if (converged) made.mean = Image();
  }
  return truncated;
}

ReferenceImage TruthMaker::obtain(const ReferenceRequest& request, const ReferenceScene& scene,
                                  std::vector<std::string>& warnings) const {
  std::string warning;
  if (std::optional<ReferenceImage> stored = store_.load(request, warning)) return *std::move(stored);
  if (!warning.empty()) warnings.push_back(warning);
  ReferenceSettings settings = request.settings;
  // Passes are independent of each other: a sample map and the samples that it asks for must not depend on each other.
  if (request.refinement) settings.seed += static_cast<std::uint64_t>(request.refinement->pass);
  ReferenceImage image =
      scene.render(request.snapshot->camera, request.widthPx, request.heightPx, settings, &interruptRequested(),
                   request.refinement ? &request.refinement->samples : nullptr);
  store_.save(request, image);
  return image;
}

ReferenceImage TruthMaker::obtainQuietEnough(const std::shared_ptr<const Snapshot>& snapshot,
                                             const ReferenceScene& scene, std::optional<int> depth,
                                             std::vector<std::string>& warnings) const {
  ReferenceRequest request = firstRequest(snapshot);
  request.settings.depth = depth;
  ReferenceImage image = obtain(request, scene, warnings);
  if (!settings_.maxNoise) return image;
  const AdaptiveGoal goal{*settings_.maxNoise, mostSpp(settings_)};
  SampleMap samples(image_.widthPx, image_.heightPx, settings_.spp);
  for (int pass = 1; noiseOf(image) > goal.maxNoise; ++pass) {
    // What was planned and missed has rare bright paths, of which the pilot told too little: ask for more than before.
    const double asked = goal.maxNoise / std::pow(1.5, pass - 1);
    SampleMap planned = planSamples(image, samples, {asked, goal.maxSpp});
    if (planned == samples) break;  // at the limit
    samples = std::move(planned);
    request.refinement = Refinement{pass, goal, samples};
    image = obtain(request, scene, warnings);
  }
  return image;
}

Mask TruthMaker::makeMask(const Snapshot& snapshot, const Grid<SampleId>& referenceIds,
                          const Grid<SampleId>& rasterIds) const {
  const std::vector<unsigned char> instances = specularInstances(snapshot);
  Mask mask(image_.widthPx, image_.heightPx);
  addPixelsOf(instances, rasterIds, image_.samplesPerAxis, mask);
  addPixelsOf(instances, referenceIds, image_.samplesPerAxis, mask);
  return anyInside(mask) ? mask : Mask();
}

ObjectMap TruthMaker::makeObjectMap(const Snapshot& snapshot, const ReferenceScene& scene,
                                    const Grid<SampleId>& referenceIds, const Grid<SampleId>& rasterIds) const {
  const shading::View& camera = snapshot.camera;
  const int width = image_.widthPx, height = image_.heightPx;
  ObjectMap map{.inReference = instanceMap(referenceIds, image_.samplesPerAxis),
                .inRaster = instanceMap(rasterIds, image_.samplesPerAxis),
                .atCentre = instanceMap(scene.renderIds(camera, width, height, 1), 1),
                .positions = Grid<glm::vec3>(width, height)};
  const Plane distances = scene.renderDistances(camera, width, height, {});
  const auto coordinate = [](int i, int n) {
    return 2.0f * (static_cast<float>(i) + 0.5f) / static_cast<float>(n) - 1.0f;
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (map.atCentre(x, y) >= 0)
        map.positions(x, y) =
            glm::vec3(camera.origin) +
            distances(x, y) * shading::viewDirection(camera, {coordinate(x, width), coordinate(y, height)});
  return map;
}

}  // namespace pb
