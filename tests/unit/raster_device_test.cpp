// What the device refuses, how its errors are reported, and its two backends side by side.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "raster/lookup.h"
#include "raster/texel_format.h"
#include "scenes/error.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

class Device : public RasterTest {};

INSTANTIATE_TEST_SUITE_P(Gl, Device, kBackends, nameOfBackend);

TEST_P(Device, RefusesWhatTheDeviceCannotDo) {
  EXPECT_THROW(RasterSequence(device(), withResolution(1 << 20), 16, 16, 1), Error);
  EXPECT_THROW(RasterSequence(device(), withResolution(8), 1 << 20, 16, 1), Error);
  Technique technique = withResolution(8);
  technique.bounces = 0;
  EXPECT_THROW(RasterSequence(device(), technique, 16, 16, 1), Error);
  technique = withResolution(8);
  technique.refresh = parseSpec("sometimes");
  EXPECT_THROW(RasterSequence(device(), technique, 16, 16, 1), Error);
}

TEST_P(Device, EveryVariantOfTheShadersCompiles) {
  RasterDevice::Impl& impl = device().impl();
  impl.context.makeCurrent();
  SurfaceVariant variant;
  for (const float kind :
       {shading::kSurfaceDiffuse, shading::kSurfaceMirror, shading::kSurfaceGlass, shading::kSurfaceUnlit})
    for (const TextureFilter filter : {TextureFilter::exact, TextureFilter::hardware})
      for (const bool textured : {false, true}) {
        variant.kind = kind;
        variant.filter = filter;
        variant.attributes = textured;
        variant.textures.fill(textured ? std::optional(SamplerSettings{0.0f, 1.0f, 1.0f, 5.0f}) : std::nullopt);
        EXPECT_NE(impl.programs.surfaceShowingProbe(variant, techniqueDefines({}), ""), 0U);
        EXPECT_NE(impl.programs.ids(variant), 0U);
        for (const EnvironmentSource source :
             {EnvironmentSource::gradient, EnvironmentSource::faces, EnvironmentSource::facesHardware})
          EXPECT_NE(impl.programs.surfaceShowingEnvironment(variant, source, techniqueDefines({})), 0U);
      }
}

// Of everything that looks up maps of probes: mirrors, and what may be rough and then reads their levels.
constexpr std::pair<float, Lobe> kSurfacesWithLookups[] = {{shading::kSurfaceMirror, Lobe::smooth},
                                                           {shading::kSurfaceGlossy, Lobe::mixed},
                                                           {shading::kSurfaceGlass, Lobe::mixed}};

void expectToCompile(Programs& programs, const SurfaceVariant& variant, const Lookup& lookup, const char* probes,
                     const char* levels) {
  const ProbeFilter filter = lookup.isSingleView ? ProbeFilter::none : ProbeFilter::ggxPrefiltered;
  const std::string defines =
      techniqueDefines({}) + filterDefines(filter, 64) + lookupDefines({lookup.name, {}}) + probes + levels;
  EXPECT_NO_THROW(programs.surfaceShowingProbe(variant, defines, lookup.glsl)) << variant.kind << '\n' << defines;
  const bool isBlended = *probes != 0, hasLevels = *levels != 0;
  if (!lookup.keepsDirections || isBlended || variant.kind == shading::kSurfaceGlass) return;
  const bool isMirror = variant.kind == shading::kSurfaceMirror && !hasLevels;
  const LookupRecord record = isMirror ? LookupRecord::mirror : LookupRecord::general;
  EXPECT_NO_THROW(programs.surfaceRecordingLookup(variant, record, defines, lookup.glsl)) << variant.kind << '\n'
                                                                                          << defines;
}

