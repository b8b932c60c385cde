// A mirror sphere under the sky a + b max(d.y, 0), against the exact sphere in double precision.
//
// What may differ: the sphere is tessellated (segments of angle delta: positions are inside by r delta^2/8, which turns
// the interpolated normal by up to delta^2/8 times the slope of the surface against the ray; reflection doubles the
// turn), and the raster's map is bilinear with a kink at the horizon (b h/4, h the texel's width) and rounded to half
// precision.
#include <cmath>

#include "bench/certify.h"
#include "bench/certify/common.h"

namespace pb {
namespace {

constexpr int kSegments = 512;
constexpr int kResolution = 512;
constexpr int kImageSize = 128;
constexpr double kHorizon = 0.4;
constexpr double kSlope = 0.5;
constexpr double kDistance = 5.0;
// Pixels whose ray meets the sphere at a smaller cosine are left to the silhouette.
constexpr double kSmallestCosine = 0.3;

Scene makeBall() {
  Scene scene;
  scene.environment = makeLinearSky(kHorizon, kSlope);
  addInstance(scene, "Ball", finishMesh(makeSphereMesh(1.0f, kSegments, kSegments / 2)),
              addMaterial(scene, makeMirrorMaterial("Mirror")));
  addCamera(scene, "Camera", {0.0f, 0.0f, static_cast<float>(kDistance)}, glm::vec3(0.0f), 0.45f, 0.1f);
  return scene;
}

struct Expected {
  bool certain;  // far enough from the silhouette
  double radiance;
};

Expected exactRadiance(const shading::View& view, int x, int y) {
  const glm::dvec2 st = 2.0 * glm::dvec2(x + 0.5, y + 0.5) / static_cast<double>(kImageSize) - 1.0;
  const glm::dvec3 origin = glm::vec3(view.origin);
  const glm::dvec3 d = glm::normalize(glm::dvec3(glm::vec3(view.forward)) + st.x * glm::dvec3(glm::vec3(view.right)) +
                                      st.y * glm::dvec3(glm::vec3(view.down)));
  const double b = glm::dot(origin, d);
  const double discriminant = b * b - glm::dot(origin, origin) + 1.0;
  if (discriminant <= 0.0) return {false, 0.0};
  const glm::dvec3 n = glm::normalize(origin + (-b - std::sqrt(discriminant)) * d);
  const double cosine = -glm::dot(d, n);
  const glm::dvec3 r = d + 2.0 * cosine * n;
  return {cosine >= kSmallestCosine, kHorizon + kSlope * std::max(r.y, 0.0)};
}

double largestError(const Image& image, const shading::View& view) {
  double largest = 0.0;
  for (int y = 0; y < kImageSize; ++y)
    for (int x = 0; x < kImageSize; ++x)
      if (const Expected expected = exactRadiance(view, x, y); expected.certain)
        largest = std::max(largest, std::abs(static_cast<double>(image(x, y).y) - expected.radiance));
  return largest;
}

}  // namespace

std::vector<Check> certifyMirrorBall(RasterDevice& device) {
  const std::shared_ptr<const Snapshot> snapshot = snapshotOf(makeBall());
  Technique technique;
  technique.resolution = kResolution;
  const Image raster = renderRaster(device, *snapshot, technique, kImageSize, kImageSize, 1);
  const ReferenceScene reference(snapshot);
  ReferenceSettings settings;
  settings.samplesPerAxis = 1;
  settings.spp = 2;
  const Image traced = reference.render(snapshot->camera, kImageSize, kImageSize, settings).mean();

  const double delta = 2.0 * 3.14159265358979 / kSegments;
  const double tangent = std::sqrt(1.0 - kSmallestCosine * kSmallestCosine) / kSmallestCosine;
  const double tessellation = kSlope * 2.0 * (1.0 + tangent) * delta * delta / 8.0;
  const double bilinear = kSlope * 2.0 / kResolution / 4.0;
  return {
      {"mirror ball", "raster", "largest radiance error", largestError(raster, snapshot->camera), 0.0,
       tessellation + bilinear + (kHorizon + kSlope) * kHalfRounding},
      {"mirror ball", "reference", "largest radiance error", largestError(traced, snapshot->camera), 0.0,
       tessellation + 1e-6},
  };
}

}  // namespace pb
