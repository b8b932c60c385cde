#include "raster/prefilter.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "raster/gpu_structs.h"

namespace pb {
namespace {

using glm::max;
using std::clamp;
using std::log2;
using std::sqrt;
#define PB_FUNC [[maybe_unused]] inline
#include "raster/shaders/gloss_lod.glsl"
#undef PB_FUNC

constexpr int kSmallestFace =
    8;                        // texels along an edge of the last level: its lobe, clamped cosine, is 60 degrees wide
constexpr GLuint kGroup = 8;  // invocations along a work group's edge (raster/shaders/prefilter.glsl)

int levelSize(int resolution, int level) { return std::max(resolution >> level, 1); }

int lastBoxLevel(int resolution) { return std::bit_width(static_cast<unsigned>(resolution)) - 1; }

// The kernel D(NoH) NoL of reflected directions in x = NoH^2, from 1/2 (the horizon) to 1; the solid angle is 4 pi dx.
// D is alpha^2 / (pi (1 - b x)^2) with b = 1 - alpha^2 (D_GGX), NoL = 2 x - 1; constant factors are left out.
struct LobeKernel {
  explicit LobeKernel(double alpha) : b(1.0 - alpha * alpha) {}

  double density(double x) const { return (2.0 * x - 1.0) / ((1.0 - b * x) * (1.0 - b * x)); }

  // Antiderivative of density().
  double integral(double x) const {
    if (b < 1e-3) return x * x - x;
    const double t = 1.0 - b * x;
    return ((2.0 / b - 1.0) / t + 2.0 / b * std::log(t)) / b;
  }

