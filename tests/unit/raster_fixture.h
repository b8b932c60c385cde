// Small scenes and the fixture of the rasteriser's tests: each test runs on both GL backends.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "raster/device.h"
#include "raster/renderer.h"
#include "scenes/builtin.h"
#include "scenes/builtin/shapes.h"
#include "scenes/environment.h"
#include "scenes/snapshot.h"

namespace pb {

#ifdef PROBEBENCH_OSMESA
inline constexpr bool kHasOsmesa = true;
#else
inline constexpr bool kHasOsmesa = false;
#endif

inline const glm::vec3 kRed(1.0f, 0.0f, 0.0f), kBlue(0.0f, 0.0f, 1.0f), kWhite(1.0f), kBlack(0.0f);

inline Material makeUnlit(glm::vec3 radiance) {
  Material material = makeDiffuseMaterial("unlit", radiance);
  material.constants.kind.x = shading::kSurfaceUnlit;
  return material;
}

inline void addBox(Scene& scene, glm::vec3 centre, glm::vec3 edges, Material material) {
  Node node;
  node.translation = centre;
  addInstance(scene, "box", finishMesh(makeBoxMesh(edges)), addMaterial(scene, std::move(material)), node);
}

// Looks along -Z from z = 3.
inline Scene makeEmptyScene(glm::vec3 environment) {
  Scene scene;
  scene.environment = makeConstantEnvironment(environment);
  addCamera(scene, "camera", glm::vec3(0, 0, 3), glm::vec3(0), 0.8f, 0.1f);
  return scene;
}

inline std::shared_ptr<const Snapshot> snapshotOf(Scene scene, double aspect = 1.0) {
  finishScene(scene);
  return makeSnapshot(std::make_shared<const Scene>(std::move(scene)), 0, "", aspect);
}

inline std::shared_ptr<const Snapshot> snapshotOf(const std::string& builtin, int frame = 0) {
  return makeSnapshot(std::make_shared<const Scene>(makeBuiltinScene(parseSpec(builtin))), frame, "", 16.0 / 9.0);
}

inline Technique withResolution(int resolution) {
  Technique technique;
  technique.resolution = resolution;
  return technique;
}

inline glm::vec3 centreOf(const Image& image) { return image(image.width() / 2, image.height() / 2); }

inline float largestDifference(const Image& a, const Image& b) {
  EXPECT_EQ(a.width(), b.width());
  EXPECT_EQ(a.height(), b.height());
  float largest = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::vec3 d = glm::abs(a[i] - b[i]);
    largest = std::max({largest, d.x, d.y, d.z});
  }
  return largest;
}

inline Scene makeBall(glm::vec3 environment, Material material) {
  Scene scene = makeEmptyScene(environment);
  addInstance(scene, "ball", finishMesh(makeSphereMesh(0.8f, 32, 16)), addMaterial(scene, std::move(material)));
  return scene;
}

inline Material makeGlass(float ior) { return makeGlassMaterial("glass", ior); }

class RasterTest : public testing::TestWithParam<GlBackend> {
 protected:
  // Shared by the tests, given back before the process ends: OSMesa takes itself down at exit, before static objects
  // go.
  static RasterDevice& deviceOf(GlBackend backend) {
    std::unique_ptr<RasterDevice>& device = devices_[backend];
    if (!device) device = std::make_unique<RasterDevice>(backend);
    return *device;
  }
  static void TearDownTestSuite() { devices_.clear(); }

  void SetUp() override {
    if (GetParam() == GlBackend::osmesa && !kHasOsmesa) GTEST_SKIP() << "this build has no OSMesa backend";
  }
  RasterDevice& device() { return deviceOf(GetParam()); }

  Image render(const Snapshot& snapshot, const Technique& technique = withResolution(32), int width = 64,
               int height = 64, int samplesPerAxis = 1) {
    RasterSequence sequence(device(), technique, width, height, samplesPerAxis);
    sequence.renderFrame(snapshot);
    return sequence.readImage();
  }

 private:
  static inline std::map<GlBackend, std::unique_ptr<RasterDevice>> devices_;
};

inline const auto kBackends = testing::Values(GlBackend::osmesa, GlBackend::egl);

inline std::string nameOfBackend(const testing::TestParamInfo<GlBackend>& test) {
  return test.param == GlBackend::osmesa ? "Osmesa" : "Egl";
}

}  // namespace pb
