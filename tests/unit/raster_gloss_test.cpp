// Rough reflections: filtered cube maps against quadrature, and what lookups make of them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "raster/device.h"
#include "raster/prefilter.h"
#include "raster/reflection.h"
#include "scenes/dfg_table.h"
#include "tests/unit/raster_fixture.h"

namespace pb {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

class RasterGloss : public RasterTest {
 protected:
  // Levels 0 to the last of a cube map of floats or halves, with the six faces of each.
  using Levels = std::vector<std::vector<Grid<vec4>>>;

  template <class Radiance>
  Levels filtered(ProbeFilter filter, int size, const Radiance& radiance, const TexelFormat& format = floatTexels()) {
    gl::Context& context = device().impl().context;
    context.makeCurrent();
    const gl::Functions& gl = context.functions();
    const int levels = filteredLevels(filter, size) + 1;
    const gl::Texture layers = gl::makeTexture(gl, {.target = GL_TEXTURE_2D_ARRAY,
                                                    .format = format.shown,
                                                    .width = size,
                                                    .height = size,
                                                    .layers = 6,
                                                    .levels = levels});
    upload(layers, size, radiance, kAllFaces);
    CubeFilter(context, device().impl().programs, filter, format, size).run(layers, {}, kAllFaces);
    Levels result = read(layers, size, levels);
    context.check("filtering a test's cube map");
    return result;
  }

  template <class Radiance>
  static void upload(const gl::Texture& layers, int size, const Radiance& radiance, FaceSet faces) {
    for (int face = 0; face < 6; ++face) {
      if ((faces >> face & 1u) == 0) continue;
      Grid<vec4> texels(size, size);
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) texels(x, y) = vec4(radiance(directionOf(face, x, y, size)), 1.0f);
      layers.gl().TextureSubImage3D(layers.id(), 0, 0, 0, face, size, size, 1, GL_RGBA, GL_FLOAT, texels.data());
    }
  }

  static Levels read(const gl::Texture& layers, int size, int levels) {
    Levels result(static_cast<std::size_t>(levels));
    for (int level = 0; level < levels; ++level)
      for (int face = 0; face < 6; ++face) {
        const int n = std::max(size >> level, 1);
        Grid<vec4> texels(n, n);
        layers.gl().GetTextureSubImage(layers.id(), level, 0, 0, face, n, n, 1, GL_RGBA, GL_FLOAT,
                                       static_cast<GLsizei>(texels.size() * sizeof(vec4)), texels.data());
        result[static_cast<std::size_t>(level)].push_back(std::move(texels));
      }
    return result;
  }

  static vec3 directionOf(int face, int x, int y, int size) {
    const vec2 st =
        (2.0f * vec2(static_cast<float>(x), static_cast<float>(y)) + 1.0f) / static_cast<float>(size) - 1.0f;
    return glm::normalize(shading::cubeDirection(face, st));
  }
};

INSTANTIATE_TEST_SUITE_P(Gl, RasterGloss, kBackends, nameOfBackend);

// A bright strip, a small lamp and a gradient: high and low frequencies.
vec3 testRadiance(const vec3& d) {
  const float lamp = glm::dot(d, glm::normalize(vec3(0.9f, 0.5f, 0.8f))) > 0.985f ? 20.0f : 0.0f;
  const float strip = std::abs(d.y + 0.3f) < 0.1f ? 3.0f : 0.0f;
  return {1.0f + lamp, 1.0f + d.x + strip, 0.2f + 0.5f * (1.0f - d.z)};
}

// --- The mapping
// ------------------------------------------------------------------------------------------------------

TEST(Gloss, LevelsStandForRoughnessFromMirrorToFullyRough) {
  for (const int size : {16, 64, 256, 1024}) {
    const int levels = filteredLevels(ProbeFilter::ggxPrefiltered, size);
    EXPECT_EQ(size >> levels, 8);
    EXPECT_EQ(levelRoughness(0, levels), 0.0f);
    EXPECT_EQ(levelRoughness(levels, levels), 1.0f);
    for (int level = 1; level <= levels; ++level)
      EXPECT_GT(levelRoughness(level, levels), levelRoughness(level - 1, levels));
  }
  EXPECT_EQ(filteredLevels(ProbeFilter::boxMips, 64), 6);
  EXPECT_EQ(filteredLevels(ProbeFilter::none, 64), 0);
}

