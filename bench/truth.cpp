#include "bench/truth.h"

#include <algorithm>
#include <cmath>

#include "bench/interrupt.h"
#include "bench/mask.h"

namespace pb {
namespace {

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

std::shared_ptr<const Truth> TruthMaker::make(std::shared_ptr<const Snapshot> snapshot, double exposure,
                                              std::vector<std::string>& warnings) const {
  const ReferenceScene scene(snapshot);
  const ReferenceImage image = obtainQuietEnough(snapshot, scene, warnings);
  const Image mean = image.mean();
  const Image halfA = image.half(0);
  const Grid<SampleId> ids = scene.renderIds(snapshot->camera, image_.widthPx, image_.heightPx, image_.samplesPerAxis);
  Mask mask = makeMask(*snapshot, ids);
  MetricValues maskFloor;
  if (!mask.empty()) maskFloor = computeFloor(mean, halfA, &mask);
  const MetricsSettings display{.exposure = exposure, .clampForDisplay = true};
  Grid<int> materials = materialMap(*snapshot, ids, image_.samplesPerAxis);
  return std::make_shared<const Truth>(Truth{std::move(snapshot), halfA, image.half(1), mean, noiseOf(image),
                                             std::move(materials), std::move(mask), computeFloor(mean, halfA),
                                             std::move(maskFloor), MetricsReference(mean, display)});
}

ReferenceImage TruthMaker::reference(const std::shared_ptr<const Snapshot>& snapshot,
                                     std::vector<std::string>& warnings) const {
  return obtainQuietEnough(snapshot, ReferenceScene(snapshot), warnings);
}

bool TruthMaker::isStored(const std::shared_ptr<const Snapshot>& snapshot) const {
  return store_.contains(firstRequest(snapshot));
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
                                             const ReferenceScene& scene, std::vector<std::string>& warnings) const {
  ReferenceRequest request = firstRequest(snapshot);
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

Mask TruthMaker::makeMask(const Snapshot& snapshot, const Grid<SampleId>& referenceIds) const {
  const std::vector<unsigned char> instances = specularInstances(snapshot);
  Mask mask(image_.widthPx, image_.heightPx);
  addPixelsOf(instances, rasterIds_(snapshot), image_.samplesPerAxis, mask);
  addPixelsOf(instances, referenceIds, image_.samplesPerAxis, mask);
  return anyInside(mask) ? mask : Mask();
}

}  // namespace pb
