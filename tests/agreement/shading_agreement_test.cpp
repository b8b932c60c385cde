// The shading model, compiled as GLSL and as C++, gives the same numbers: every function of scenes/shading is run on
// both sides with the same pseudo-random inputs.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "raster/gl/context.h"
#include "raster/gl/objects.h"
#include "scenes/shading/shading.h"
#include "tests/agreement/shading_agreement.comp.h"

namespace pb {
namespace {

constexpr int kInputs = 4096;

std::vector<ImageRgba> makeLevels(const std::vector<int>& sizes) {
  std::vector<ImageRgba> levels;
  for (std::size_t level = 0; level < sizes.size(); ++level) {
    ImageRgba texels(sizes[level], sizes[level]);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const auto x = static_cast<float>(i + 17 * level);
      texels[i] = {std::sin(x), std::cos(1.7f * x), std::sin(2.3f * x), 0.5f};
    }
    levels.push_back(std::move(texels));
  }
  return levels;
}

const std::vector<ImageRgba>& imageLevels() {
  static const std::vector<ImageRgba> levels = makeLevels({8, 4, 2, 1});
  return levels;
}
const std::vector<ImageRgba>& faceLayers() {
  static const std::vector<ImageRgba> layers = makeLevels({8, 8, 8, 8, 8, 8});
  return layers;
}

}  // namespace

namespace shading {

// The C++ side: cases.glsl as a table of functions.
using Function = vec4 (*)(vec4 a, vec4 b, sampler2D image, sampler2DArray faces);
struct Case {
  int index;
  Function evaluate;
};

#define PB_FUNC inline
#include "scenes/shading/probe_map.glsl"
#define AGREEMENT_CASES_BEGIN inline const std::vector<Case> kCases = {
#define AGREEMENT_CASE(index, ...)                                                               \
  {index, []([[maybe_unused]] vec4 a, [[maybe_unused]] vec4 b, [[maybe_unused]] sampler2D image, \
             [[maybe_unused]] sampler2DArray faces) { return vec4(__VA_ARGS__); }},
#define AGREEMENT_CASES_END \
  }                         \
  ;
#include "tests/agreement/cases.glsl"
#undef PB_FUNC

}  // namespace shading