TEST_P(Device, EveryVariantOfEveryLookupCompiles) {
  RasterDevice::Impl& impl = device().impl();
  impl.context.makeCurrent();
  SurfaceVariant variant;
  for (const Lookup& lookup : lookups())
    for (const auto& [kind, lobe] : kSurfacesWithLookups)
      for (const bool attributes : {false, true})
        for (const char* probes : {"", "#define BLENDED_PROBES\n"})
          for (const char* levels : {"", "#define MIPS\n"}) {
            // Single views have no levels, and those of others don't depend on what vertices carry.
            if ((lookup.isSingleView || attributes) && *levels != 0) continue;
            variant.kind = kind;
            variant.lobe = lobe;
            variant.attributes = attributes;
            expectToCompile(impl.programs, variant, lookup, probes, levels);
          }
}

// A driver keeps megabytes of each program, and a suite asks for hundreds one after the other.
TEST_P(Device, ProgramsStayWhileASequenceLivesAndOnlyTheLastOnesAfterIt) {
  RasterDevice::Impl& impl = device().impl();
  const auto program = [&](int samples) { return impl.programs.ggxLevel(samples, floatTexels().defines); };
  std::vector<GLuint> ids;
  {
    const RasterSequence sequence(device(), withResolution(8), 16, 16, 1);
    for (int samples = 1; samples <= static_cast<int>(kMostIdlePrograms) + 4; ++samples)
      ids.push_back(program(samples));
    {
      const RasterSequence later(device(), withResolution(8), 16, 16, 1);
      EXPECT_EQ(program(1), ids.front());
    }
    EXPECT_TRUE(std::ranges::all_of(ids, impl.context.functions().IsProgram));
  }
  EXPECT_EQ(impl.programs.size(), kMostIdlePrograms);
  EXPECT_TRUE(impl.context.functions().IsProgram(ids.front())) << "it was asked for last";
  EXPECT_EQ(std::ranges::count_if(ids, impl.context.functions().IsProgram),
            static_cast<std::ptrdiff_t>(kMostIdlePrograms));
}

TEST_P(Device, ShaderErrorsBecomeOneException) {
  RasterDevice::Impl& impl = device().impl();
  impl.context.makeCurrent();
  try {
    const gl::Program program(impl.context.functions(),
                              {{GL_VERTEX_SHADER, "broken.vert", "#version 450 core\nvoid main() { nonsense; }\n"}});
    FAIL() << "a broken shader compiled";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::environment);
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("broken.vert"), testing::HasSubstr("nonsense"),
                                             testing::Not(testing::HasSubstr("\n"))));
  }
}

TEST_P(Device, GlErrorsBecomeOneExceptionAndAreCleared) {
  RasterDevice::Impl& impl = device().impl();
  impl.context.makeCurrent();
  impl.context.functions().Enable(GL_RGBA);
  try {
    impl.context.check("testing");
    FAIL() << "the error went unnoticed";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::environment);
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("GL_INVALID_ENUM"), testing::HasSubstr("testing")));
  }
  EXPECT_NO_THROW(impl.context.check("testing"));
}

// Both are llvmpipe of one Mesa here; on a machine where EGL finds a GPU the pictures differ in rounding.
TEST(Backends, UsedInTurnEachGiveThePictureThatTheyGiveAlone) {
  if (!kHasOsmesa) GTEST_SKIP() << "this build has no OSMesa backend";
  RasterDevice osmesa(GlBackend::osmesa), egl(GlBackend::egl);
  const auto snapshot = snapshotOf("mirrors?count=2");
  RasterSequence a(osmesa, withResolution(32), 64, 36, 1), b(egl, withResolution(32), 64, 36, 1);
  RasterSequence alone(osmesa, withResolution(32), 64, 36, 1);
  for (int f = 0; f < 2; ++f) {
    a.renderFrame(*snapshot);
    b.renderFrame(*snapshot);
  }
  for (int f = 0; f < 2; ++f) alone.renderFrame(*snapshot);
  EXPECT_EQ(a.readImage(), alone.readImage());
  if (osmesa.info().renderer == egl.info().renderer) {
    EXPECT_EQ(a.readImage(), b.readImage());
  }
  EXPECT_LT(largestDifference(a.readImage(), b.readImage()), 1.0f);
}

}  // namespace
}  // namespace pb
