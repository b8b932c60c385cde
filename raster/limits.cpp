#include "raster/limits.h"

#include <algorithm>
#include <map>

#include "raster/gpu_structs.h"
#include "raster/lookup.h"
#include "raster/map_conversion.h"
#include "raster/prefilter.h"
#include "scenes/error.h"

namespace pb {
namespace {

constexpr std::int64_t kDepthBytes = 4;         // D32F
constexpr std::int64_t kCubeTexelBytes = 8;     // RGBA16F
constexpr std::int64_t kImageSampleBytes = 16;  // RGBA32F
constexpr std::int64_t kTexelBytes = 16;        // RGBA32F
constexpr std::int64_t kMebibyte = 1024 * 1024;

std::int64_t imageBytes(int widthPx, int heightPx, int samplesPerAxis) {
  const std::int64_t samples = std::int64_t{widthPx} * heightPx * samplesPerAxis * samplesPerAxis;
  return samples * (kImageSampleBytes + kDepthBytes);
}

void checkBytes(const DeviceLimits& limits, std::int64_t bytes, const char* what) {
  if (bytes > limits.bytes)
    throwInputError("{} want {} MiB, the device allows {} MiB", what, bytes / kMebibyte, limits.bytes / kMebibyte);
}

}  // namespace

void checkSceneFits(const DeviceLimits& limits, const Scene& scene) {
  std::int64_t texels = 0;
  for (const Texture& texture : scene.textures) {
    const ImageRgba& level0 = texture.levels.front();
    if (std::max(level0.width(), level0.height()) > limits.textureSizePx)
      throwInputError("the device's textures have at most {} texels along an edge, texture '{}' of scene '{}' is {}x{}",
                      limits.textureSizePx, texture.name, scene.name, level0.width(), level0.height());
    for (const ImageRgba& level : texture.levels) texels += static_cast<std::int64_t>(level.size());
  }
  for (std::size_t i = 0; i <= scene.environmentChanges.size(); ++i) {
    const Environment& environment = scene.environmentAt(i);
    const int faceSize = environment.faces.front().width();
    if (faceSize > limits.cubeMapSizePx)
      throwInputError("the device's cube maps have at most {} texels along an edge, environment '{}' has {}",
                      limits.cubeMapSizePx, environment.name, faceSize);
    texels += std::int64_t{6} * faceSize * faceSize;
  }
  checkBytes(limits, kTexelBytes * texels, "the scene's textures");
}

std::int64_t probeBytes(const Technique& technique, int probes, ProbeFilter levels) {
  if (technique.probes == ProbeUse::environmentOnly) return 0;
  const TexelFormat& format = texelFormat(technique.format);
  const MapSquares squares = mapSquares(technique.storage, technique.resolution);
  const int views = viewsOfProbe(technique);
  const std::int64_t shown = std::int64_t{views == 1 ? 1 : squares.count} * squares.edge * squares.edge;
  const std::int64_t captured = std::int64_t{views} * technique.resolution * technique.resolution;
  const bool hasBack =
      technique.bounceOrder == BounceOrder::simultaneous || isConverted(technique.format, technique.storage);
  std::int64_t bytes = shown * format.shownBytes + (hasBack ? captured * format.capturedBytes : 0);
  if (technique.hysteresis > 0.0f) bytes += captured * format.capturedBytes;
  if (needsDistances(technique)) bytes += (hasBack ? 2 : 1) * captured * kDepthBytes;
  return probes * bytes + filteredBytes(levels, technique.resolution, probes, format.shownBytes);
}

std::int64_t probeBytes(const Technique& technique, const std::vector<int>& resolutions, ProbeFilter levels) {
  std::map<int, int> probes;  // by resolution
  for (const int resolution : resolutions) ++probes[resolution];
  std::int64_t bytes = 0;
  for (const auto& [resolution, count] : probes) {
    Technique ofThese = technique;
    ofThese.resolution = resolution;
    bytes += probeBytes(ofThese, count, levels);
  }
  return bytes;
}

std::int64_t mirroredViewBytes(std::size_t views, int widthSamples, int heightSamples) {
  return static_cast<std::int64_t>(views) * widthSamples * heightSamples * kCubeTexelBytes;
}

void checkImageFits(const DeviceLimits& limits, int widthPx, int heightPx, int samplesPerAxis) {
  if (widthPx < 1 || heightPx < 1 || samplesPerAxis < 1)
    throwInputError("an image has at least one pixel and one sample, got {}x{} pixels with {}x{} samples", widthPx,
                    heightPx, samplesPerAxis, samplesPerAxis);
  const std::int64_t largest = std::int64_t{std::max(widthPx, heightPx)} * samplesPerAxis;
  const int allowed = std::min(limits.textureSizePx, limits.viewportPx);
  if (largest > allowed)
    throwInputError(
        "the device renders at most {} samples along an edge of the image, {}x{} pixels with {}x{} samples "
        "want {}",
        allowed, widthPx, heightPx, samplesPerAxis, samplesPerAxis, largest);
  if (gpu::kTextureUnits > limits.textureUnits)
    throwInputError("the shaders use {} texture units, the device has {}", gpu::kTextureUnits, limits.textureUnits);
  checkBytes(limits, imageBytes(widthPx, heightPx, samplesPerAxis), "the image's samples");
}

void checkBackFacesFit(const DeviceLimits& limits, int widthSamples, int heightSamples) {
  // Both are RGBA32F with depth.
  checkBytes(limits, 2 * imageBytes(widthSamples, heightSamples, 1), "the image's samples and the back faces of glass");
}

void checkProbesFit(const DeviceLimits& limits, const Technique& technique, int probes, ProbeFilter levels, int widthPx,
                    int heightPx, int samplesPerAxis) {
  if (technique.probes == ProbeUse::environmentOnly || probes == 0) return;
  if (technique.resolution < 1 || technique.resolution > limits.cubeMapSizePx)
    throwInputError("the device's cube maps have 1 to {} texels along an edge, got resolution {}", limits.cubeMapSizePx,
                    technique.resolution);
  const std::int64_t depth = kDepthBytes * technique.resolution * technique.resolution;
  const int edge = mapSquares(technique.storage, technique.resolution).edge;
  if (edge > limits.textureSizePx)
    throwInputError("the device's textures have at most {} texels along an edge, maps of resolution {} want {}",
                    limits.textureSizePx, technique.resolution, edge);
  checkBytes(limits, probeBytes(technique, probes, levels) + depth + imageBytes(widthPx, heightPx, samplesPerAxis),
             "the cube maps and the image's samples");
}

}  // namespace pb
