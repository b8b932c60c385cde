// What a technique needs of the device, checked before anything is allocated: pure functions of numbers.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/technique.h"
#include "scenes/scene.h"

namespace pb {

struct DeviceLimits {
  int cubeMapSizePx;   // GL_MAX_CUBE_MAP_TEXTURE_SIZE
  int arrayLayers;     // GL_MAX_ARRAY_TEXTURE_LAYERS
  int textureSizePx;   // GL_MAX_TEXTURE_SIZE
  int viewportPx;      // the smaller of GL_MAX_VIEWPORT_DIMS
  int textureUnits;    // GL_MAX_TEXTURE_IMAGE_UNITS
  std::int64_t bytes;  // that may be allocated
};

// Throws an input Error when a texture or the environment is too large for the device, or all together.
void checkSceneFits(const DeviceLimits& limits, const Scene& scene);

// Memory of the maps of `probes` probes, with their distances if the lookup reads them, what they are converted from,
// and the filtered levels of that kind.
std::int64_t probeBytes(const Technique& technique, int probes, ProbeFilter levels);
// The same of probes that have that many texels along the edge of a face each.
std::int64_t probeBytes(const Technique& technique, const std::vector<int>& resolutions, ProbeFilter levels);

// Memory of the images of that many mirrored views, of so many samples each.
std::int64_t mirroredViewBytes(std::size_t views, int widthSamples, int heightSamples);

// Throws an input Error that names both numbers when the final image exceeds the device.
void checkImageFits(const DeviceLimits& limits, int widthPx, int heightPx, int samplesPerAxis);

// The same for a picture of that many samples and the back faces behind it (raster/back_faces.h).
void checkBackFacesFit(const DeviceLimits& limits, int widthSamples, int heightSamples);

// The same for the cube maps with their depth and the final image together.
void checkProbesFit(const DeviceLimits& limits, const Technique& technique, int probes, ProbeFilter levels, int widthPx,
                    int heightPx, int samplesPerAxis);

}  // namespace pb