// The kernel of alpha = 1 is a clamped cosine over pi: its mean cosine is 2/3, and each direction stands for pi / (n
// NoL) steradians. That of alpha -> 0 is the mirror direction.
TEST(Gloss, LobeSamplesFollowTheKernel) {
  float meanCosine = 0.0f;
  for (const vec4& sample : lobeSamples(1.0f)) {
    EXPECT_NEAR(glm::length(vec3(sample)), 1.0f, 1e-6f);
    EXPECT_NEAR(sample.w, shading::kPi / (kLobeSamples * sample.z), 1e-4f * sample.w);
    meanCosine += sample.z / kLobeSamples;
  }
  EXPECT_NEAR(meanCosine, 2.0f / 3.0f, 1e-3f);
  for (const vec4& sample : lobeSamples(1e-3f)) EXPECT_GT(sample.z, 0.999f);
}

// --- The filters
// ------------------------------------------------------------------------------------------------------

// Halves have 11 bits. The mean of equal values in floats is that value up to a few of 24 bits.
TEST_P(RasterGloss, ConstantMapsStayConstantInEveryLevel) {
  for (const ProbeFilter filter : {ProbeFilter::boxMips, ProbeFilter::ggxPrefiltered})
    for (const TexelFormat& format : {texelFormat(ProbeFormat::rgba16f), floatTexels()})
      for (const auto& faces : filtered(
               filter, 64, [](const vec3&) { return vec3(1.0f, 0.25f, 4.0f); }, format))
        for (const Grid<vec4>& face : faces)
          for (const vec4& texel : face) {
            const float tolerance = format.shown == GL_RGBA16F ? std::exp2(-10.0f) : 1e-5f;
            EXPECT_NEAR(texel.x, 1.0f, tolerance);
            EXPECT_NEAR(texel.y, 0.25f, 0.25f * tolerance);
            EXPECT_NEAR(texel.z, 4.0f, 4.0f * tolerance);
          }
}

TEST_P(RasterGloss, BoxLevelsAreMeansOfFourTexels) {
  const Levels levels = filtered(ProbeFilter::boxMips, 32, testRadiance);
  ASSERT_EQ(levels.size(), 6u);
  for (std::size_t level = 1; level < levels.size(); ++level)
    for (std::size_t face = 0; face < 6; ++face) {
      const Grid<vec4>& fine = levels[level - 1][face];
      const Grid<vec4>& coarse = levels[level][face];
      for (int y = 0; y < coarse.height(); ++y)
        for (int x = 0; x < coarse.width(); ++x) {
          const vec4 mean = 0.25f * (fine(2 * x, 2 * y) + fine(2 * x + 1, 2 * y) + fine(2 * x, 2 * y + 1) +
                                     fine(2 * x + 1, 2 * y + 1));
          EXPECT_LT(glm::distance(coarse(x, y), mean), 1e-5f * glm::length(mean));
        }
    }
}

// The integral that a level stands for, over all texels of level 0: mean of the radiance under D(NoH) NoL with
// N = V = `axis`. Each texel is split so that narrow lobes are resolved.
vec3 convolved(const std::vector<Grid<vec4>>& faces, const vec3& axis, float alpha) {
  constexpr int kSplit = 4;
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  for (int face = 0; face < 6; ++face) {
    const Grid<vec4>& texels = faces[static_cast<std::size_t>(face)];
    const int n = kSplit * texels.width();
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const vec2 st =
            (2.0f * vec2(static_cast<float>(x), static_cast<float>(y)) + 1.0f) / static_cast<float>(n) - 1.0f;
        const vec3 d = shading::cubeDirection(face, st);
        const float distance = glm::length(d);
        const float NoL = glm::dot(d, axis) / distance;
        if (NoL <= 0.0f) continue;
        const float NoH = std::sqrt(0.5f * (1.0f + NoL));
        const double weight =
            double{shading::D_GGX(NoH, 0.5f * (1.0f - NoL), alpha) * NoL / (distance * distance * distance)};
        sum += weight * glm::dvec3(texels(x / kSplit, y / kSplit));
        weights += weight;
      }
  }
  return vec3(sum / weights);
}

