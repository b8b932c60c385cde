// Image files. OpenImageIO, which does the work, is loaded with the first image (scenes/image_codecs.h).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "scenes/image.h"

namespace pb {

enum class Encoding { linear, srgb };

struct LoadedImage {
  ImageRgba
      pixels;  // as stored: integers scaled to [0,1], not linearised; one channel is spread to RGB, absent alpha is 1
  Encoding encoding;  // srgb for integer formats (PNG, JPEG, ...), linear for float formats (EXR, HDR, PFM)
};

// EXR, HDR, PFM, PNG, JPEG, TIFF, BMP, PNM or WebP, told by content; row 0 is the top row whatever the file's own order
// is. Throws an input Error that names the file when it is missing, truncated or absurdly large.
LoadedImage readImage(const std::string& path);

// An image file that is already in memory; `name` is for messages.
LoadedImage readImage(std::span<const std::byte> bytes, const std::string& name);

// First three channels as stored.
Image rgbOf(const ImageRgba& pixels);

// sRGB (IEC 61966-2-1) to linear and back, exact curves.
float linearFromSrgb(float encoded);
float srgbFromLinear(float linear);

// Channels of a multi-channel float image, in file order.
struct NamedPlane {
  std::string name;
  Plane plane;
};

// Each writer writes a temporary file beside `path` and renames it, so that a file is complete or absent;
// throws an environment Error when that fails.
void writeExr(const std::string& path, const Image& image);                       // R G B, 32-bit float, ZIP
void writeExr(const std::string& path, const std::vector<NamedPlane>& channels);  // any channels, 32-bit float, ZIP
std::vector<NamedPlane> readExrChannels(const std::string& path);
void writePng(const std::string& path, const Image& linear);          // clamps to [0,1], encodes sRGB, 8 bit
void writePngEncoded(const std::string& path, const Image& encoded);  // stores values as they are, 8 bit

// The same as file contents in memory. `encoded` is stored as it is, clamped to [0,1], with 8 or 16 bits a channel and
// without alpha where it is 1 everywhere.
std::string encodeExr(const Image& image);
std::string encodePng(const ImageRgba& encoded, int bitsPerChannel);

// By extension: .exr or .png; any other extension is an input Error.
void writeImage(const std::string& path, const Image& linear);

}  // namespace pb