  // x below which `share` of the kernel lies, by bisection: integral() rises strictly.
  double quantile(double share) const {
    double low = 0.5;
    double high = 1.0;
    const double wanted = integral(low) + share * total();
    while (high - low > 1e-15) {
      const double middle = 0.5 * (low + high);
      if (middle == low || middle == high) break;
      (integral(middle) < wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  double total() const { return integral(1.0) - integral(0.5); }

  double b;
};

// Level of a cube map with `resolution` texels along an edge in which a texel at a face's centre, 4 / n^2 steradians,
// has the given solid angle.
float solidAngleLod(float solidAngle, int resolution) {
  const float size = static_cast<float>(resolution);
  return 0.5f * std::log2(solidAngle * size * size / 4.0f);
}

// A direction on one face and one on the opposite face are at least this far apart: acos(1/3), between their corners.
constexpr float kOppositeFaces = 1.2309594f;

// Whether samples with their footprints, two texels of the coarser of the two levels that are read, may reach so far.
bool reachesOppositeFace(const std::array<glm::vec4, kLobeSamples>& samples, int resolution) {
  return std::ranges::any_of(samples, [&](const glm::vec4& s) {
    const float coarsest =
        std::ceil(std::max(solidAngleLod(s.w, resolution), 0.0f) + 1.5f * std::log2(std::sqrt(3.0f)));
    const float texel = 2.0f * std::exp2(coarsest) / static_cast<float>(resolution);
    return std::acos(s.z) + 2.0f * texel > kOppositeFaces;
  });
}

FaceSet oppositeOf(int face) { return 1u << (face ^ 1); }

// Faces of a level that depend on the changed ones of level 0: themselves, the neighbours, and the opposite ones if
// lobes reach there.
FaceSet affectedFaces(FaceSet changed, bool reachesOpposite) {
  FaceSet affected = 0;
  for (int face = 0; face < 6; ++face)
    if ((changed >> face & 1u) != 0) affected |= reachesOpposite ? kAllFaces : kAllFaces & ~oppositeOf(face);
  return affected;
}

// Face numbers, four bits each.
GLint packed(FaceSet faces) {
  GLint result = 0;
  int count = 0;
  for (int face = 0; face < 6; ++face)
    if ((faces >> face & 1u) != 0) result |= face << (4 * count++);
  return result;
}

gl::Texture makeLayers(const gl::Functions& gl, GLenum format, int resolution, int levels) {
  return gl::makeTexture(gl, {.target = GL_TEXTURE_2D_ARRAY,
                              .format = format,
                              .width = resolution,
                              .height = resolution,
                              .layers = 6,
                              .levels = levels});
}

constexpr GLbitfield kLevelsAreRead = GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT;

const gl::Texture& imageOf(const gl::Texture& layers, const gl::Texture& view) {
  return view.id() != 0 ? view : layers;
}

// Texels that resolve the width at which the glow falls to a half, acos(2^(-1/exponent)) ~ sqrt(2 ln 2 / exponent),
// with four of them, and a horizon with those of 128.
int gradientResolution(const shading::Sky& sky) {
  const auto isGrey = [&](const glm::vec4& c) { return glm::vec3(c) == glm::vec3(sky.horizon); };
  const bool glows = glm::vec3(sky.glow) != glm::vec3(0.0f);
  if (!glows && isGrey(sky.zenith) && isGrey(sky.below)) return 2 * kSmallestFace;
  const double width = glows ? std::sqrt(2.0 * std::log(2.0) / std::max(1.0, double{sky.glow.w})) : 1.0;
  const double texels = 4.0 * 1.5707963 / width;
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::clamp(texels, 128.0, 512.0))));
}

constexpr int kLargestFilteredEnvironment = 512;
constexpr int kGradientSubtexels = 4;  // along an edge: antialiases the horizon

}  // namespace

int filteredLevels(ProbeFilter filter, int resolution) {
  if (filter == ProbeFilter::none || resolution < 2) return 0;
  if (filter == ProbeFilter::boxMips) return lastBoxLevel(resolution);
  return std::min(lastBoxLevel(resolution), std::max(lastBoxLevel(resolution / kSmallestFace), 1));
}

float levelRoughness(int level, int levels) {
  return ggxLevelRoughness(static_cast<float>(level), static_cast<float>(levels));
}

bool hasRoughLobe(const Material& material) {
  const float kind = material.constants.kind.x;
  return (kind == shading::kSurfaceGlossy || kind == shading::kSurfaceGlass) &&
         shading::ggxAlpha(material.constants.factors.y) > 0.0f;  // a texture only makes it smoother
}

std::int64_t filteredBytes(ProbeFilter filter, int resolution, int cubes, std::int64_t texelBytes) {
  const auto texels = [&](int first, int last) {
    std::int64_t sum = 0;
    for (int level = first; level <= last; ++level)
      sum += std::int64_t{6} * levelSize(resolution, level) * levelSize(resolution, level);
    return sum;
  };
  const std::int64_t copy = filter == ProbeFilter::ggxPrefiltered ? texels(0, lastBoxLevel(resolution)) : 0;
  return texelBytes * (cubes * texels(1, filteredLevels(filter, resolution)) + copy);
}

gl::Texture makeImageView(const gl::Texture& layers, const TexelFormat& format, int levels, int layerCount) {
  if (format.image == format.shown) return {};
  return gl::makeView(layers, {GL_TEXTURE_2D_ARRAY, format.image, levels, layerCount});
}

// One work group covers 8 x 8 texels.
void dispatchFaces(const gl::Functions& gl, GLuint program, const gl::Texture& target, GLenum imageFormat, int level,
                   int edge, FaceSet faces) {
  gl.UseProgram(program);
  gl.ProgramUniform3i(program, 0, packed(faces), edge, level - 1);
  gl.BindImageTexture(gpu::kFilterTargetImage, target.id(), level, GL_TRUE, 0, GL_WRITE_ONLY, imageFormat);
  const GLuint groups = (static_cast<GLuint>(edge) + kGroup - 1) / kGroup;
  gl.DispatchCompute(groups, groups, static_cast<GLuint>(std::popcount(faces)));
}

void bindFilterSource(const gl::Functions& gl, const gl::Texture& source) {
  gl.BindTextureUnit(gpu::kFilterSourceUnit, source.id());
  gl.BindSampler(gpu::kFilterSourceUnit, 0);
}

std::array<glm::vec4, kLobeSamples> lobeSamples(float alpha) {
  constexpr double kGoldenAngle = 2.39996322972865332;  // 2 pi (2 - golden ratio)
  const LobeKernel kernel(double{alpha});
  std::array<glm::vec4, kLobeSamples> samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    // From the horizon inwards.
    const double x = kernel.quantile((static_cast<double>(i) + 0.5) / kLobeSamples);
    const double z = 2.0 * x - 1.0;
    const double radius = std::sqrt(std::max(1.0 - z * z, 0.0));
    const double angle = kGoldenAngle * static_cast<double>(i);
    const double solidAngle = 4.0 * 3.14159265358979 * kernel.total() / (kernel.density(x) * kLobeSamples);
    samples[i] = glm::vec4(glm::dvec4(radius * std::cos(angle), radius * std::sin(angle), z, solidAngle));
  }
  return samples;
}

