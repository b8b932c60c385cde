// Two large parallel mirrors of reflectance rho that emit e, in an environment of radiance l.
//
// Seen along the normal, a mirror shows e plus rho times what it faces. After K reflections the truncated truth takes
// the environment: L(K) = e (1 - rho^K) / (1 - rho) + rho^K l, and L(inf) = e / (1 - rho). A cube map that was captured
// when the other mirror showed L(k) holds L(k+1): with simultaneous captures both mirrors' maps hold L(b) after b
// iterations; with sequential ones the first mirror's map holds L(2b-1) and the second's L(2b). (With Schlick's Fresnel
// term the reflectance along the normal is rho.)
#include <fmt/format.h>

#include <cmath>

#include "bench/certify.h"
#include "bench/certify/common.h"

namespace pb {
namespace {

constexpr double kReflectance = 0.8;
constexpr double kEmission = 0.3;
constexpr double kEnvironment = 2.0;

double series(int reflections) {
  const double tail = std::pow(kReflectance, reflections);
  return kEmission * (1.0 - tail) / (1.0 - kReflectance) + tail * kEnvironment;
}

Scene makeFacingMirrors() {
  Scene scene;
  Material mirror = makeMirrorMaterial("Mirror", glm::vec3(static_cast<float>(kReflectance)));
  mirror.constants.emission = glm::vec4(glm::vec3(static_cast<float>(kEmission)), 1.0f);
  const int material = addMaterial(scene, std::move(mirror));
  addInstance(scene, "Left", finishMesh(makeQuadMesh({-1, -20, 20}, {0, 0, -40}, {0, 40, 0})), material);  // faces +X
  addInstance(scene, "Right", finishMesh(makeQuadMesh({1, -20, -20}, {0, 0, 40}, {0, 40, 0})), material);  // faces -X
  addCamera(scene, "Camera", glm::vec3(0.0f), {-1.0f, 0.0f, 0.0f}, 0.02f, 0.01f);
  scene.environment = makeConstantEnvironment(glm::vec3(static_cast<float>(kEnvironment)));
  return scene;
}

double centreOf(const Image& image) { return static_cast<double>(image(image.width() / 2, image.height() / 2).y); }

void addRasterChecks(RasterDevice& device, const Snapshot& snapshot, BounceOrder order, int iterations,
                     std::vector<Check>& checks) {
  Technique technique;
  technique.resolution = 64;
  technique.bounces = iterations;
  technique.feedback = Feedback::sky;
  technique.bounceOrder = order;
  RasterSequence sequence(device, technique, 9, 9, 1);
  sequence.renderFrame(snapshot);
  const bool simultaneous = order == BounceOrder::simultaneous;
  const std::string name =
      fmt::format("facing mirrors, {}, {} iteration{}", simultaneous ? "simultaneous" : "sequential", iterations,
                  iterations == 1 ? "" : "s");
  // Each stored map rounds to half precision, and rounding errors of earlier maps come back multiplied by rho: a
  // geometric series.
  const double tolerance = kHalfRounding * std::max(kEnvironment, series(1000)) / (1.0 - kReflectance);
  const int terms[2] = {simultaneous ? iterations : 2 * iterations - 1, simultaneous ? iterations : 2 * iterations};
  checks.push_back(
      {name, "raster", "map of the first mirror", centreOf(sequence.readProbe(0)[0]), series(terms[0]), tolerance});
  checks.push_back(
      {name, "raster", "map of the second mirror", centreOf(sequence.readProbe(1)[1]), series(terms[1]), tolerance});
  checks.push_back({name, "raster", "image", centreOf(sequence.readImage()), series(terms[0] + 1), tolerance});
}

}  // namespace

std::vector<Check> certifyFacingMirrors(RasterDevice& device) {
  const std::shared_ptr<const Snapshot> snapshot = snapshotOf(makeFacingMirrors());
  std::vector<Check> checks;
  for (const BounceOrder order : {BounceOrder::sequential, BounceOrder::simultaneous})
    for (const int iterations : {1, 2, 3}) addRasterChecks(device, *snapshot, order, iterations, checks);

  const ReferenceScene reference(snapshot);
  ReferenceSettings settings;
  settings.samplesPerAxis = 1;
  for (const int depth : {1, 2, 3, 6}) {
    settings.depth = depth;
    const double found = centreOf(reference.render(snapshot->camera, 9, 9, settings).mean());
    // A product of `depth` float factors.
    checks.push_back({fmt::format("facing mirrors, depth {}", depth), "reference", "image", found, series(depth),
                      1e-6 * (depth + 1)});
  }
  settings.depth.reset();
  settings.spp = 256;
  const ReferenceImage converged = reference.render(snapshot->camera, 9, 9, settings);
  // Each pixel's own standard error from the batches' spread, and four of them: 6e-5 chance of a false alarm.
  double sum = 0.0, sumOfSquares = 0.0;
  for (const Image& batch : converged.batches) {
    const double value = centreOf(batch);
    sum += value;
    sumOfSquares += value * value;
  }
  const auto n = static_cast<double>(converged.batches.size());
  const double variance = std::max(0.0, (sumOfSquares - sum * sum / n) / (n - 1.0));
  checks.push_back(
      {"facing mirrors, converged", "reference", "image", sum / n, series(1000), 4.0 * std::sqrt(variance / n) + 1e-5});
  return checks;
}

}  // namespace pb
