// A rough white metal sphere in a constant environment of 1 shows the directional albedo of single-scatter GGX: what
// the microfacets' masking takes away is missing, and nothing else.
#include <fmt/format.h>

#include <cmath>

#include "bench/certify.h"
#include "bench/certify/common.h"
#include "bench/certify/microfacet_oracle.h"

namespace pb {
namespace {

constexpr int kImageSize = 64;
constexpr double kDistance = 400.0;  // so far that rays are parallel

Scene makeBall(float roughness) {
  Scene scene;
  scene.environment = makeConstantEnvironment(glm::vec3(1.0f));
  Material metal = makeMirrorMaterial("Rough white metal");
  metal.constants.kind.x = shading::kSurfaceGlossy;
  metal.constants.factors.y = roughness;
  addInstance(scene, "Ball", finishMesh(makeSphereMesh(1.0f, 256, 128)), addMaterial(scene, metal));
  addCamera(scene, "Camera", {0.0f, 0.0f, static_cast<float>(kDistance)}, glm::vec3(0.0f),
            static_cast<float>(2.0 * std::atan(1.0 / kDistance)), 0.1f);
  return scene;
}

// Mean over the pixels whose centre meets the sphere at a cosine near NoV, and what they should show.
struct Ring {
  double measured = 0.0, expected = 0.0;
};
Ring ringOf(const Image& image, double alpha, double low, double high) {
  Ring ring;
  int count = 0;
  for (int y = 0; y < kImageSize; ++y)
    for (int x = 0; x < kImageSize; ++x) {
      const glm::dvec2 p = 2.0 * glm::dvec2(x + 0.5, y + 0.5) / static_cast<double>(kImageSize) - 1.0;
      const double radiusSquared = glm::dot(p, p);
      const double NoV = radiusSquared < 1.0 ? std::sqrt(1.0 - radiusSquared) : 0.0;
      if (NoV < low || NoV > high) continue;
      const oracle::Albedo albedo = oracle::directionalAlbedo(NoV, alpha, 48);
      ring.measured += static_cast<double>(image(x, y).y);
      ring.expected += albedo.x + albedo.y;
      ++count;
    }
  ring.measured /= count;
  ring.expected /= count;
  return ring;
}

}  // namespace

std::vector<Check> certifyRoughMetal(RasterDevice& device) {
  std::vector<Check> checks;
  for (const float roughness : {0.3f, 0.6f, 1.0f}) {
    const double alpha = static_cast<double>(roughness) * static_cast<double>(roughness);
    const std::shared_ptr<const Snapshot> snapshot = snapshotOf(makeBall(roughness));
    const Image raster = renderRaster(device, *snapshot, {}, kImageSize, kImageSize, 1);
    const Image traced = ReferenceScene(snapshot)
                             .render(snapshot->camera, kImageSize, kImageSize, {.samplesPerAxis = 1, .spp = 64})
                             .mean();
    for (const auto& [low, high] : {std::pair(0.9, 1.0), std::pair(0.4, 0.6)}) {
      const std::string name =
          fmt::format("rough metal furnace, roughness {:.1f}, cosine {} to {}", roughness, low, high);
      const Ring fromRaster = ringOf(raster, alpha, low, high);
      const Ring fromReference = ringOf(traced, alpha, low, high);
      // The quadrature with 48 x 48 microfacets and the table with 64 texels a side err by 1e-3 together.
      checks.push_back({name, "raster", "mean radiance", fromRaster.measured, fromRaster.expected, 2e-3});
      // More than 600 pixels of 64 samples, each in [0, 1] and of deviation below 0.3: four standard errors are 0.006
      // at most for independent samples.
      checks.push_back({name, "reference", "mean radiance", fromReference.measured, fromReference.expected, 6e-3});
    }
  }
  return checks;
}

}  // namespace pb