CubeFilter::CubeFilter(gl::Context& context, Programs& programs, ProbeFilter filter, const TexelFormat& format,
                       int resolution)
    : gl_(context.functions()),
      filter_(filter),
      format_(format),
      resolution_(resolution),
      levels_(filteredLevels(filter, resolution)),
      boxProgram_(programs.boxLevel(filter == ProbeFilter::ggxPrefiltered, format.defines)) {
  if (filter_ == ProbeFilter::boxMips) return;
  ggxProgram_ = programs.ggxLevel(kLobeSamples, format.defines);
  const int sourceLevels = lastBoxLevel(resolution) + 1;
  sourceLayers_ = makeLayers(gl_, format.shown, resolution, sourceLevels);
  sourceImage_ = makeImageView(sourceLayers_, format, sourceLevels, 6);
  source_ = gl::makeView(sourceLayers_, {GL_TEXTURE_CUBE_MAP, format.shown, sourceLevels, 6});
  lobes_ = UniformSlots<Lobes>(context, static_cast<std::size_t>(levels_));
  for (int level = 1; level <= levels_; ++level) {
    const float roughness = levelRoughness(level, levels_);
    Lobes lobes{lobeSamples(roughness * roughness)};
    reachesOpposite_.push_back(reachesOppositeFace(lobes.samples, resolution));
    for (glm::vec4& sample : lobes.samples) sample.w = solidAngleLod(sample.w, resolution);
    lobes_.set(static_cast<std::size_t>(level - 1), lobes);
  }
  lobes_.upload();
  context.check("allocating filtered cube maps");
}

std::int64_t CubeFilter::run(const gl::Texture& layers, const gl::Texture& image, FaceSet changed) {
  const gl::Texture& target = imageOf(layers, image);
  std::int64_t written = 0;
  if (filter_ == ProbeFilter::boxMips) {
    for (int level = 1; level <= levels_; ++level) {
      fillBoxLevel(boxProgram_, layers, target, level, changed);
      written += texels(level, changed);
    }
    return written;
  }
  gl_.CopyImageSubData(layers.id(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, sourceLayers_.id(), GL_TEXTURE_2D_ARRAY, 0, 0, 0,
                       0, resolution_, resolution_, 6);
  for (int level = 1; level <= lastBoxLevel(resolution_); ++level) {
    fillBoxLevel(boxProgram_, sourceLayers_, imageOf(sourceLayers_, sourceImage_), level, kAllFaces);
    written += texels(level, kAllFaces);
  }
  for (int level = 1; level <= levels_; ++level) {
    const FaceSet faces = affectedFaces(changed, reachesOpposite_[static_cast<std::size_t>(level - 1)]);
    fillGgxLevel(target, level, faces);
    written += texels(level, faces);
  }
  gl_.MemoryBarrier(kLevelsAreRead);
  return written;
}

void CubeFilter::fillBoxLevel(GLuint program, const gl::Texture& layers, const gl::Texture& target, int level,
                              FaceSet faces) {
  bindFilterSource(gl_, layers);
  dispatch(program, target, level, faces);
  gl_.MemoryBarrier(kLevelsAreRead);
}

void CubeFilter::fillGgxLevel(const gl::Texture& target, int level, FaceSet faces) {
  bindFilterSource(gl_, source_);
  lobes_.bind(gpu::kLobeBlock, static_cast<std::size_t>(level - 1));
  dispatch(ggxProgram_, target, level, faces);
}

void CubeFilter::dispatch(GLuint program, const gl::Texture& target, int level, FaceSet faces) {
  dispatchFaces(gl_, program, target, format_.image, level, levelSize(resolution_, level), faces);
}

std::int64_t CubeFilter::texels(int level, FaceSet faces) const {
  return std::int64_t{std::popcount(faces)} * levelSize(resolution_, level) * levelSize(resolution_, level);
}

int filteredEnvironmentResolution(const Environment& environment) {
  if (environment.sky.toGlow.w <= 0.5f) return gradientResolution(environment.sky);
  return std::min(environment.faces.front().width(), kLargestFilteredEnvironment);
}

FilteredEnvironment filterEnvironment(gl::Context& context, Programs& programs, const Environment& environment,
                                      ProbeFilter filter) {
  const gl::Functions& gl = context.functions();
  FilteredEnvironment result;
  result.resolution = filteredEnvironmentResolution(environment);
  const int levels = filteredLevels(filter, result.resolution) + 1;
  result.layers = makeLayers(gl, GL_RGBA32F, result.resolution, levels);
  result.cube = gl::makeView(result.layers, {GL_TEXTURE_CUBE_MAP, GL_RGBA32F, levels, 6});
  context.check("allocating a filtered environment");
  const bool isGradient = environment.sky.toGlow.w <= 0.5f;
  const int subtexels =
      isGradient ? kGradientSubtexels : (environment.faces.front().width() + result.resolution - 1) / result.resolution;
  const GLuint program = programs.environmentFaces(environmentSource(environment, TextureFilter::exact), subtexels);
  dispatchFaces(gl, program, result.layers, floatTexels().image, 0, result.resolution, kAllFaces);
  gl.MemoryBarrier(kLevelsAreRead);
  CubeFilter(context, programs, filter, floatTexels(), result.resolution).run(result.layers, {}, kAllFaces);
  context.check("filtering the environment");
  return result;
}

}  // namespace pb