namespace {

// |gl - cpp| <= tolerance * max(1, |cpp|), except for a share of the inputs that fall on a step of the function.
struct Row {
  int index;
  const char* name;
  double tolerance;
  double shareOnSteps;
  const char* why;
};

// Sums and products of a few terms differ in the order of operations and in fused multiply-adds that GLSL may use.
constexpr double kArithmetic = 2e-6;
// llvmpipe's pow, log2 and exp2 are polynomials with errors around 1e-6; pow multiplies log2's error by exponent and
// argument.
constexpr double kTranscendental = 2e-5;

// Distances differ by about 2e-7, and normals are their differences over 4e-3: 5e-5 in a normal and about as much in
// the light on it. Measured: 4e-5.
constexpr double kSphereTraced = 1e-4;

const std::vector<Row> kRows = {
    {0, "safeNormalize, pow5", kArithmetic, 0, "a square root and a division"},
    {1, "srgbEncode, srgbDecode", kTranscendental, 0, "pow"},
    {2, "cubeDirection, cubeFaceOf", 0, 0, "additions of exact values, comparisons"},
    {3, "cubeFaceCoordinates", kArithmetic, 0, "a division"},
    {4, "cubeTexelSolidAngle", 64 * 2e-6, 0, "differences of atan, times 64"},
    {5, "cubeWrapTexel", 0, 0, "integers; texel centres never fall on a step"},
    {6, "cubeBilinearTaps, weights", 1e-5, 2e-3,
     "a division times 8 texels; weights jump where the corner texel changes"},
    {7, "cubeBilinearTaps, texels", 0, 2e-3, "floor of a quotient: the corner texel changes at a step"},
    {8, "sampleCube", 2e-5, 0, "continuous across the steps of its taps"},
    {9, "gradientSky", kTranscendental, 0, "pow with exponents up to 65"},
    {10, "gradientSky, clamped", kTranscendental, 0, "pow with exponents up to 65"},
    {11, "ambientRadiance", kArithmetic, 0, "a sum of nine products"},
    {12, "F_Schlick, F_Dielectric into the denser medium", kArithmetic, 0, "a square root and divisions"},
    {13, "F_Dielectric out of the denser medium", 2e-3, 0,
     "the slope is infinite at the critical angle: a root of a difference of 1e-7 is 3e-4"},
    {14, "refractedDirection", 2e-3, 2e-3, "as above; beyond the critical angle it jumps to zero"},
    {15, "reflectedDirection", kArithmetic, 0, "products"},
    {16, "lightIrradianceOn, directional", kArithmetic, 0, "products"},
    {17, "lightIrradianceOn, point", kArithmetic, 0, "products and divisions"},
    {18, "lightIrradianceOn, spot", kArithmetic, 0, "products and divisions"},
    {19, "mappedNormal", 1e-5, 0, "a normalised sum: cancellation where it is short"},
    {20, "localRadiance, diffuse", kArithmetic, 0, "products"},
    {21, "localRadiance, mirror", kArithmetic, 0, "products"},
    {22, "localRadiance, glass", kArithmetic, 0, "products"},
    {23, "localRadiance, unlit", 0, 0, "a copy"},
    {24, "specularWeights, mirror", 1e-5, 0, "square roots and divisions of the conductor"},
    {25, "specularWeights, glass", kArithmetic, 0, "a square root and divisions"},
    {26, "viewDirection", kArithmetic, 0, "products"},
    {27, "clipFromWorldPosition", 2 * kArithmetic, 0, "products up to 20"},
    {28, "sampleTexture, magnified", 1e-5, 0, "bilinear weights of coordinates up to 24 texels"},
    {29, "sampleTexture, trilinear", 1e-5, 0, "bilinear weights"},
    {30, "sampleTexture, nearest mip", 1e-5, 2e-3, "the level is rounded: steps at half levels"},
    {31, "nearestTexelId", 0, 2e-3, "floor: steps at texel edges"},
    {32, "textureCoordinates", kArithmetic, 0, "products"},
    {33, "coneLod", kTranscendental, 0, "log2"},
    {34, "makeSurface, base colour, metallic", kArithmetic, 0, "products"},
    {35, "makeSurface, emission, occlusion", kArithmetic, 0, "products"},
    {36, "environmentRadiance, gradient", kTranscendental, 0, "pow with exponents up to 65"},
    {37, "F_Conductor, F_Ratio", kTranscendental, 0, "square roots, divisions and pow"},
    {38, "dielectricReflectance into the denser medium", kTranscendental, 0, "pow of the ratio law"},
    {39, "dielectricReflectance out of the denser medium", 2e-3, 0, "the slope is infinite at the critical angle"},
    {40, "makeFrame, toWorld, toLocal", 1e-4, 0, "1 / (1 + |z|) is at most 1, but cancels near the poles"},
    {41, "D_GGX, lambda_GGX, G1_SmithGGX, V_SmithGGXCorrelated", 2e-5, 0,
     "the denominator of D is a difference, squared"},
    {42, "geometryTerm", 1e-5, 0, "quotients of small cosines"},
    {43, "sampleVisibleNormal", 1e-4, 0,
     "sine and cosine of llvmpipe, and a normalised sum that is short at grazing angles"},
    {44, "pdfVisibleNormal", 2e-5, 0, "as D_GGX"},
    {45, "sampleDfg", 1e-5, 0, "bilinear weights"},
    {46, "areaLightIrradiance", 1e-3, 2e-3, "atan of cross products near 0 and 180 degrees; corners on the horizon"},
    {47, "transmittance, channelIor", kTranscendental, 0, "exp"},
    {48, "slabExitOffset", 1e-4, 0, "a square root far from the critical angle"},
    {49, "specularReflectance", kTranscendental, 0, "square roots, divisions and pow"},
    {50, "specularF0, specularF90", 1e-5, 0, "divisions"},
    {51, "surfaceDfg, coatAlbedo", 1e-5, 0, "bilinear weights"},
    {52, "specularBsdf", 1e-4, 0, "D squared differences; a normalised half vector"},
    {53, "specularWeights, glossy; isThinWalled", kTranscendental, 0, "products"},
    {54, "makeSurface, alpha, opacity; ggxAlpha", kArithmetic, 2e-3, "products; smooth below a step"},
    {55, "smoothUnion, subtraction, boxDistance, torusDistance", kArithmetic, 0, "products, square roots"},
    {56, "twisted, rippleHeight", kTranscendental, 0, "sines"},
    {57, "screenRadiance, melt", kSphereTraced, 1e-3, "normals, as said above; steps at silhouettes and in the glow"},
    {58, "screenRadiance, twist", kSphereTraced, 1e-3, "normals, as said above; steps at silhouettes and in the glow"},
    {59, "screenRadiance, ripples", kSphereTraced, 1e-3,
     "normals, as said above; steps at silhouettes and in the glow"},
    {60, "screenRadiance, rings", kSphereTraced, 1e-3, "normals, as said above; steps at silhouettes and in the glow"},
    {61, "sphereProxyDirection", 2e-3, 2e-3,
     "at the sphere's outline the slope is infinite: a root of a difference of 1e-6; rays beside it jump"},
    {62, "boxProxyDirection", 1e-5, 0, "divisions by components of a direction"},
    {63, "impostorDirection, impostorExcess", kArithmetic, 0, "products"},
    {64, "impostorSecant, singleViewCoordinates", 1e-5, 0, "a division by at least 0.1"},
    {65, "octahedralCoordinates, paraboloidCoordinates", kArithmetic, 1e-3,
     "divisions; the octahedron's edges jump to their other half"},
    {66, "octahedralDirection", kArithmetic, 0, "a normalised sum of numbers below 2"},
    {67, "paraboloidDirection, borderedTextureCoordinates", kArithmetic, 0, "a division"},
    {68, "cubeSolidAngleDensity", kArithmetic, 0, "a square root and a division"},
};

std::vector<glm::vec4> makeInputs() {
  std::mt19937 engine(7);
  std::vector<glm::vec4> inputs(2 * kInputs);
  for (glm::vec4& v : inputs)
    for (int k = 0; k < 4; ++k) v[k] = static_cast<float>(engine() >> 8) / 16777216.0f;
  return inputs;
}

gl::Texture upload(const gl::Functions& f, GLenum target, const std::vector<ImageRgba>& images, bool asLayers) {
  const int n = images.front().width();
  const int count = static_cast<int>(images.size());
  gl::Texture texture = gl::makeTexture(f, {.target = target,
                                            .format = GL_RGBA32F,
                                            .width = n,
                                            .height = n,
                                            .layers = asLayers ? count : 1,
                                            .levels = asLayers ? 1 : count});
  for (int i = 0; i < count; ++i) {
    const ImageRgba& image = images[static_cast<std::size_t>(i)];
    if (asLayers)
      f.TextureSubImage3D(texture.id(), 0, 0, 0, i, n, n, 1, GL_RGBA, GL_FLOAT, image.data());
    else
      f.TextureSubImage2D(texture.id(), i, 0, 0, image.width(), image.height(), GL_RGBA, GL_FLOAT, image.data());
  }
  return texture;
}

std::vector<std::vector<glm::vec4>> evaluateOnGl(gl::Context& context, const std::vector<glm::vec4>& inputs) {
  const gl::Functions& f = context.functions();
  const gl::Program program(f, {{GL_COMPUTE_SHADER, "shading_agreement.comp", shaders::kShadingAgreementComp}});
  const gl::Buffer in(f, gl::bytesOf(inputs));
  const gl::Buffer out(f, kInputs * sizeof(glm::vec4));
  const gl::Texture image = upload(f, GL_TEXTURE_2D, imageLevels(), false);
  const gl::Texture faces = upload(f, GL_TEXTURE_2D_ARRAY, faceLayers(), true);
  f.UseProgram(program.id());
  f.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, in.id());
  f.BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, out.id());
  f.BindTextureUnit(0, image.id());
  f.BindTextureUnit(1, faces.id());
  std::vector<std::vector<glm::vec4>> results;
  for (const Row& row : kRows) {
    f.Uniform1i(0, row.index);
    f.DispatchCompute(kInputs / 64, 1, 1);
    f.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    results.emplace_back(kInputs);
    f.GetNamedBufferSubData(out.id(), 0, kInputs * sizeof(glm::vec4), results.back().data());
  }
  context.check("running the agreement cases");
  return results;
}