// Root mean square of the differences over the root mean square of the integral's own variation. Measured: 0.018, 0.023
// and 0.049, most of it the blur of the samples' footprints, which falls with their number: 0.005, 0.007 and 0.017 with
// 256 samples.
TEST_P(RasterGloss, GgxLevelsMatchTheirIntegral) {
  constexpr std::array<double, 3> kTolerances = {0.02, 0.026, 0.055};
  const Levels levels = filtered(ProbeFilter::ggxPrefiltered, 64, testRadiance);
  ASSERT_EQ(levels.size(), 4u);
  for (std::size_t level = 1; level < levels.size(); ++level) {
    const float roughness = levelRoughness(static_cast<int>(level), 3);
    const int n = 64 >> level;
    double difference = 0.0;
    double variation = 0.0;
    int count = 0;
    for (int face = 0; face < 6; ++face)
      for (int y = n / 8; y < n; y += n / 4)
        for (int x = n / 8; x < n; x += n / 4) {
          const vec3 expected = convolved(levels[0], directionOf(face, x, y, n), roughness * roughness);
          const vec3 d = vec3(levels[level][static_cast<std::size_t>(face)](x, y)) - expected;
          difference += double{glm::dot(d, d)};
          variation += double{glm::dot(expected - 1.0f, expected - 1.0f)};
          ++count;
        }
    EXPECT_LT(std::sqrt(difference / variation), kTolerances[level - 1]) << "level " << level;
  }
}

// Steps between neighbouring texels, as a mean over all edges of the cube: across the edge, and beside it on the face.
struct Steps {
  double across = 0.0, beside = 0.0;
};

