#include "scenes/environment.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "scenes/error.h"
#include "scenes/image_io.h"
#include "scenes/spec.h"

namespace pb {
namespace {

// Six such faces take 400 MB; twice the size would not fit a machine of 2 GB.
constexpr int kMaxFaceSize = 2048;

constexpr std::array<std::string_view, 6> kFaceNames = {"px", "nx", "py", "ny", "pz", "nz"};

Environment withAmbient(std::string name, const shading::Sky& sky, const shading::Ambient& ambient) {
  Environment environment;
  environment.name = std::move(name);
  environment.sky = sky;
  environment.ambient = ambient;
  return environment;
}

shading::Sky uniformSky(glm::vec3 radiance) {
  shading::Sky sky;
  sky.horizon = sky.zenith = sky.below = glm::vec4(radiance, 0.0f);
  sky.glow = {0.0f, 0.0f, 0.0f, 1.0f};
  sky.toGlow = {0.0f, 1.0f, 0.0f, 0.0f};
  return sky;
}

glm::vec2 texelCentre(int x, int y, int n) { return (2.0f * glm::vec2(x, y) + 1.0f) / static_cast<float>(n) - 1.0f; }

// Calls texel(x, y) for each texel of an n x n face.
template <class Function>
void forEachTexel(int n, const Function& texel) {
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) texel(x, y);
}

std::vector<ImageRgba> facesOf(const shading::Sky& sky, int faceSize) {
  std::vector<ImageRgba> faces(6, ImageRgba(faceSize, faceSize));
  for (int face = 0; face < 6; ++face)
    forEachTexel(faceSize, [&](int x, int y) {
      const glm::vec3 d = glm::normalize(shading::cubeDirection(face, texelCentre(x, y, faceSize)));
      faces[static_cast<std::size_t>(face)](x, y) = glm::vec4(shading::gradientSky(sky, d), 1.0f);
    });
  return faces;
}

ImageRgba readRadiance(const std::string& path, std::vector<std::string>& warnings) {
  LoadedImage image = readImage(path);
  if (image.encoding == Encoding::srgb)
    for (glm::vec4& p : image.pixels) p = {linearFromSrgb(p.x), linearFromSrgb(p.y), linearFromSrgb(p.z), p.w};
  repairRadiance(image.pixels, path, warnings);
  return std::move(image.pixels);
}

// The smallest power of two whose texels are nowhere larger than the image's: they are largest at a face's centre,
// 2 / n radians, and the image's are 2 pi / width on the equator.
int faceSizeFor(int width) {
  const auto wanted = static_cast<unsigned>(std::ceil(static_cast<float>(width) / shading::kPi));
  return static_cast<int>(std::bit_ceil(std::max(wanted, 1U)));
}

// Bilinear; repeats in u, and the poles' rows continue beyond themselves.
glm::vec3 sampleEquirectangular(const ImageRgba& image, const glm::vec3& d) {
  const glm::vec2 uv(0.5f + std::atan2(d.x, -d.z) / (2.0f * shading::kPi),
                     std::atan2(std::hypot(d.x, d.z), d.y) / shading::kPi);
  const glm::vec2 p = uv * glm::vec2(image.width(), image.height()) - 0.5f;
  const glm::vec2 corner = glm::floor(p);
  const glm::vec2 f = p - corner;
  const auto column = [&](int x) { return (x + image.width()) % image.width(); };
  const auto row = [&](int y) { return std::clamp(y, 0, image.height() - 1); };
  const int x0 = column(static_cast<int>(corner.x)), x1 = column(static_cast<int>(corner.x) + 1);
  const int y0 = row(static_cast<int>(corner.y)), y1 = row(static_cast<int>(corner.y) + 1);
  return glm::vec3(
      glm::mix(glm::mix(image(x0, y0), image(x1, y0), f.x), glm::mix(image(x0, y1), image(x1, y1), f.x), f.y));
}

// Mean over samplesPerAxis^2 points of the texel.
glm::vec4 resampledTexel(const ImageRgba& image, int face, int x, int y, int faceSize, int samplesPerAxis) {
  glm::vec3 sum(0.0f);
  const int n = faceSize * samplesPerAxis;
  forEachTexel(samplesPerAxis, [&](int i, int j) {
    const glm::vec2 st = texelCentre(x * samplesPerAxis + i, y * samplesPerAxis + j, n);
    sum += sampleEquirectangular(image, shading::cubeDirection(face, st));
  });
  return {sum / static_cast<float>(samplesPerAxis * samplesPerAxis), 1.0f};
}

std::vector<ImageRgba> loadEquirectangular(const std::string& path, std::vector<std::string>& warnings) {
  const ImageRgba image = readRadiance(path, warnings);
  if (image.width() != 2 * image.height())
    warnings.push_back(
        fmt::format("environment '{}' is stretched: it has {} x {} pixels, equirectangular images are "
                    "twice as wide as high",
                    path, image.width(), image.height()));
  const int wanted = faceSizeFor(image.width());
  if (wanted > kMaxFaceSize)
    warnings.push_back(fmt::format("environment '{}' is averaged to cube faces of {} texels; its {} columns have more",
                                   path, kMaxFaceSize, image.width()));
  return cubeFacesOf(image, std::min(wanted, kMaxFaceSize));
}

std::vector<ImageRgba> loadSixFaces(const std::string& pattern, std::vector<std::string>& warnings) {
  const std::size_t star = pattern.find('*');
  std::vector<ImageRgba> faces;
  for (const std::string_view face : kFaceNames) {
    const std::string path = std::string(pattern).replace(star, 1, face);
    faces.push_back(readRadiance(path, warnings));
    const ImageRgba& image = faces.back();
    if (image.width() != image.height() || image.width() != faces.front().width())
      throwInputError("six faces want to be square and of one size, '{}' has {} x {}", path, image.width(),
                      image.height());
  }
  return faces;
}

Environment constantFromSpec(const std::string& text) {
  SpecReader reader(parseSpec(text), fmt::format("environment '{}'", text));
  const auto channel = [&](const char* key) { return static_cast<float>(reader.number(key, 0.0, 1e6, 0.0)); };
  const glm::vec3 radiance(channel("r"), channel("g"), channel("b"));
  reader.finish();
  return makeConstantEnvironment(radiance);
}

// Spherical harmonics of bands 0 to 2 as polynomials of the direction, in the order of Ambient's members. Each comes
// with the factor from the mean over the sphere of radiance times polynomial to Ambient's coefficient: 4 pi times the
// square of the basis constant times A_l / pi (Ramamoorthi and Hanrahan 2001, eq. 3 and 8).
constexpr double kBand1 = 3.0 * (2.0 / 3.0);
constexpr double kBand2 = 15.0 * 0.25;
constexpr std::array<double, 9> kCoefficients = {1.0,    kBand1,        kBand1, kBand1,      kBand2,
                                                 kBand2, kBand2 / 12.0, kBand2, kBand2 / 4.0};

std::array<double, 9> polynomials(const glm::dvec3& d) {
  return {1.0, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3.0 * d.z * d.z - 1.0, d.x * d.z, d.x * d.x - d.y * d.y};
}

}  // namespace

