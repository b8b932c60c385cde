// Built-in scenes written as .glb and loaded again: the pictures stay.
#include "scenes/files.h"
#include "scenes/gltf_load.h"
#include "scenes/gltf_save.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

constexpr int kFrame = 7;

std::shared_ptr<const Snapshot> snapshotAt7(Scene scene) {
  return makeSnapshot(std::make_shared<const Scene>(std::move(scene)), kFrame, "", 16.0 / 9.0);
}

// The scene with white in the place of all textures of base colours.
Scene whitened(Scene scene) {
  for (const Material& material : scene.materials) {
    if (material.baseColorTexture < 0) continue;
    for (ImageRgba& level : scene.textures[static_cast<std::size_t>(material.baseColorTexture)].levels)
      for (glm::vec4& texel : level) texel = glm::vec4(1.0f, 1.0f, 1.0f, texel.w);
  }
  return scene;
}

float largestOf(const Image& image) {
  float largest = 0.0f;
  for (const glm::vec3& p : image) largest = std::max({largest, p.x, p.y, p.z});
  return largest;
}

// What 16 bits a channel may change where no surface, be it white, has more radiance than `white`.
float boundOf(float white) {
  // Half a step of a texel: as a colour, times the largest slope of the sRGB decoding; as the data of occlusion; as a
  // normal 2 texel - 1, three components of which turn it by up to sqrt(3) times as much.
  const float step = 1.0f / 65535.0f;
  const float texels = (2.28f * 0.5f + 0.5f + 1.7321f) * step;
  // In cube maps of half floats, whose steps are up to 2^-10 of the value, any change may cross a step: in the map that
  // is looked up, and in the map that another mirror shows in it.
  const float maps = 2.0f / 1024.0f;
  return (texels + maps) * white;
}

class RasterExport : public RasterTest {};

// One backend: what a file holds doesn't depend on it.
INSTANTIATE_TEST_SUITE_P(Gl, RasterExport, testing::Values(kHasOsmesa ? GlBackend::osmesa : GlBackend::egl),
                         nameOfBackend);

TEST_P(RasterExport, OfEveryBuiltinScene_ShowsTheSamePicture) {
  for (const BuiltinScene& builtin : builtinScenes()) {
    SCOPED_TRACE(builtin.name);
    const Scene scene = makeBuiltinScene({builtin.name, {}});
    const TemporaryFolder folder;
    saveGlb(scene, folder.file("scene.glb"));
    const auto original = snapshotAt7(scene), loaded = snapshotAt7(loadGltf(folder.file("scene.glb")));
    const auto picture = [&](const Snapshot& s) { return render(s, withResolution(16), 64, 36); };
    if (contentHash(*original) == contentHash(*loaded)) {
      EXPECT_EQ(picture(*original), picture(*loaded));
    } else {
      // Some of its textures have more than 8 bits a channel, which the file rounds to 16.
      const float white = largestOf(picture(*snapshotAt7(whitened(scene))));
      EXPECT_LE(largestDifference(picture(*original), picture(*loaded)), boundOf(white));
    }
  }
}

}  // namespace
}  // namespace pb
