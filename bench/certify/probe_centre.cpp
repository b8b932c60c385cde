// Lookup from the probe's centre under a smooth sky: what the cube map returns in direction d, against the radiance the
// reference finds there and against the sky's formula.
//
// The sky's radiance is a + b d.y (for d.y >= 0). On the face +X with coordinates (s, t), d.y = -t / sqrt(1 + s^2 +
// t^2); bilinear interpolation over texels of width h = 2/R errs by at most h^2/8 (max|f_ss| + max|f_tt|), where |f_tt|
// <= 3t/(1+t^2)^(5/2) <= 0.859 (at t = 1/2) and |f_ss| <= 0.386 (at s = 0, t = 1/sqrt 2); on the face +Y, |f_ss| =
// |f_tt| <= 1 at the centre.
#include <cmath>

#include "bench/certify.h"
#include "bench/certify/common.h"

namespace pb {
namespace {

constexpr int kResolution = 64;
constexpr double kHorizon = 0.5;
constexpr double kSlope = 0.4;

Scene makeOpenSky() {
  Scene scene;
  addInstance(scene, "Probe", finishMesh(makeSphereMesh(0.1f, 16, 8)),
              addMaterial(scene, makeMirrorMaterial("Mirror")));
  scene.environment = makeLinearSky(kHorizon, kSlope);
  return scene;
}

// Directions of a Fibonacci lattice over the part of the sphere in which the sky is smooth around every texel used.
std::vector<glm::vec3> upperDirections(int count) {
  std::vector<glm::vec3> directions;
  for (int i = 0; i < count; ++i) {
    const double y = 0.05 + 0.95 * (i + 0.5) / count;
    const double phi = 2.399963229728653 * i;  // golden angle
    const double r = std::sqrt(1.0 - y * y);
    directions.emplace_back(r * std::cos(phi), y, r * std::sin(phi));
  }
  return directions;
}

}  // namespace

std::vector<Check> certifyProbeCentre(RasterDevice& device) {
  const std::shared_ptr<const Snapshot> snapshot = snapshotOf(makeOpenSky());
  Technique technique;
  technique.resolution = kResolution;
  const std::vector<ImageRgba> faces = rgbaFaces(captureProbe(device, *snapshot, technique));
  const ReferenceScene reference(snapshot);
  ReferenceSettings settings;
  settings.hiddenInstances = snapshot->probes.front().owners;

  double rasterError = 0.0, referenceError = 0.0;
  for (const glm::vec3& d : upperDirections(4096)) {
    const glm::vec3 truth(static_cast<float>(kHorizon + kSlope * static_cast<double>(d.y)));
    rasterError = std::max(rasterError, maxDifference(glm::vec3(shading::sampleCube({&faces}, d)), truth));
    referenceError = std::max(
        referenceError, maxDifference(reference.radiance(snapshot->probes.front().position, d, settings, 0), truth));
  }
  const double h = 2.0 / kResolution;
  // On a cube edge the interpolation runs over the kink between two faces, where the slope changes by at most 1 within
  // half a texel on both sides: h/4 of the slope's jump. Along an edge of +Y, d.y = 1/sqrt(2 + s^2) falls off to both
  // sides by at most 0.36 a unit.
  const double bilinear = kSlope * (h * h / 8.0 * 2.0 + h / 4.0 * 0.72);
  return {
      {"probe centre", "raster", "largest radiance error", rasterError, 0.0,
       bilinear + (kHorizon + kSlope) * kHalfRounding},
      {"probe centre", "reference", "largest radiance error", referenceError, 0.0, 2e-7},
  };
}

}  // namespace pb