Environment makeConstantEnvironment(glm::vec3 radiance) {
  return withAmbient("constant", uniformSky(radiance), constantAmbient(radiance));
}

Environment makeGradientEnvironment(const shading::Sky& sky) {
  // Even, so that the horizon lies between texels.
  constexpr int kQuadratureFaceSize = 64;
  return withAmbient("gradient", sky, projectAmbient(facesOf(sky, kQuadratureFaceSize)));
}

Environment makeCubeEnvironment(std::string name, std::vector<ImageRgba> faces) {
  shading::Sky sky = uniformSky(glm::vec3(0.0f));
  sky.toGlow.w = 1.0f;
  Environment environment = withAmbient(std::move(name), sky, projectAmbient(faces));
  environment.faces = std::move(faces);
  return environment;
}

Environment makeProceduralSky() {
  shading::Sky sky;
  sky.horizon = {0.75f, 0.85f, 1.0f, 0.0f};
  sky.zenith = {0.18f, 0.38f, 0.85f, 0.0f};
  sky.below = {0.32f, 0.30f, 0.28f, 0.0f};
  // 20 times the sky's radiance within about 6 degrees of the sun: a visible highlight and a fifth of the ambient
  // light.
  sky.glow = {12.0f, 10.5f, 8.0f, 128.0f};
  sky.toGlow = glm::vec4(glm::normalize(glm::vec3(0.5f, 0.8f, 0.4f)), 0.0f);
  Environment environment = makeGradientEnvironment(sky);
  environment.name = "sky";
  return environment;
}

Environment loadEnvironment(const std::string& text, std::vector<std::string>& warnings) {
  if (text == "sky") return makeProceduralSky();
  if (text == "black") return makeConstantEnvironment(glm::vec3(0.0f));
  if (text == "white") return makeConstantEnvironment(glm::vec3(1.0f));
  if (text.starts_with("constant?")) return constantFromSpec(text);
  if (text.find('*') != std::string::npos) return makeCubeEnvironment(text, loadSixFaces(text, warnings));
  if (!std::filesystem::exists(text))
    throwInputError("environment wants sky, black, white, constant?r=..&g=..&b=.. or an image file, '{}' is none",
                    text);
  return makeCubeEnvironment(text, loadEquirectangular(text, warnings));
}

