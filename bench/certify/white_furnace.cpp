// Perfect mirrors of any shape in a constant environment of 1: every path ends in the environment with throughput 1, so
// every pixel is 1, in every bounce iteration and at every depth.
#include "bench/certify.h"
#include "bench/certify/common.h"
#include "scenes/builtin/teapot_mesh.h"

namespace pb {
namespace {

Scene makeFurnace() {
  Scene scene;
  const int mirror = addMaterial(scene, makeMirrorMaterial("Mirror"));
  Node left, right;
  left.translation = {-1.5f, 0.8f, 0.0f};
  right.translation = {1.8f, 0.8f, -0.5f};
  right.scale = {0.7f, 1.4f, -0.8f};
  addInstance(scene, "Ball", finishMesh(makeSphereMesh(0.8f, 32, 16)), mirror, left);
  addInstance(scene, "Mirrored ellipsoid", finishMesh(makeSphereMesh(0.8f, 32, 16)), mirror, right);
  addInstance(scene, "Teapot", finishMesh(makeTeapotMesh(6)), mirror);
  scene.environment = makeConstantEnvironment(glm::vec3(1.0f));
  return scene;
}

double largestDeviation(const Image& image) {
  double largest = 0.0;
  for (const glm::vec3& pixel : image) largest = std::max(largest, maxDifference(pixel, glm::vec3(1.0f)));
  return largest;
}

}  // namespace

std::vector<Check> certifyWhiteFurnace(RasterDevice& device) {
  const std::shared_ptr<const Snapshot> snapshot = snapshotOf(makeFurnace());
  Technique technique;
  technique.resolution = 64;
  technique.bounces = 2;
  const Image raster = renderRaster(device, *snapshot, technique, 96, 96, 2);

  const ReferenceScene reference(snapshot);
  ReferenceSettings settings;
  settings.samplesPerAxis = 2;
  settings.depth = 12;
  // 1 is exact in half and in float, and so are its products and the box filter's means of four.
  return {
      {"white furnace", "raster", "largest deviation from 1", largestDeviation(raster), 0.0, 1e-6},
      {"white furnace", "reference", "largest deviation from 1",
       largestDeviation(reference.render(snapshot->camera, 96, 96, settings).mean()), 0.0, 1e-6},
  };
}

}  // namespace pb
