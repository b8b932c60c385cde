// Limits of the shading model: inputs at which its formulae leave the finite or the physical.
#include "scenes/shading/shading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/scene.h"

namespace pb {
namespace {

using glm::vec3;
using glm::vec4;

// At grazing incidence everything reflects; with eta = 1 and k = 0 the equations themselves say 0 / 0 there.
TEST(Shading, ConductorLikeTheAirAroundIt_ReflectsNothingAndIsNeverNaN) {
  EXPECT_EQ(shading::F_ConductorChannel(0.0f, 1.0f, 0.0f), 1.0f);
  EXPECT_EQ(shading::F_ConductorChannel(1.0f, 1.0f, 0.0f), 0.0f);
  constexpr int kSteps = 1000;
  for (int i = 0; i <= kSteps; ++i) {
    const float cosine = static_cast<float>(i) / kSteps;
    const float reflectance = shading::F_ConductorChannel(cosine, 1.0f, 0.0f);
    EXPECT_TRUE(std::isfinite(reflectance)) << cosine;
    EXPECT_GE(reflectance, 0.0f) << cosine;
    EXPECT_LE(reflectance, 1.0f) << cosine;
  }
}

vec3 baseColorUnder(const Material& material, vec4 vertexColor) {
  return shading::makeSurface(material.constants, vec3(0.0f), vec3(0.0f, 1.0f, 0.0f), vertexColor, vec4(1.0f),
                              vec4(1.0f), vec4(1.0f), vec4(1.0f))
      .baseColor;
}

TEST(Shading, VertexColoursAboveOne_DoNotMakeSurfacesReflectMoreThanArrives) {
  const Material material = makeDiffuseMaterial("diffuse", vec3(0.5f));
  EXPECT_EQ(baseColorUnder(material, vec4(4.0f, 1.0f, 0.5f, 1.0f)), vec3(1.0f, 0.5f, 0.25f));
}

// Base colour is radiance there, not reflectance.
TEST(Shading, VertexColoursAboveOne_StayOnUnlitSurfaces) {
  Material material = makeDiffuseMaterial("unlit", vec3(0.5f));
  material.constants.kind.x = shading::kSurfaceUnlit;
  EXPECT_EQ(baseColorUnder(material, vec4(4.0f, 1.0f, 0.5f, 1.0f)), vec3(2.0f, 0.5f, 0.25f));
}

}  // namespace
}  // namespace pb