Steps stepsAtEdges(const std::vector<Grid<vec4>>& faces) {
  const int n = faces.front().width();
  const auto texel = [&](const glm::ivec3& p) { return vec3(faces[static_cast<std::size_t>(p.z)](p.x, p.y)); };
  Steps steps;
  for (int face = 0; face < 6; ++face)
    for (int i = 0; i < n; ++i) {
      // The edge's texel, the one behind it on the face, the one before it on the neighbour; on all four sides.
      const glm::ivec2 edges[] = {{0, i}, {n - 1, i}, {i, 0}, {i, n - 1}};
      const glm::ivec2 inwards[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
      for (int side = 0; side < 4; ++side) {
        const vec3 edge = texel({edges[side], face});
        steps.beside += double{glm::distance(edge, texel({edges[side] + inwards[side], face}))};
        steps.across +=
            double{glm::distance(edge, texel(shading::cubeWrapTexel(edges[side] - inwards[side], face, n)))};
      }
    }
  return steps;
}

// Texels are as far apart in angle across an edge as beside it, so their steps are alike. Up to 1.5, because the texel
// across may lie up to half a texel to the side.
TEST_P(RasterGloss, LevelsAreSeamlessAtTheEdgesOfTheCube) {
  const Levels levels = filtered(ProbeFilter::ggxPrefiltered, 64, testRadiance);
  for (std::size_t level = 1; level < levels.size(); ++level) {
    const Steps steps = stepsAtEdges(levels[level]);
    EXPECT_LT(steps.across, 1.5 * steps.beside) << "level " << level;
  }
}

TEST_P(RasterGloss, FilteringWhatChangedEqualsFilteringAll) {
  constexpr int kSize = 64;
  gl::Context& context = device().impl().context;
  context.makeCurrent();
  const auto changedRadiance = [](const vec3& d) { return 2.0f * testRadiance(-d); };
  for (const ProbeFilter filter : {ProbeFilter::boxMips, ProbeFilter::ggxPrefiltered}) {
    CubeFilter cubeFilter(context, device().impl().programs, filter, floatTexels(), kSize);
    const int levels = filteredLevels(filter, kSize) + 1;
    const auto run = [&](FaceSet changed, bool inSteps) {
      const gl::Texture layers = gl::makeTexture(context.functions(), {.target = GL_TEXTURE_2D_ARRAY,
                                                                       .format = GL_RGBA32F,
                                                                       .width = kSize,
                                                                       .height = kSize,
                                                                       .layers = 6,
                                                                       .levels = levels});
      upload(layers, kSize, testRadiance, kAllFaces);
      const std::int64_t all = cubeFilter.run(layers, {}, inSteps ? kAllFaces : 0u);
      upload(layers, kSize, changedRadiance, changed);
      const std::int64_t texels = cubeFilter.run(layers, {}, inSteps ? changed : kAllFaces);
      if (inSteps) {
        EXPECT_LE(texels, all);
      }
      return read(layers, kSize, levels);
    };
    for (const FaceSet changed : {1u, 2u, 16u}) EXPECT_EQ(run(changed, true), run(changed, false));
  }
}

// --- Lookups
// ----------------------------------------------------------------------------------------------------------

Material makeGlossy(vec3 baseColor, float metallic, float roughness) {
  Material material = makeDiffuseMaterial("glossy", baseColor);
  material.constants.kind.x = shading::kSurfaceGlossy;
  material.constants.factors.x = metallic;
  material.constants.factors.y = roughness;
  material.constants.specular.w = 1.0f;
  return material;
}

constexpr ProbeFilter kFilters[] = {ProbeFilter::none, ProbeFilter::boxMips, ProbeFilter::ggxPrefiltered};

// The base gets what the coat leaves of uniform light: together they reflect all of it. Halves have 11 bits. Without
// filter a lobe reflects by Fresnel at the viewer's angle, and nothing says that this sums up.
TEST_P(RasterGloss, CoatedWhiteBallVanishesInTheWhiteFurnace) {
  for (const ProbeFilter filter : {ProbeFilter::boxMips, ProbeFilter::ggxPrefiltered})
    for (const bool hasProbe : {false, true})
      for (const float roughness : {0.1f, 0.5f, 1.0f}) {
        Material material = makeGlossy(kWhite, 0.0f, roughness);
        material.isSpecularDominant = hasProbe;
        Technique technique = withResolution(32);
        technique.filter = filter;
        const Image image = render(*snapshotOf(makeBall(kWhite, material)), technique);
        EXPECT_LT(largestDifference(image, Image(64, 64, kWhite)), 2e-3f) << "roughness " << roughness;
      }
}

// Uniform light on a metal of F0 = 1: what the table of the term says, at the ball's centre (NoV = 1 up to the pixel's
// size and the triangles' normals).
TEST_P(RasterGloss, GeometryTermsActThroughTheirTables) {
  for (const GeometryTerm term :
       {GeometryTerm::smithCorrelated, GeometryTerm::one, GeometryTerm::smithK, GeometryTerm::cookTorrance}) {
    Technique technique = withResolution(32);
    technique.geometryTerm = term;
    const Image image = render(*snapshotOf(makeBall(kWhite, makeGlossy(kWhite, 1.0f, 0.8f))), technique);
    const vec2 dfg = computeDfg(0.999f, 0.64f, static_cast<float>(term));
    EXPECT_NEAR(centreOf(image).x, dfg.x + dfg.y, 5e-3f) << "geometry term " << static_cast<int>(term);
  }
}

// A horizontal square seen at an angle of cosine 0.25 under uniform light.
Scene makeSquare(Material material, const Environment& environment) {
  Scene scene;
  scene.environment = environment;
  const float cosine = 0.25f;
  addCamera(scene, "camera", 3.0f * vec3(0.0f, cosine, std::sqrt(1.0f - cosine * cosine)), vec3(0), 0.2f, 0.1f);
  addInstance(scene, "square", finishMesh(makeQuadMesh(vec3(-2, 0, 2), vec3(4, 0, 0), vec3(0, 0, -4))),
              addMaterial(scene, std::move(material)));
  return scene;
}

TEST_P(RasterGloss, FresnelLawsActOnCoats) {
  const Environment white = makeConstantEnvironment(kWhite);
  const auto centreWith = [&](const Spec& law, float roughness) {
    Technique technique = withResolution(32);
    technique.fresnel = law;
    return centreOf(render(*snapshotOf(makeSquare(makeGlossy(kBlack, 0.0f, roughness), white)), technique, 65, 65)).x;
  };
  const float rise = std::pow(0.75f, 5.0f);
  EXPECT_NEAR(centreWith({"exact", {}}, 0.0f), shading::F_Dielectric(0.25f, 1.5f), 1e-5f);
  EXPECT_NEAR(centreWith({"schlick", {}}, 0.0f), 0.04f + 0.96f * rise, 1e-5f);
  EXPECT_NEAR(centreWith({"ratio", {{"bias", "0.1"}, {"scale", "0.5"}, {"power", "2"}}}, 0.0f), 0.1f + 0.5f * 0.5625f,
              1e-5f);
  const vec2 dfg = computeDfg(0.25f, 0.25f, shading::kGeometrySmithCorrelated);
  EXPECT_NEAR(centreWith({"exact", {}}, 0.5f), 0.04f * dfg.x + dfg.y, 2e-3f);
  EXPECT_NEAR(centreWith({"ratio", {{"bias", "0.1"}, {"scale", "0.5"}, {"power", "2"}}}, 0.5f),
              0.1f * dfg.x + 0.6f * dfg.y, 2e-3f);
}

// A mirror and, hidden in a box, a rough ball that looks the mirror's probe up.
Scene makeMirrorWithRoughNeighbour() {
  Scene scene = makeBall(kBlack, makeMirrorMaterial("mirror"));
  scene.environment = makeProceduralSky();
  addBox(scene, vec3(2.0f, 0.0f, 0.0f), vec3(1.0f), makeUnlit(kRed));
  Node inside;
  inside.translation = vec3(2.0f, 0.0f, 0.0f);
  addInstance(scene, "hidden", finishMesh(makeSphereMesh(0.3f, 16, 8)),
              addMaterial(scene, makeGlossy(kWhite, 1.0f, 0.5f)), inside);
  return scene;
}

TEST_P(RasterGloss, MirrorsLookTheSameWhateverTheFilter) {
  const auto snapshot = snapshotOf(makeMirrorWithRoughNeighbour());
  std::vector<Image> images;
  for (const ProbeFilter filter : kFilters) {
    Technique technique = withResolution(32);
    technique.filter = filter;
    RasterSequence sequence(device(), technique, 64, 64, 1);
    const FrameStats stats = sequence.renderFrame(*snapshot);
    EXPECT_EQ(stats.counters.texelsFiltered > 0, filter != ProbeFilter::none);
    images.push_back(sequence.readImage());
  }
  EXPECT_EQ(largestDifference(images[0], images[1]), 0.0f);
  EXPECT_EQ(largestDifference(images[0], images[2]), 0.0f);
}

TEST_P(RasterGloss, ScenesWithoutRoughLobesPayNothingForTheFilter) {
  const auto snapshot = snapshotOf("mirrors?count=3");
  std::vector<FrameCounters> counters;
  for (const ProbeFilter filter : kFilters) {
    Technique technique = withResolution(16);
    technique.filter = filter;
    RasterSequence sequence(device(), technique, 64, 64, 1);
    counters.push_back(sequence.renderFrame(*snapshot).counters);
  }
  EXPECT_EQ(counters[0], counters[1]);
  EXPECT_EQ(counters[0], counters[2]);
  EXPECT_EQ(counters[0].texelsFiltered, 0);
}

// Levels of 16, 8 and (box) down to 1 texel; the ggx filter's own copy of one cube has all of them, 8 bytes a texel.
TEST_P(RasterGloss, ProbeBytesAndTexelsCountTheLevels) {
  const auto snapshot = snapshotOf(makeMirrorWithRoughNeighbour());
  constexpr int kBelow = 6 * (8 * 8 + 4 * 4 + 2 * 2 + 1);
  const auto countersWith = [&](ProbeFilter filter) {
    Technique technique = withResolution(16);
    technique.filter = filter;
    technique.bounces = 2;
    RasterSequence sequence(device(), technique, 64, 64, 1);
    return sequence.renderFrame(*snapshot).counters;
  };
  const FrameCounters none = countersWith(ProbeFilter::none);
  const FrameCounters box = countersWith(ProbeFilter::boxMips);
  const FrameCounters ggx = countersWith(ProbeFilter::ggxPrefiltered);
  EXPECT_EQ(box.probeBytes - none.probeBytes, 8 * kBelow);
  EXPECT_EQ(box.texelsFiltered, 2 * kBelow);
  EXPECT_EQ(ggx.probeBytes - none.probeBytes, 8 * (6 * 8 * 8 + 6 * 16 * 16 + kBelow));
  EXPECT_EQ(ggx.texelsFiltered, 2 * (kBelow + 6 * 8 * 8));
}

TEST_P(RasterGloss, FilterHasAPassTimeOfItsOwn) {
  const auto snapshot = snapshotOf(makeMirrorWithRoughNeighbour());
  RasterSequence sequence(device(), withResolution(32), 64, 64, 1);
  EXPECT_GT(sequence.renderFrameTimed(*snapshot).prefilterMs, 0.0);
  Technique unfiltered = withResolution(32);
  unfiltered.filter = ProbeFilter::none;
  RasterSequence plain(device(), unfiltered, 64, 64, 1);
  EXPECT_EQ(plain.renderFrameTimed(*snapshot).prefilterMs, 0.0);
}

// --- Coats
// ------------------------------------------------------------------------------------------------------------

// A black ball with a coat under a red sky, and a mirror with a probe inside of a blue box.
Scene makeCoatedBall() {
  Scene scene = makeBall(kRed, makeGlossy(kBlack, 0.0f, 0.0f));
  Material blue = makeUnlit(kBlue);
  blue.doubleSided = true;
  addBox(scene, vec3(9.0f, 0.0f, 0.0f), vec3(2.0f), blue);
  Node inside;
  inside.translation = vec3(9.0f, 0.0f, 0.0f);
  addInstance(scene, "mirror", finishMesh(makeSphereMesh(0.3f, 16, 8)),
              addMaterial(scene, makeMirrorMaterial("mirror")), inside);
  return scene;
}

TEST_P(RasterGloss, CoatsReflectWhatTheTechniqueSays) {
  const auto snapshot = snapshotOf(makeCoatedBall());
  const auto centreWith = [&](Coats coats, ProbeUse probes) {
    Technique technique = withResolution(32);
    technique.coats = coats;
    technique.probes = probes;
    return centreOf(render(*snapshot, technique));
  };
  // F0 of glass; the centre's NoV is 1 up to the pixel's size.
  const auto isTinted = [](const vec3& pixel, const vec3& color) {
    return glm::distance(pixel, 0.04f * color) < 1e-3f;
  };
  EXPECT_TRUE(isTinted(centreWith(Coats::nearestProbe, ProbeUse::dynamic), kBlue));
  EXPECT_TRUE(isTinted(centreWith(Coats::environment, ProbeUse::dynamic), kRed));
  EXPECT_TRUE(isTinted(centreWith(Coats::nearestProbe, ProbeUse::environmentOnly), kRed));
  EXPECT_EQ(centreWith(Coats::none, ProbeUse::dynamic), kBlack);
  EXPECT_EQ(centreWith(Coats::none, ProbeUse::environmentOnly), kBlack);
}

// The probe's own capture can't read the map that it draws to: there the coat shows the environment.
TEST_P(RasterGloss, CoatsSeenByTheirNearestProbeShowTheEnvironment) {
  Scene scene = makeBall(kRed, makeMirrorMaterial("mirror"));
  Node right;
  right.translation = vec3(3.0f, 0.0f, 0.0f);
  addInstance(scene, "coated", finishMesh(makeSphereMesh(1.0f, 32, 16)),
              addMaterial(scene, makeGlossy(kBlack, 1.0f, 0.0f)), right);
  scene.materials.back().constants.baseColor = vec4(1.0f);
  RasterSequence sequence(device(), withResolution(32), 64, 64, 1);
  const auto snapshot = snapshotOf(std::move(scene));
  for (int frame = 0; frame < 2; ++frame) {
    sequence.renderFrame(*snapshot);
    EXPECT_EQ(centreOf(sequence.readProbe(0)[0]), kRed) << "frame " << frame;
  }
}

TEST(Reflection, OwnProbeThenNearestProbeThenEnvironment) {
  const auto snapshot = snapshotOf(makeCoatedBall());
  const SnapshotInstance& coated = snapshot->instances[0];
  const SnapshotInstance& mirror = snapshot->instances[2];
  Technique technique;
  EXPECT_EQ(reflectionOf(technique, *snapshot, mirror).probe, mirror.probe);
  EXPECT_EQ(reflectionOf(technique, *snapshot, coated).probe, coated.nearestProbe);
  EXPECT_EQ(probesWithLevels(technique, *snapshot), std::vector<bool>{false});
  technique.coats = Coats::none;
  EXPECT_EQ(reflectionOf(technique, *snapshot, coated).source, ReflectionSource::nothing);
  EXPECT_EQ(reflectionOf(technique, *snapshot, mirror).probe, mirror.probe);
}

// One coated ball; the mirror's own lobe is no coat, and the box is unlit.
TEST(Reflection, CoatsAreCountedByWhatServesThem) {
  const auto snapshot = snapshotOf(makeCoatedBall());
  Technique technique;
  EXPECT_EQ(coatSources(technique, *snapshot), (LookupSources{{1}, 0}));
  technique.coats = Coats::environment;
  EXPECT_EQ(coatSources(technique, *snapshot), (LookupSources{{0}, 1}));
  technique.coats = Coats::none;
  EXPECT_EQ(coatSources(technique, *snapshot), (LookupSources{{0}, 0}));
  technique.coats = Coats::nearestProbe;
  technique.probes = ProbeUse::environmentOnly;
  EXPECT_EQ(coatSources(technique, *snapshot), (LookupSources{{0}, 1}));
}

TEST_P(RasterGloss, FramesSayWhatServedTheirCoats) {
  RasterSequence sequence(device(), withResolution(8), 8, 8, 1);
  EXPECT_EQ(sequence.renderFrame(*snapshotOf(makeCoatedBall())).coats, (LookupSources{{1}, 0}));
}

// --- Glass
// ------------------------------------------------------------------------------------------------------------

// What smooth glass doesn't reflect it transmits; its 4 % are reflected as far as the table says.
TEST_P(RasterGloss, RoughGlassVanishesInTheWhiteFurnace) {
  Material glass = makeGlass(1.5f);
  glass.constants.factors.y = 0.5f;
  const Image image = render(*snapshotOf(makeBall(kWhite, glass)));
  const vec2 dfg = computeDfg(0.999f, 0.25f, shading::kGeometrySmithCorrelated);
  EXPECT_NEAR(centreOf(image).x, 0.96f + 0.04f * dfg.x + dfg.y, 2e-4f);
}

// A square of glass over a glow below: the radiance in the direction that each channel's index of refraction makes.
TEST_P(RasterGloss, DispersionLooksUpOneRayAChannel) {
  shading::Sky sky{};
  sky.below = vec4(0.1f);
  sky.glow = vec4(1.0f, 1.0f, 1.0f, 20.0f);
  sky.toGlow = vec4(glm::normalize(vec3(0.0f, -1.0f, -0.3f)), 0.0f);
  const Environment environment = makeGradientEnvironment(sky);
  const auto centreWith = [&](Dispersion dispersion, float value) {
    Material glass = makeGlass(1.5f);
    glass.constants.kind.w = value;
    glass.isSpecularDominant = false;
    Technique technique = withResolution(32);
    technique.dispersion = dispersion;
    return centreOf(render(*snapshotOf(makeSquare(glass, environment)), technique, 65, 65));
  };
  const vec3 d = -glm::normalize(vec3(0.0f, 0.25f, std::sqrt(1.0f - 0.0625f)));
  const vec3 up(0.0f, 1.0f, 0.0f);
  const float f = shading::F_Dielectric(0.25f, 1.5f);
  const auto expected = [&](const vec3& refracted) {
    return f * shading::gradientSky(sky, shading::reflectedDirection(d, up)) +
           (1.0f - f) * shading::gradientSky(sky, refracted);
  };
  const vec3 off = centreWith(Dispersion::off, 4.0f);
  const vec3 perChannel = centreWith(Dispersion::perChannelIor, 4.0f);
  const vec3 offset = centreWith(Dispersion::rgbOffset, 4.0f);
  const vec3 refracted = shading::refractedDirection(d, up, 1.5f);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(off[c], expected(refracted)[c], 1e-4f);
    EXPECT_NEAR(perChannel[c], expected(shading::refractedDirection(d, up, shading::channelIor(1.5f, 4.0f, c)))[c],
                1e-4f);
    const vec3 shifted = refracted + 0.01f * static_cast<float>(1 - c) * vec3(refracted.x, 0.0f, refracted.z);
    EXPECT_NEAR(offset[c], expected(glm::normalize(shifted))[c], 1e-4f);
  }
  EXPECT_GT(std::abs(perChannel.x - perChannel.z), 1e-3f);
  EXPECT_EQ(centreWith(Dispersion::perChannelIor, 0.0f), off);
}

}  // namespace
}  // namespace pb