void expectAgreement(const Row& row, const shading::Case& reference, const std::vector<glm::vec4>& inputs,
                     const std::vector<glm::vec4>& gl) {
  int apart = 0;
  double largest = 0.0;
  for (std::size_t i = 0; i < kInputs; ++i) {
    const glm::vec4 expected = reference.evaluate(inputs[2 * i], inputs[2 * i + 1], {&imageLevels()}, {&faceLayers()});
    double error = 0.0;
    for (int k = 0; k < 4; ++k) {
      ASSERT_TRUE(std::isfinite(expected[k])) << row.name;
      const double difference = std::abs(static_cast<double>(gl[i][k]) - static_cast<double>(expected[k]));
      // Written so that a NaN from GLSL counts as apart.
      const double relative = difference / std::max(1.0, std::abs(static_cast<double>(expected[k])));
      error = relative <= error ? error : relative;
    }
    if (!(error <= row.tolerance)) {
      ++apart;
      largest = std::max(largest, error);
    }
  }
  EXPECT_LE(apart, row.shareOnSteps * kInputs)
      << row.name << ": up to " << largest << " apart, allowed " << row.tolerance << " because of " << row.why;
}

void expectAgreementOn(std::unique_ptr<gl::NativeContext> native) {
  gl::Context context(std::move(native));
  const std::vector<glm::vec4> inputs = makeInputs();
  const std::vector<std::vector<glm::vec4>> results = evaluateOnGl(context, inputs);
  for (std::size_t i = 0; i < kRows.size(); ++i) expectAgreement(kRows[i], shading::kCases[i], inputs, results[i]);
}

TEST(ShadingAgreement, EveryCaseHasARow) {
  ASSERT_EQ(kRows.size(), shading::kCases.size());
  for (std::size_t i = 0; i < kRows.size(); ++i) EXPECT_EQ(kRows[i].index, shading::kCases[i].index);
}

#ifdef PROBEBENCH_OSMESA
TEST(ShadingAgreement, GlslOnOsmesaEqualsCpp) { expectAgreementOn(gl::createOsmesaContext()); }
#endif
TEST(ShadingAgreement, GlslOnEglEqualsCpp) { expectAgreementOn(gl::createEglContext()); }

}  // namespace
}  // namespace pb
