// What doesn't fit the device is refused with the numbers in the message.
#include "raster/limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "raster/gpu_structs.h"
#include "scenes/environment.h"
#include "tests/error_message.h"

namespace pb {
namespace {

constexpr DeviceLimits kDevice = {.cubeMapSizePx = 1024,
                                  .arrayLayers = 60,
                                  .textureSizePx = 8192,
                                  .viewportPx = 4096,
                                  .textureUnits = 16,
                                  .bytes = 64 << 20};

Technique withResolution(int resolution) {
  Technique technique;
  technique.resolution = resolution;
  return technique;
}

TEST(Limits, AcceptWhatFitsExactly) {
  EXPECT_NO_THROW(checkImageFits(kDevice, 2048, 1, 2));
  EXPECT_NO_THROW(checkProbesFit(kDevice, withResolution(1024), 1, ProbeFilter::none, 64, 64, 1));
  EXPECT_NO_THROW(checkProbesFit(kDevice, withResolution(8), 10, ProbeFilter::none, 64, 64, 1));
}

TEST(Limits, RefuseACubeMapThatIsTooLarge) {
  EXPECT_THAT(messageOf([] { checkProbesFit(kDevice, withResolution(2048), 1, ProbeFilter::none, 64, 64, 1); }),
              testing::AllOf(testing::HasSubstr("1024"), testing::HasSubstr("2048")));
}

TEST(Limits, RefuseProbesThatExceedTheMemory) {
  // 10 probes: 6 * 10 * 512^2 * 8 bytes = 120 MiB, and 1 MiB of depth.
  EXPECT_THAT(messageOf([] { checkProbesFit(kDevice, withResolution(512), 10, ProbeFilter::none, 1, 1, 1); }),
              testing::AllOf(testing::HasSubstr("121 MiB"), testing::HasSubstr("64 MiB")));
}

TEST(Limits, RefuseAnImageThatIsTooLargeOrEmpty) {
  EXPECT_THAT(messageOf([] { checkImageFits(kDevice, 2049, 1, 2); }),
              testing::AllOf(testing::HasSubstr("4096"), testing::HasSubstr("4098")));
  EXPECT_THAT(messageOf([] { checkImageFits(kDevice, 0, 1, 1); }), testing::HasSubstr("0x1"));
  EXPECT_THAT(messageOf([] { checkImageFits(kDevice, 2048, 2048, 1); }), testing::HasSubstr("80 MiB"));
}

TEST(Limits, RefuseADeviceWithTooFewTextureUnits) {
  DeviceLimits poor = kDevice;
  poor.textureUnits = gpu::kTextureUnits;
  EXPECT_NO_THROW(checkImageFits(poor, 8, 8, 1));
  --poor.textureUnits;
  EXPECT_THAT(messageOf([&] { checkImageFits(poor, 8, 8, 1); }), testing::HasSubstr("texture units"));
}

TEST(Limits, RefuseTexturesThatAreTooLarge) {
  Scene scene;
  scene.environment = makeConstantEnvironment(glm::vec3(1.0f));
  scene.environment.faces.assign(6, ImageRgba(8, 8));
  scene.textures.push_back(makeTexture("strip", ImageRgba(8192, 1)));
  EXPECT_NO_THROW(checkSceneFits(kDevice, scene));
  // 64 MiB is 2^22 texels: 1 x 2048^2 with its levels is 4/3 of that.
  scene.textures.push_back(makeTexture("large", ImageRgba(2048, 2048)));
  EXPECT_THAT(messageOf([&] { checkSceneFits(kDevice, scene); }), testing::HasSubstr("85 MiB"));
  scene.textures = {makeTexture("long", ImageRgba(8193, 1))};
  EXPECT_THAT(messageOf([&] { checkSceneFits(kDevice, scene); }),
              testing::AllOf(testing::HasSubstr("'long'"), testing::HasSubstr("8193x1"), testing::HasSubstr("8192")));
  scene.textures.clear();
  scene.environment.faces.assign(6, ImageRgba(1025, 1025));
  EXPECT_THAT(messageOf([&] { checkSceneFits(kDevice, scene); }),
              testing::AllOf(testing::HasSubstr("1024"), testing::HasSubstr("1025")));
}

TEST(ProbeBytes, CountBothBuffersOfSimultaneousBounces) {
  Technique technique = withResolution(16);
  EXPECT_EQ(probeBytes(technique, 3, ProbeFilter::none), 3 * 6 * 16 * 16 * 8);
  technique.bounceOrder = BounceOrder::simultaneous;
  EXPECT_EQ(probeBytes(technique, 3, ProbeFilter::none), 2 * 3 * 6 * 16 * 16 * 8);
  technique.probes = ProbeUse::environmentOnly;
  EXPECT_EQ(probeBytes(technique, 3, ProbeFilter::none), 0);
}

TEST(ProbeBytes, FollowFormatAndStorage) {
  Technique technique = withResolution(16);
  const auto bytes = [&] { return probeBytes(technique, 3, ProbeFilter::none); };
  technique.format = ProbeFormat::r11fG11fB10f;
  EXPECT_EQ(bytes(), 3 * 6 * 16 * 16 * 4);
  technique.format = ProbeFormat::rgb9e5;  // captured in halves
  EXPECT_EQ(bytes(), 3 * 6 * 16 * 16 * (4 + 8));
  technique.format = ProbeFormat::rgba8Srgb;
  EXPECT_EQ(bytes(), 3 * 6 * 16 * 16 * 4);
  EXPECT_EQ(probeBytes(technique, 3, ProbeFilter::boxMips), 3 * 6 * (16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1) * 4);
  technique.bounceOrder = BounceOrder::simultaneous;
  EXPECT_EQ(bytes(), 2 * 3 * 6 * 16 * 16 * 4);
  technique = withResolution(16);
  technique.storage = Storage::octahedral;  // sqrt(6) * 16 = 39.2, even and with a border
  EXPECT_EQ(bytes(), 3 * (42 * 42 + 6 * 16 * 16) * 8);
  technique.storage = Storage::dualParaboloid;  // sqrt(3) * 16 = 27.7
  EXPECT_EQ(bytes(), 3 * (2 * 30 * 30 + 6 * 16 * 16) * 8);
}

}  // namespace
}  // namespace pb