std::vector<TimedEnvironment> parseEnvironments(const std::string& text) {
  std::vector<TimedEnvironment> environments;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(';', start), text.size());
    const std::string part = text.substr(start, end - start);
    start = end + 1;
    const std::size_t at = environments.empty() ? std::string::npos : part.rfind('@');
    const std::optional<double> time = at == std::string::npos ? std::nullopt : parseNumber(part.substr(at + 1));
    if (!environments.empty() && !time)
      throwInputError("environments after the first want their time, as in 'sky;black@2', got '{}'", part);
    environments.push_back({part.substr(0, at), time.value_or(0.0)});
  }
  return environments;
}

std::string printEnvironments(const std::vector<TimedEnvironment>& environments) {
  std::string text = environments.front().text;
  for (std::size_t i = 1; i < environments.size(); ++i)
    text += fmt::format(";{}@{}", environments[i].text, environments[i].timeSeconds);
  return text;
}

// Infinities occur where a half-float file was saved from too bright a picture.
void repairRadiance(ImageRgba& image, const std::string& name, std::vector<std::string>& warnings) {
  const auto isTooBright = [](float value) { return value > kLargestRadiance; };
  float largest = 0.0f;
  for (const glm::vec4& p : image)
    for (int c = 0; c < 3; ++c)
      if (!isTooBright(p[c])) largest = std::max(largest, p[c]);  // NaN never is the larger one
  std::size_t dark = 0, bright = 0;
  for (glm::vec4& p : image) {
    for (int c = 0; c < 3; ++c) {
      const float value = p[c];
      if (value >= 0.0f && !isTooBright(value)) continue;
      ++(isTooBright(value) ? bright : dark);
      p[c] = isTooBright(value) ? largest : 0.0f;
    }
    p.w = 1.0f;
  }
  if (dark > 0) warnings.push_back(fmt::format("environment '{}': {} negative or NaN values became 0", name, dark));
  if (bright > 0)
    warnings.push_back(fmt::format("environment '{}': {} values that are infinite or above {} became {}", name, bright,
                                   kLargestRadiance, largest));
}

std::vector<ImageRgba> cubeFacesOf(const ImageRgba& image, int faceSize) {
  // At most one image texel between samples: bilinear lookups reach one texel to each side, so that none is missed.
  const float texelRatio = static_cast<float>(image.width()) / (shading::kPi * static_cast<float>(faceSize));
  const int samplesPerAxis = static_cast<int>(std::ceil(texelRatio));
  std::vector<ImageRgba> faces(6, ImageRgba(faceSize, faceSize));
  tbb::parallel_for(0, 6 * faceSize, [&](int row) {
    const int face = row / faceSize, y = row % faceSize;
    for (int x = 0; x < faceSize; ++x)
      faces[static_cast<std::size_t>(face)](x, y) = resampledTexel(image, face, x, y, faceSize, samplesPerAxis);
  });
  return faces;
}

shading::Ambient projectAmbient(const std::vector<ImageRgba>& faces) {
  std::array<glm::dvec3, 9> sums{};
  double weights = 0.0;
  for (int face = 0; face < 6; ++face) {
    const ImageRgba& texels = faces[static_cast<std::size_t>(face)];
    const int n = texels.width();
    forEachTexel(n, [&](int x, int y) {
      const glm::dvec3 d = shading::cubeDirection(face, texelCentre(x, y, n));
      const double distance = glm::length(d);
      // Proportional to the solid angle at the texel's centre. cubeTexelSolidAngle() is exact, but in float its
      // differences cancel for small texels; dividing by the sum makes uniform radiance exact as well.
      const double weight = 1.0 / (distance * distance * distance);
      const std::array<double, 9> basis = polynomials(d / distance);
      for (std::size_t i = 0; i < basis.size(); ++i) sums[i] += basis[i] * weight * glm::dvec3(texels(x, y));
      weights += weight;
    });
  }
  const auto coefficient = [&](std::size_t i) {
    return glm::vec4(glm::vec3(kCoefficients[i] / weights * sums[i]), 0.0f);
  };
  return {coefficient(0), coefficient(1), coefficient(2), coefficient(3), coefficient(4),
          coefficient(5), coefficient(6), coefficient(7), coefficient(8)};
}

shading::Ambient constantAmbient(glm::vec3 radiance) {
  shading::Ambient ambient{};
  ambient.constant = glm::vec4(radiance, 0.0f);
  return ambient;
}

glm::vec3 environmentRadiance(const Environment& environment, glm::vec3 d) {
  return shading::environmentRadiance(environment.sky, shading::sampler2DArray{&environment.faces}, d);
}

}  // namespace pb
